#include "replay/probing_replay.hpp"

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "lab/rigs/probing/recording.hpp"

namespace tractus {
namespace replay {
namespace {

constexpr double kTravel_m = 1.0;     // a recording says how far it went
constexpr double kTurns_rad_s = 1.0;  // where no angle was recorded: fast enough to move

std::vector<double> driven(const models::ProbingRuntime& runtime,
                           const models::ProbingMotion& motion, const std::vector<double>& fz_N) {
  models::ProbingLive state;
  state.at.x_m = std::clamp(motion.x_m.front(), 0.0, kTravel_m);
  std::vector<double> out{state.at.x_m};
  out.reserve(fz_N.size());
  for (std::size_t k = 1; k < fz_N.size(); ++k) {
    const double turning = motion.omega_rad_s.empty() ? kTurns_rad_s : motion.omega_rad_s[k];
    runtime.advance(fz_N[k], turning, motion.t_s[k] - motion.t_s[k - 1], state);
    out.push_back(state.at.x_m);
  }
  return out;
}

}  // namespace

core::Result<ProbingReplayed> replay(const models::ProbingModel& model,
                                     const trial::ProbingMeasurement& recording,
                                     const trial::StatedNoise& noise, const std::string& where) {
  const auto runtime = TRY(models::ProbingRuntime::make(model, kTravel_m));
  const bool turns = recording.x_m.empty();
  auto ready = TRY(lab::prepare(trial::ProbingMeasurement(recording), noise, turns,
                                lab::borders_of(model.layers), where));
  ProbingReplayed out;
  out.motion = std::move(ready.motion);
  runtime.predict(out.motion, out.forces);
  if (turns)
    out.forces.fz_N.clear();
  else if (!recording.fz_N.empty())
    out.live_x_m = driven(runtime, out.motion, recording.fz_N);
  return out;
}

}  // namespace replay
}  // namespace tractus
