/// A whole cohort in one file, which R and Python can read without additional packages (ADR-0021).
#pragma once

#include "server/api/cohort/export.hpp"

namespace tractus::api {

/// A zip of summary.csv, trials.csv, scores.csv, dictionary.csv, cohort.json and, for the tiers
/// `reduced` and `full`, samples/TRIAL.npy: of each trial as much as its consent tier allows, and
/// at most `tier`. Reserves scratch space for `client`. Errors: those of released_trials and of
/// reading; unavailable; too_large (over 256 MiB).
core::Result<std::shared_ptr<http::ScratchFile>> cohort_zip(Backend& backend,
                                                            const std::string& client,
                                                            const std::string& study,
                                                            store::Tier tier);

}  // namespace tractus::api
