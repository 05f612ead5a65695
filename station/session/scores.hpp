/// What a finished trial is worth, as far as a station may know.
#pragma once

#include <filesystem>
#include <utility>
#include <vector>

#include "metrics/metric.hpp"

namespace tractus::session {

using Scores = std::vector<std::pair<metrics::MetricInfo, metrics::Score>>;

/// Every metric of a trial file (of palpation: with its tract); those that need the truth are
/// empty: a station has none. Errors: those of reading the file.
core::Result<Scores> scores_of(const std::filesystem::path& trial_file,
                               const volume::Tract* tract = nullptr);

}  // namespace tractus::session
