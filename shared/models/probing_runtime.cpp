#include "models/probing_runtime.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "models/probing_step.hpp"

namespace tractus {
namespace models {
namespace {

using effects::ProbingEffect;
using effects::ProbingStage;
using effects::ProbingTick;

/// Samples that are taken through the effects together, so that each effect's numbers stay at hand.
constexpr std::size_t kBlock = 128;
using States = std::array<double, kMaxProbingEffects * effects::kMaxProbingStates>;

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
};

void see(const ProbingEffect& effect, double* state, Block& b) {
  for (std::size_t k = 0; k < b.size; ++k) {
    ProbingTick tick = b.ticks[k];
    tick.x_m = b.depth_m[k];
    tick.v_m_s = b.speed_m_s[k];
    ProbingTick seen = tick;
    effect.see(seen, state);
    effect.commit(tick, state);
    b.depth_m[k] = seen.x_m;
    b.speed_m_s[k] = seen.v_m_s;
  }
}

void scale(const ProbingEffect& effect, Block& b) {
  for (std::size_t k = 0; k < b.size; ++k) b.base_N[k] *= effect.scale(b.ticks[k]);
}

void add(const ProbingEffect& effect, double* state, Block& b) {
  for (std::size_t k = 0; k < b.size; ++k)
    b.added_N[k] += effect.replay_N(b.ticks[k], b.base_N[k], state);
}

}  // namespace

ProbingRuntime::ProbingRuntime(laws::ProbingLaw law, Effects effects)
    : law_(std::move(law)), effects_(std::move(effects)) {
  std::ranges::stable_sort(effects_, {}, [](const auto& effect) { return effect->stage(); });
  const auto count_before = [this](ProbingStage stage) {
    const auto from = [&](const auto& e) { return e->stage() >= stage; };
    return std::size_t(std::ranges::find_if(effects_, from) - effects_.begin());
  };
  live_ = count_before(ProbingStage::torque);
  felt_ = count_before(ProbingStage::delay);
}

core::Result<ProbingRuntime> ProbingRuntime::make(const ProbingModel& model, double travel_m) {
  return make({.layers = model.layers, .walls = {}, .rotary = model.rotary, .travel_m = travel_m},
              model.effects);
}

core::Result<ProbingRuntime> ProbingRuntime::make(laws::ProbingParameters parameters,
                                                  std::span<const effects::EffectInstance> uses) {
  auto law = laws::ProbingLaw::make(std::move(parameters));
  if (!law) return law.error();
  if (uses.size() > kMaxProbingEffects)
    return core::Error{
        core::Errc::too_large,
        fmt::format("{} effects where at most {} are expected", uses.size(), kMaxProbingEffects)};
  Effects effects;
  effects.reserve(uses.size());
  for (const effects::EffectInstance& use : uses) {
    auto effect = effects::make_probing_effect(use);
    if (!effect) return effect.error();
    effects.push_back(std::move(*effect));
  }
  return ProbingRuntime(std::move(*law), std::move(effects));
}

void ProbingRuntime::predict_law(const ProbingMotion& motion, std::span<double> fz_N) const {
  std::size_t stretch = 0;
  if (live_ == 0) {
    for (std::size_t k = 0; k < fz_N.size(); ++k)
      fz_N[k] = law_.force_N(motion.x_m[k], motion.v_m_s[k], stretch);
    return;
  }
  States states{};
  const auto state_of = [&](std::size_t e) { return &states[e * effects::kMaxProbingStates]; };
  const auto bone = std::find_if(effects_.begin(), effects_.begin() + long(live_),
                                 [](const auto& e) { return e->stage() != ProbingStage::depth; });
  const auto seen = std::size_t(bone - effects_.begin());
  Block b;
  for (std::size_t from = 0; from < fz_N.size(); from += kBlock) {
    b.size = std::min(kBlock, fz_N.size() - from);
    for (std::size_t k = 0; k < b.size; ++k) {
      b.ticks[k] = tick_of(motion, from + k);
      b.depth_m[k] = b.ticks[k].x_m;
      b.speed_m_s[k] = b.ticks[k].v_m_s;
    }
    if (from == 0)
      for (std::size_t e = 0; e < live_; ++e) effects_[e]->start(b.ticks[0], state_of(e));
    for (std::size_t e = 0; e < seen; ++e) see(*effects_[e], state_of(e), b);
    for (std::size_t k = 0; k < b.size; ++k)
      b.base_N[k] = law_.force_N(b.depth_m[k], b.speed_m_s[k], stretch);
    b.added_N.fill(0.0);
    for (std::size_t e = seen; e < live_; ++e)
      effects_[e]->stage() == ProbingStage::scale ? scale(*effects_[e], b)
                                                  : add(*effects_[e], state_of(e), b);
    for (std::size_t k = 0; k < b.size; ++k) fz_N[from + k] = b.base_N[k] + b.added_N[k];
  }
}

void ProbingRuntime::predict(const ProbingMotion& motion, ProbingForces& out) const {
  const std::size_t n = motion.size();
  core::require(motion.t_s.size() == n && motion.v_m_s.size() == n && motion.a_m_s2.size() == n,
                "a motion has one time, speed and acceleration for each depth");
  out.fz_N.resize(n);
  predict_law(motion, out.fz_N);
  for (std::size_t e = felt_; e < effects_.size(); ++e) effects_[e]->record(motion, out.fz_N);
  const bool turns = motion.theta_rad.size() == n && motion.omega_rad_s.size() == n;
  out.tz_Nm.resize(turns ? n : 0);
  for (std::size_t k = 0; k < out.tz_Nm.size(); ++k) {
    out.tz_Nm[k] = law_.torque_Nm(motion.x_m[k], motion.theta_rad[k], motion.omega_rad_s[k]);
    if (felt_ == live_) continue;
    const ProbingTick tick = tick_of(motion, k);
    for (std::size_t e = live_; e < felt_; ++e) out.tz_Nm[k] += effects_[e]->torque_Nm(tick);
  }
  if (!turns) return;
  for (std::size_t e = felt_; e < effects_.size(); ++e)
    effects_[e]->record_torque(motion, out.tz_Nm);
}

double ProbingRuntime::torque_Nm(double x_m, double theta_rad,
                                 double turning_rad_s) const noexcept {
  if (law_.mode_at(x_m) == laws::ProbingMode::breach) return 0.0;
  double out = law_.torque_Nm(x_m, theta_rad, turning_rad_s);
  const ProbingTick tick{
      .x_m = x_m, .theta_rad = theta_rad, .omega_rad_s = turning_rad_s, .rest_rad_s = kSoft_rad_s};
  for (std::size_t e = live_; e < felt_; ++e) out += effects_[e]->torque_Nm(tick);
  return out;
}

double ProbingRuntime::advance(double force_N, double turning_rad_s, double dt_s,
                               ProbingLive& live) const noexcept {
  if (live_ > 0)
    return ProbingStep(law_, {effects_.data(), live_}, turning_rad_s, dt_s, live).take(force_N);
  live.v_m_s = law_.advance(force_N, turning_rad_s, dt_s, live.at);
  live.t_s += dt_s;
  live.theta_rad += turning_rad_s * dt_s;
  return live.v_m_s;
}

}  // namespace models
}  // namespace tractus
