#include "lab/rigs/probing/parameter_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "effects/probing_effect.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kProbingPrior = kSettings.probing_prior;

Parameter factor(double start, double low, double high) {
  Parameter p{};
  p.start = start;
  p.low = low;
  p.high = high;
  p.logarithmic = true;
  p.step = 1e-3;
  p.prior_sd = kProbingPrior.factor_sd;
  return p;
}

}  // namespace

const effects::EffectFacts& ProbingParameterSpace::facts_of(std::string_view id) const {
  if (const auto* facts = user_effects_.facts(id)) return *facts;
  for (const effects::EffectFacts& facts : own_)
    if (facts.id == id) return facts;
  if (const auto* info = effects::find_probing_effect(id)) return info->facts;
  core::require(false, "an effect of a structure is in the catalogue");
  std::abort();
}

ProbingParameterSpace::ProbingParameterSpace(models::ProbingModel model, const Reach& reach,
                                             UserEffects user_effects)
    : model_(std::move(model)), user_effects_(std::move(user_effects)) {
  for (const effects::EffectInstance& use : model_.effects) {
    const auto facts = effects::probing_facts(use);
    core::require(bool(facts), "a model's effects were checked as it was read");
    own_.push_back(*facts);
  }
  if (reach.slides) {
    for (std::size_t k = 0; k < model_.layers.size(); ++k) add_layer(k, reach);
    add_delay("force_delay_s", reach.spacing_s);
    return;
  }
  const laws::RotaryStage& r = model_.rotary;
  const auto rotary = [](double start, double low, double high) {
    Parameter p{};
    p.start = start, p.low = low, p.high = high;
    p.step = 1e-3 * std::max(start, 1e-3);
    p.prior_sd = std::max(start, 1e-2);
    return p;
  };
  add(Kind::viscous, 0, "viscous_Nms_per_rad", rotary(r.viscous_Nms_per_rad, 0.0, 10.0));
  add(Kind::detent, 0, "detent_Nm", rotary(r.detent_Nm, 0.0, 10.0));
  Parameter pitch = factor(r.detent_pitch_rad, 0.5 * r.detent_pitch_rad, 2.0 * r.detent_pitch_rad);
  pitch.low = std::max(pitch.low, 1e-3);
  pitch.high = std::min(pitch.high, 7.0);
  pitch.step = 1e-5;
  pitch.prior_sd = 0.05;
  add(Kind::pitch, 0, "detent_pitch_rad", pitch);
  add_delay("torque_delay_s", reach.spacing_s);
}

bool ProbingParameterSpace::fixed(const std::string& pointer) const {
  return std::ranges::any_of(model_.fixed,
                             [&](const std::string& p) { return covers(p, pointer); });
}

void ProbingParameterSpace::add(Kind kind, std::size_t layer, const char* name,
                                const Parameter& parameter) {
  Parameter p = parameter;
  p.pointer = kind >= Kind::viscous ? fmt::format("/base/rotary/{}", name)
              : kind == Kind::delay ? fmt::format("/sensor/{}", name)
                                    : fmt::format("/base/layers/{}/{}", layer, name);
  if (fixed(p.pointer)) return;
  slots_.push_back({kind, layer});
  base_.push_back(std::move(p));
}

void ProbingParameterSpace::add_layer(std::size_t k, const Reach& reach) {
  const laws::Layer& layer = model_.layers[k];
  const double end_m = layer.start_m + layer.thickness_m;
  if (layer.start_m > reach.most_m || end_m < reach.least_m) {
    notes_.push_back(fmt::format(
        "layer {} ({:.4g} to {:.4g} m) was not entered by any trial: its numbers stay as they are",
        k, layer.start_m, end_m));
    return;
  }
  if (layer.stiffness_N_per_m > 0.0)
    add(Kind::stiffness, k, "stiffness_N_per_m",
        factor(layer.stiffness_N_per_m, layer.stiffness_N_per_m / kProbingPrior.most_factor,
               std::min(2e5, layer.stiffness_N_per_m * kProbingPrior.most_factor)));
  add(Kind::damping, k, "damping_Ns_per_m",
      factor(layer.damping_Ns_per_m, layer.damping_Ns_per_m / kProbingPrior.most_factor,
             std::min(1e6, layer.damping_Ns_per_m * kProbingPrior.most_factor)));
  Parameter place{};
  place.step = kProbingPrior.place_step_m;
  place.prior_sd = kProbingPrior.place_sd_m;
  if (layer.stiffness_N_per_m > 0.0) {
    place.start = layer.equilibrium_m;
    place.low = layer.equilibrium_m - 0.1;
    place.high = layer.equilibrium_m + 0.1;
    add(Kind::equilibrium, k, "equilibrium_m", place);
  }
  place.rough = kProbingPrior.rough_m;
  const auto near = [&](double border_m) {
    return border_m > reach.least_m - kProbingPrior.near_m &&
           border_m < reach.most_m + kProbingPrior.near_m;
  };
  const double before_m =
      k == 0 ? 0.0 : model_.layers[k - 1].start_m + model_.layers[k - 1].thickness_m;
  const bool joined = k > 0 && layer.start_m - before_m < kProbingPrior.same_border_m;
  if (near(layer.start_m) && reach.least_m < layer.start_m) {
    place.start = layer.start_m;
    // A border stays on its side of the middle of each of its layers, so that none passes another.
    place.low =
        joined ? model_.layers[k - 1].start_m +
                     std::max(0.55 * model_.layers[k - 1].thickness_m, kProbingPrior.least_layer_m)
               : before_m;
    place.low = std::min(place.low, layer.start_m);
    place.high =
        layer.start_m + std::max(0.0, 0.45 * layer.thickness_m - kProbingPrior.least_layer_m);
    if (place.high > place.low) add(Kind::start, k, "start_m", place);
  }
  const bool followed = k + 1 < model_.layers.size() &&
                        model_.layers[k + 1].start_m - end_m < kProbingPrior.same_border_m;
  if (!followed && near(end_m) && reach.most_m > end_m) {
    place.start = layer.thickness_m;
    place.low = 0.55 * layer.thickness_m;
    place.high = k + 1 < model_.layers.size() ? model_.layers[k + 1].start_m - layer.start_m
                                              : 2.0 * layer.thickness_m;
    if (place.high > place.low) add(Kind::end, k, "thickness_m", place);
  }
}

