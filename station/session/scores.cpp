#include "station/session/scores.hpp"

#include "trial/trial_file.hpp"

namespace tractus::session {

core::Result<Scores> scores_of(const std::filesystem::path& trial_file,
                               const volume::Tract* tract) {
  const auto trial = trial::read_trial(trial_file);
  if (!trial) return trial.error();
  return metrics::score_all({.trial = *trial, .tract = tract, .truth = std::nullopt});
}

}  // namespace tractus::session
