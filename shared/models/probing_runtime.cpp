#include "models/probing_runtime.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "models/probing_step.hpp"

namespace tractus {
namespace models {
namespace {

using effects::ProbingMemory;
using effects::ProbingTick;

/// Samples that are taken through the effects together, so that each effect's numbers stay at hand.
constexpr std::size_t kBlock = 128;

ProbingTick tick_of(const ProbingMotion& motion, std::size_t k) {
  const auto or_zero = [k](const std::vector<double>& all) { return all.empty() ? 0.0 : all[k]; };
  return {.t_s = motion.t_s[k],
          .dt_s = k == 0 ? 0.0 : motion.t_s[k] - motion.t_s[k - 1],
          .x_m = motion.x_m[k],
          .v_m_s = motion.v_m_s[k],
          .a_m_s2 = motion.a_m_s2[k],
          .theta_rad = or_zero(motion.theta_rad),
          .omega_rad_s = or_zero(motion.omega_rad_s),
          .tz_Nm = or_zero(motion.tz_Nm),
          .rest_m_s = motion.rest_m_s,
          .rest_rad_s = motion.rest_rad_s};
}

/// A block on its way through the stages.
struct Block {
  std::array<ProbingTick, kBlock> ticks;
  std::array<double, kBlock> depth_m, speed_m_s, base_N, added_N;
  std::size_t size = 0;

