/// A whole cohort in one file that R and Python read without any package (ADR-0021).
#pragma once

#include "server/api/cohort/export.hpp"

namespace tractus::api {

/// A zip of summary.csv, trials.csv, scores.csv, dictionary.csv, cohort.json and, from the tier
/// `reduced` on, samples/TRIAL.npy: of each trial as much as was agreed to, and no more than
/// `tier`. It takes room in the scratch space as `client`.
/// Errors: those of released_trials and of reading; unavailable; too_large (over 256 MiB).
core::Result<std::shared_ptr<http::ScratchFile>> cohort_zip(Backend& backend,
                                                            const std::string& client,
                                                            const std::string& study,
                                                            store::Tier tier);

}  // namespace tractus::api
