#include "models/probing_stream.hpp"

#include <algorithm>
#include <array>

namespace tractus {
namespace models {
namespace {

/// Moments before those that a delay reaches, so that its slopes are those of the whole motion.
constexpr std::ptrdiff_t kMargin = 3;
constexpr std::ptrdiff_t kForgotten = 256;  // at once, so that each moment costs little

}  // namespace

ProbingStream::ProbingStream(const ProbingRuntime& runtime, double start_s, double stop_s)
    : runtime_(&runtime), start_s_(start_s), stop_s_(stop_s) {
  kept_.memories.resize(runtime.stages_.depths.size() + runtime.stages_.forces.size());
}

ProbingAnswer ProbingStream::at(effects::ProbingTick tick) const {
  Kept kept = kept_;
  return answer(tick, kept);
}

ProbingAnswer ProbingStream::keep(effects::ProbingTick tick) {
  const ProbingAnswer out = answer(tick, kept_);
  forget(kept_);
  return out;
}

ProbingAnswer ProbingStream::answer(effects::ProbingTick tick, Kept& kept) const {
  tick.dt_s = kept.started ? tick.t_s - kept.t_s : 0.0;
  if (!kept.started)
    for (effects::ProbingMemory& memory : kept.memories) memory = {.depth_m = tick.x_m};
  kept.started = true;
  kept.t_s = tick.t_s;

  const ProbingStages& stages = runtime_->stages_;
  ProbingMotion whole{.t_s = {start_s_, tick.t_s, stop_s_}};  // for sensors: its ends and now
  whole.tz_Nm.assign(3, tick.tz_Nm);
  const double force_N = delayed_N(tick.t_s, felt_N(tick, kept), kept);
  std::array fz_N{force_N, force_N, force_N};
  for (const auto& sensor : stages.force_sensors) sensor->record(whole, fz_N);

  const double law_Nm = runtime_->law_.torque_Nm(tick.x_m, tick.theta_rad, tick.omega_rad_s);
  const double torque_Nm = runtime_->added_torque_Nm(tick, law_Nm);
  std::array tz_Nm{torque_Nm, torque_Nm, torque_Nm};
  for (const auto& sensor : stages.torque_sensors) sensor->record(whole, tz_Nm);
  return {fz_N[1], tz_Nm[1]};
}

double ProbingStream::felt_N(const effects::ProbingTick& tick, Kept& kept) const noexcept {
  const ProbingStages& stages = runtime_->stages_;
  auto memory = kept.memories.begin();
  effects::ProbingTick bone = tick;
  for (const auto& depth : stages.depths) depth->see(bone, *memory++);
  double base_N = runtime_->law_.force_N(bone.x_m, bone.v_m_s, kept.stretch);
  for (const auto& factor : stages.scales) base_N *= factor->scale(tick);
  double added_N = 0.0;
  for (const auto& force : stages.forces) added_N += force->force_N(tick, base_N, *memory++);
  return base_N + added_N;
}

double ProbingStream::delayed_N(double t_s, double fz_N, Kept& kept) const {
  if (runtime_->stages_.delays.empty()) return fz_N;
  kept.past_t_s.push_back(t_s);
  kept.past_fz_N.push_back(fz_N);
  const ProbingMotion past{.t_s = kept.past_t_s};
  std::vector<double> late_N = kept.past_fz_N;
  for (const auto& delay : runtime_->stages_.delays) delay->delay(past, late_N);
  return late_N.back();
}

void ProbingStream::forget(Kept& kept) const {
  const double oldest_s = kept.t_s - runtime_->delay_s_;
  const auto reached = std::ranges::lower_bound(kept.past_t_s, oldest_s) - kept.past_t_s.begin();
  const std::ptrdiff_t forgotten = reached - kMargin;
  if (forgotten < kForgotten) return;
  kept.past_t_s.erase(kept.past_t_s.begin(), kept.past_t_s.begin() + forgotten);
  kept.past_fz_N.erase(kept.past_fz_N.begin(), kept.past_fz_N.begin() + forgotten);
}

}  // namespace models
}  // namespace tractus
