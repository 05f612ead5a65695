#include "models/probing_runtime.hpp"

#include <algorithm>
#include <array>

namespace models {
namespace {

using effects::ProbingEffect;
using effects::ProbingStage;
using effects::ProbingTick;

constexpr std::size_t kMaxEffects = 32;
using States = std::array<double, kMaxEffects * effects::kMaxProbingStates>;

bool measures(const ProbingEffect& effect) { return effect.stage() >= ProbingStage::delay; }

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
          .rest_m_s = motion.rest_m_s};
}

}  // namespace

ProbingRuntime::ProbingRuntime(laws::ProbingLaw law, Effects effects)
    : law_(std::move(law)), effects_(std::move(effects)) {
  std::ranges::stable_sort(effects_, {}, [](const auto& effect) { return effect->stage(); });
  live_ = std::size_t(std::ranges::find_if(effects_, [](const auto& e) { return measures(*e); }) -
                      effects_.begin());
}

core::Result<ProbingRuntime> ProbingRuntime::make(const ProbingModel& model, double travel_m) {
  return make({.layers = model.layers, .walls = {}, .rotary = model.rotary, .travel_m = travel_m},
              model.effects);
}

core::Result<ProbingRuntime> ProbingRuntime::make(laws::ProbingParameters parameters,
                                                  std::span<const effects::Use> uses) {
  auto law = laws::ProbingLaw::make(std::move(parameters));
  if (!law) return law.error();
  if (uses.size() > kMaxEffects)
    return core::Error{core::Errc::too_large, "a model holds at most 32 effects"};
  Effects effects;
  for (const effects::Use& use : uses) {
    auto effect = effects::make_probing_effect(use);
    if (!effect) return effect.error();
    effects.push_back(std::move(*effect));
  }
  return ProbingRuntime(std::move(*law), std::move(effects));
}

void ProbingRuntime::predict_forces(const ProbingMotion& motion, std::span<double> fz_N) const {
  States states{};
  for (std::size_t k = 0; k < fz_N.size(); ++k) {
    const ProbingTick tick = tick_of(motion, k);
    ProbingTick seen = tick;
    double base_N = 0.0, scale = 1.0, added_N = 0.0;
    bool based = false;
    const auto base = [&] {
      if (!based) base_N = scale * law_.force_N(seen.x_m, seen.v_m_s);
      based = true;
    };
    for (std::size_t e = 0; e < live_; ++e) {
      const ProbingEffect& effect = *effects_[e];
      double* state = states.data() + e * effects::kMaxProbingStates;
      if (k == 0) effect.start(seen, state);
      const ProbingTick before = effect.stage() == ProbingStage::depth ? seen : tick;
      switch (effect.stage()) {
        case ProbingStage::depth:
          seen.x_m = effect.depth_m(seen, state);
          break;
        case ProbingStage::scale:
          scale *= effect.scale(tick);
          break;
        default:
          base();
          added_N += effect.force_N(tick, base_N, state);
      }
      effect.commit(before, state);
    }
    base();
    fz_N[k] = base_N + added_N;
  }
}

void ProbingRuntime::predict(const ProbingMotion& motion, ProbingForces& out) const {
  const std::size_t n = motion.size();
  out.fz_N.resize(n);
  predict_forces(motion, out.fz_N);
  for (std::size_t e = live_; e < effects_.size(); ++e) effects_[e]->record(motion, out.fz_N);
  const bool turns = motion.theta_rad.size() == n && motion.omega_rad_s.size() == n;
  out.tz_Nm.resize(turns ? n : 0);
  for (std::size_t k = 0; k < out.tz_Nm.size(); ++k)
    out.tz_Nm[k] = law_.torque_Nm(motion.x_m[k], motion.theta_rad[k], motion.omega_rad_s[k]);
}

}  // namespace models
