#include "station/session/scores.hpp"

#include "core/try.hpp"
#include "trial/trial_file.hpp"

namespace tractus::session {

core::Result<Scores> scores_of(const std::filesystem::path& trial_file,
                               const volume::Tract* tract) {
  const auto trial = TRY(trial::read_trial(trial_file));
  return metrics::score_all({.trial = trial, .tract = tract, .truth = std::nullopt});
}

}  // namespace tractus::session