  void fill(const ProbingMotion& motion, std::size_t from) {
    size = std::min(kBlock, motion.size() - from);
    for (std::size_t k = 0; k < size;
         ++k) {  // in place: a tick that is copied waits for its stores
      ticks[k].t_s = motion.t_s[from + k];
      ticks[k].dt_s = from + k == 0 ? 0.0 : motion.t_s[from + k] - motion.t_s[from + k - 1];
      ticks[k].x_m = motion.x_m[from + k];
      ticks[k].v_m_s = motion.v_m_s[from + k];
      ticks[k].a_m_s2 = motion.a_m_s2[from + k];
      ticks[k].rest_m_s = motion.rest_m_s;
      ticks[k].rest_rad_s = motion.rest_rad_s;
    }
    const auto fill_in = [&](double ProbingTick::*member, const std::vector<double>& all) {
      for (std::size_t k = 0; !all.empty() && k < size; ++k) ticks[k].*member = all[from + k];
    };
    fill_in(&ProbingTick::theta_rad, motion.theta_rad);
    fill_in(&ProbingTick::omega_rad_s, motion.omega_rad_s);
    fill_in(&ProbingTick::tz_Nm, motion.tz_Nm);
    std::copy_n(motion.x_m.begin() + std::ptrdiff_t(from), size, depth_m.begin());
    std::copy_n(motion.v_m_s.begin() + std::ptrdiff_t(from), size, speed_m_s.begin());
    added_N.fill(0.0);
  }
};

void see(const effects::BoneDepth& effect, ProbingMemory& memory, Block& b) {
  for (std::size_t k = 0; k < b.size; ++k) {
    ProbingTick tick = b.ticks[k];
    tick.x_m = b.depth_m[k];
    tick.v_m_s = b.speed_m_s[k];
    effect.see(tick, memory);
    b.depth_m[k] = tick.x_m;
    b.speed_m_s[k] = tick.v_m_s;
  }
}

void scale(const effects::BoneScale& effect, Block& b) {
  for (std::size_t k = 0; k < b.size; ++k) b.base_N[k] *= effect.scale(b.ticks[k]);
}

void add(const effects::ProbeForce& effect, ProbingMemory& memory, Block& b) {
  for (std::size_t k = 0; k < b.size; ++k)
    b.added_N[k] += effect.force_N(b.ticks[k], b.base_N[k], memory);
}

}  // namespace

void ProbingStages::add(effects::ProbingEffect effect) {
  const auto keep = [this]<class Stage>(std::unique_ptr<Stage> stage) {
    if constexpr (std::is_same_v<Stage, effects::BoneDepth>) {
      depths.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, effects::BoneScale>) {
      scales.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, effects::ProbeForce>) {
      forces.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, effects::ProbeTorque>) {
      torques.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, effects::ForceDelay>) {
      delays.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, effects::ForceSensor>) {
      force_sensors.push_back(std::move(stage));
    } else {
      static_assert(std::is_same_v<Stage, effects::TorqueSensor>);
      torque_sensors.push_back(std::move(stage));
    }
  };
  std::visit([&](auto& stage) { keep(std::move(stage)); }, effect);
}

ProbingRuntime::ProbingRuntime(laws::ProbingLaw law, ProbingStages stages)
    : law_(std::move(law)), stages_(std::move(stages)) {}

core::Result<ProbingRuntime> ProbingRuntime::make(const ProbingModel& model, double travel_m) {
  return make({.layers = model.layers, .walls = {}, .rotary = model.rotary, .travel_m = travel_m},
              model.effects);
}

core::Result<ProbingRuntime> ProbingRuntime::make(laws::ProbingParameters parameters,
                                                  std::span<const effects::EffectInstance> uses) {
  auto law = TRY(laws::ProbingLaw::make(std::move(parameters)));
  if (uses.size() > kMaxProbingEffects)
    return core::Error{
        core::Errc::too_large,
        fmt::format("{} effects where at most {} are expected", uses.size(), kMaxProbingEffects)};
  ProbingRuntime out(std::move(law), {});
  for (const effects::EffectInstance& use : uses) {
    auto effect = TRY(effects::make_probing_effect(use));
    out.stages_.add(std::move(effect));
    const auto* known = effects::find_probing_effect(use.id);
    if (known && known->facts.is_delay) out.delay_s_ += use.values[0];
  }
  return out;
}

void ProbingRuntime::predict_force(const ProbingMotion& motion, std::span<double> fz_N) const {
  std::size_t stretch = 0;
  if (!stages_.act_along_probe()) {
    for (std::size_t k = 0; k < fz_N.size(); ++k)
      fz_N[k] = law_.force_N(motion.x_m[k], motion.v_m_s[k], stretch);
    return;
  }
  std::array<ProbingMemory, kMaxProbingEffects> memories{};
  if (!fz_N.empty())
    for (ProbingMemory& memory : memories) memory.depth_m = motion.x_m.front();
  Block b;
  for (std::size_t from = 0; from < fz_N.size(); from += kBlock) {
    b.fill(motion, from);
    auto memory = memories.begin();
    for (const auto& depth : stages_.depths) see(*depth, *memory++, b);
    for (std::size_t k = 0; k < b.size; ++k)
      b.base_N[k] = law_.force_N(b.depth_m[k], b.speed_m_s[k], stretch);
    for (const auto& factor : stages_.scales) scale(*factor, b);
    for (const auto& force : stages_.forces) add(*force, *memory++, b);
    for (std::size_t k = 0; k < b.size; ++k) fz_N[from + k] = b.base_N[k] + b.added_N[k];
  }
}

void ProbingRuntime::predict_torque(const ProbingMotion& motion, std::span<double> tz_Nm) const {
  for (std::size_t k = 0; k < tz_Nm.size(); ++k) {
    tz_Nm[k] = law_.torque_Nm(motion.x_m[k], motion.theta_rad[k], motion.omega_rad_s[k]);
    if (!stages_.torques.empty()) tz_Nm[k] = added_torque_Nm(tick_of(motion, k), tz_Nm[k]);
  }
}

void ProbingRuntime::predict(const ProbingMotion& motion, ProbingForces& out,
                             ProbingOutput wanted) const {
  const std::size_t n = motion.size();
  core::require(motion.t_s.size() == n && motion.v_m_s.size() == n && motion.a_m_s2.size() == n,
                "a motion has one time, speed and acceleration for each depth");
  out.fz_N.resize(wanted == ProbingOutput::torque ? 0 : n);
  if (wanted != ProbingOutput::torque) {
    predict_force(motion, out.fz_N);
    for (const auto& delay : stages_.delays) delay->delay(motion, out.fz_N);
    for (const auto& sensor : stages_.force_sensors) sensor->record(motion, out.fz_N);
  }
  const bool turns = wanted != ProbingOutput::force && motion.theta_rad.size() == n &&
                     motion.omega_rad_s.size() == n;
  out.tz_Nm.resize(turns ? n : 0);
  if (!turns) return;
  predict_torque(motion, out.tz_Nm);
  for (const auto& sensor : stages_.torque_sensors) sensor->record(motion, out.tz_Nm);
}

double ProbingRuntime::added_torque_Nm(const ProbingTick& tick, double torque_Nm) const noexcept {
  for (const auto& torque : stages_.torques) torque_Nm += torque->torque_Nm(tick);
  return torque_Nm;
}

double ProbingRuntime::torque_Nm(double x_m, double theta_rad,
                                 double turning_rad_s) const noexcept {
  if (law_.mode_at(x_m) == laws::ProbingMode::breach) return 0.0;
  return added_torque_Nm(
      {.x_m = x_m, .theta_rad = theta_rad, .omega_rad_s = turning_rad_s, .rest_rad_s = kSoft_rad_s},
      law_.torque_Nm(x_m, theta_rad, turning_rad_s));
}

double ProbingRuntime::advance(double force_N, double turning_rad_s, double dt_s,
                               ProbingLive& live) const noexcept {
  if (stages_.act_along_probe())
    return ProbingStep(law_, stages_, turning_rad_s, dt_s, live).take(force_N);
  live.v_m_s = law_.advance(force_N, turning_rad_s, dt_s, live.at);
  live.t_s += dt_s;
  live.theta_rad += turning_rad_s * dt_s;
  return live.v_m_s;
}

}  // namespace models
}  // namespace tractus