void ProbingParameterSpace::add_delay(const char* name, double spacing_s) {
  if (std::ranges::any_of(own_, &effects::EffectFacts::is_delay)) return;
  Parameter delay{};
  delay.start = 0.0;
  delay.high = std::max(kProbingPrior.most_delay_s, spacing_s);
  delay.low = -delay.high;
  delay.step = 0.1 * spacing_s;
  delay.prior_sd = 0.5 * delay.high;
  add(Kind::delay, 0, name, delay);
}

bool ProbingParameterSpace::delays(const Structure& structure) const {
  return std::ranges::any_of(structure.effects,
                             [&](const std::string& id) { return facts_of(id).is_delay; });
}

double ProbingParameterSpace::sensor_delay_s(const Structure& structure,
                                             std::span<const double> values) const {
  if (delays(structure)) return 0.0;
  for (std::size_t k = 0; k < slots_.size(); ++k)
    if (slots_[k].kind == Kind::delay) return values[k];
  return 0.0;
}

void ProbingParameterSpace::begin_at_delay(double delay_s) {
  for (std::size_t k = 0; k < slots_.size(); ++k)
    if (slots_[k].kind == Kind::delay)
      base_[k].start = std::clamp(delay_s, base_[k].low, base_[k].high);
}

bool ProbingParameterSpace::has(std::string_view effect) const {
  return std::ranges::any_of(model_.effects, [&](const auto& use) { return use.id == effect; });
}

std::string ProbingParameterSpace::drift(const Structure& structure) const {
  for (const effects::EffectFacts& facts : own_)
    if (facts.free_per_trial) return facts.id;
  for (const std::string& id : structure.effects)
    if (facts_of(id).free_per_trial) return id;
  return {};
}

std::vector<Parameter> ProbingParameterSpace::parameters(const Structure& structure) const {
  std::vector<Parameter> out = base_;
  if (delays(structure))
    std::erase_if(out, [](const Parameter& p) { return p.pointer.starts_with("/sensor/"); });
  for (std::size_t e = 0; e < own_.size(); ++e) {
    auto own = parameters_of(own_[e]);
    for (std::size_t k = 0; k < own.size(); ++k) {
      if (fixed("/effects/" + own[k].pointer)) continue;
      own[k].start = std::clamp(model_.effects[e].values[k], own[k].low, own[k].high);
      own[k].shape = false;
      out.push_back(own[k]);
    }
  }
  for (const std::string& id : structure.effects)
    for (auto& p : parameters_of(facts_of(id))) out.push_back(p);
  return out;
}

models::ProbingModel ProbingParameterSpace::with(const Structure& structure,
                                                 std::span<const double> values) const {
  models::ProbingModel out = model_;
  std::size_t at = 0;
  const bool own_delay = delays(structure);
  for (const Slot& slot : slots_) {
    if (slot.kind == Kind::delay && own_delay) continue;
    const double v = values[at++];
    if (slot.kind == Kind::delay) continue;  // of the recording, not of the model
    if (slot.kind >= Kind::viscous) {
      (slot.kind == Kind::viscous  ? out.rotary.viscous_Nms_per_rad
       : slot.kind == Kind::detent ? out.rotary.detent_Nm
                                   : out.rotary.detent_pitch_rad) = v;
      continue;
    }
    laws::Layer& layer = out.layers[slot.layer];
    switch (slot.kind) {
      case Kind::stiffness:
        layer.stiffness_N_per_m = v;
        break;
      case Kind::damping:
        layer.damping_Ns_per_m = v;
        break;
      case Kind::equilibrium:
        layer.equilibrium_m = v;
        break;
      case Kind::start: {
        const laws::Layer& was = model_.layers[slot.layer];
        layer.thickness_m = was.start_m + was.thickness_m - v;
        layer.start_m = v;
        if (slot.layer > 0) {
          const laws::Layer& before = model_.layers[slot.layer - 1];
          if (was.start_m - before.start_m - before.thickness_m < kProbingPrior.same_border_m)
            out.layers[slot.layer - 1].thickness_m = v - out.layers[slot.layer - 1].start_m;
        }
        break;
      }
      default:
        layer.thickness_m = v;
    }
  }
  out.effects.clear();
  for (std::size_t e = 0; e < own_.size(); ++e) {
    effects::EffectInstance use = model_.effects[e];
    const auto own = parameters_of(own_[e]);
    for (std::size_t k = 0; k < own.size(); ++k)
      if (!fixed("/effects/" + own[k].pointer)) use.values[k] = values[at++];
    if (!own_[e].free_per_trial) out.effects.push_back(std::move(use));
  }
  for (const std::string& id : structure.effects) {
    const auto& facts = facts_of(id);
    const std::size_t n = parameters_of(facts).size();
    if (!facts.free_per_trial)
      out.effects.push_back(user_effects_.use(
          id, {values.begin() + std::ptrdiff_t(at), values.begin() + std::ptrdiff_t(at + n)}));
    at += n;
  }
  core::require(at == values.size(), "as many values as the structure has parameters");
  return out;
}

}  // namespace lab
}  // namespace tractus
