#include "lab/rigs/palpation/parameter_space.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "effects/palpation_effect.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

using laws::PalpationParameters;

constexpr const auto& kPalpationPrior = kSettings.palpation_prior;

Parameter factor(double start, double prior_sd) {
  Parameter p{};
  p.start = start;
  p.low = start / kPalpationPrior.most_factor;
  p.high = start * kPalpationPrior.most_factor;
  p.step = kPalpationPrior.logarithmic_step;
  p.logarithmic = true;
  p.prior_sd = prior_sd;
  return p;
}

Parameter length(double start, double low, double high) {
  Parameter p{};
  p.start = start;
  p.low = low;
  p.high = high;
  p.step = 2e-5;
  p.prior_sd = kPalpationPrior.length_sd_m;
  return p;
}

/// The catalogue's effect that delays the force.
std::string delaying_effect() {
  const auto& all = effects::palpation_effects();
  const auto found =
      std::ranges::find_if(all, [](const auto& info) { return info.facts.is_delay; });
  core::require(found != all.end(), "an effect of the catalogue delays the force");
  return found->facts.id;
}

}  // namespace

const effects::EffectFacts& PalpationParameterSpace::facts_of(std::string_view id) const {
  if (const auto* facts = user_effects_.facts(id)) return *facts;
  if (const auto* info = effects::find_palpation_effect(id)) return info->facts;
  core::require(false, "an effect of a structure is in the catalogue");
  std::abort();
}

PalpationParameterSpace::PalpationParameterSpace(models::PalpationModel model, double field_per_m,
                                                 UserEffects user_effects)
    : model_(std::move(model)), user_effects_(std::move(user_effects)), field_per_m_(field_per_m) {
  for (const effects::EffectInstance& use : model_.effects) {
    auto facts = effects::palpation_facts(use);
    core::require(bool(facts), "a model's effects are known");
    own_.push_back(std::move(*facts));
  }
  const PalpationParameters& p = model_.base;
  add("force_factor_Nm", &PalpationParameters::force_factor_Nm,
      factor(p.force_factor_Nm, kPalpationPrior.factor_sd));
  add("force_scale", &PalpationParameters::force_scale,
      factor(p.force_scale, kPalpationPrior.factor_sd));
  add("torque_scale", &PalpationParameters::torque_scale,
      factor(p.torque_scale, kPalpationPrior.factor_sd));
  if (p.points > 1)
    add("point_spacing_m", &PalpationParameters::point_spacing_m,
        length(p.point_spacing_m, 0.3 * p.point_spacing_m,
               std::min(3.0 * p.point_spacing_m, 0.95 * p.length_m / (p.points - 1))));
  add("youngs_modulus_Pa", &PalpationParameters::youngs_modulus_Pa,
      factor(p.youngs_modulus_Pa, kPalpationPrior.factor_sd));
  add("length_m", &PalpationParameters::length_m,
      length(p.length_m, std::max(0.8 * p.length_m, 1.01 * (p.points - 1) * p.point_spacing_m),
             1.2 * p.length_m));
  add("radius_m", &PalpationParameters::radius_m, factor(p.radius_m, kPalpationPrior.radius_sd));
  add_delay();
}

void PalpationParameterSpace::add(const char* name, double PalpationParameters::*held,
                                  Parameter parameter) {
  parameter.pointer = fmt::format("/base/{}", name);
  if (fixed(parameter.pointer) || replaced(held) || !(parameter.start > 0.0)) return;
  slots_.push_back({held, std::move(parameter)});
}

void PalpationParameterSpace::add_delay() {
  Parameter delay{};
  delay.pointer = "/sensor/force_delay_s";
  if (fixed(delay.pointer) || std::ranges::any_of(own_, &effects::EffectFacts::is_delay)) return;
  delay.high = kPalpationPrior.most_delay_s;
  delay.low = -delay.high;
  delay.step = 0.1 * delay.high;
  delay.prior_sd = 0.5 * delay.high;
  slots_.push_back({nullptr, std::move(delay)});
}

bool PalpationParameterSpace::delays(const Structure& structure) const {
  return std::ranges::any_of(structure.effects,
                             [&](const std::string& id) { return facts_of(id).is_delay; });
}

bool PalpationParameterSpace::fixed(const std::string& pointer) const {
  return std::ranges::any_of(model_.fixed, [&](const auto& p) { return covers(p, pointer); });
}

bool PalpationParameterSpace::replaced(double PalpationParameters::*held) const {
  return std::ranges::any_of(model_.effects, [&](const auto& use) {
    const auto* info = effects::find_palpation_effect(use.id);
    return info && info->replaces == held;
  });
}

std::string PalpationParameterSpace::drift(const Structure& structure) const {
  for (const std::string& id : structure.effects)
    if (facts_of(id).free_per_trial) return id;
  return {};
}

std::vector<Parameter> PalpationParameterSpace::of_effect(const effects::EffectFacts& facts) const {
  const auto* info = effects::find_palpation_effect(facts.id);
  const effects::Starts begin = starts(facts.id);
  auto out = parameters_of(facts);
  for (std::size_t k = 0; k < out.size(); ++k) {
    Parameter& p = out[k];
    if (p.logarithmic) p.step = kPalpationPrior.logarithmic_step;
    if (p.shape && !begin.empty()) p.start = std::clamp(begin.front()[k], p.low, p.high);
    if (info && info->replaces) {
      p.shape = false;
      p.start = p.off = model_.base.*info->replaces;
    }
  }
  return out;
}

std::vector<Parameter> PalpationParameterSpace::parameters(const Structure& structure) const {
  std::vector<Parameter> out;
  const bool own_delay = delays(structure);
  for (const Slot& slot : slots_)
    if (slot.held || !own_delay) out.push_back(slot.parameter);
  for (std::size_t e = 0; e < own_.size(); ++e) {
    auto own = of_effect(own_[e]);
    for (std::size_t k = 0; k < own.size(); ++k) {
      own[k].start = model_.effects[e].values[k];
      own[k].shape = false;
      out.push_back(own[k]);
    }
  }
  for (const std::string& id : structure.effects)
    for (auto& p : of_effect(facts_of(id))) out.push_back(p);
  return out;
}

effects::Starts PalpationParameterSpace::starts(std::string_view effect) const {
  const auto* info = effects::find_palpation_effect(effect);
  if (!info) return {};
  return info->starts ? info->starts({model_.base.radius_m, field_per_m_}) : info->facts.starts;
}

models::PalpationModel PalpationParameterSpace::with(const Structure& structure,
                                                     std::span<const double> values) const {
  models::PalpationModel out = model_;
  std::size_t at = 0;
  const bool own_delay = delays(structure);
  for (const Slot& slot : slots_)
    if (slot.held)
      out.base.*slot.held = values[at++];
    else if (!own_delay)
      ++at;  // of the recording, not of the model
  for (std::size_t e = 0; e < own_.size(); ++e)
    if (!own_[e].free_per_trial)
      for (double& value : out.effects[e].values) value = values[at++];
  for (const std::string& id : structure.effects) {
    const effects::EffectFacts& facts = facts_of(id);
    if (facts.free_per_trial) continue;
    effects::EffectInstance use = user_effects_.use(id, {});
    for (std::size_t k = 0; k < effects::value_count(facts); ++k)
      use.values.push_back(values[at++]);
    out.effects.push_back(std::move(use));
  }
  core::require(at == values.size(), "a structure has as many values as parameters");
  return out;
}

models::PalpationModel PalpationParameterSpace::recorded(const Structure& structure,
                                                         std::span<const double> values) const {
  models::PalpationModel out = with(structure, values);
  if (delays(structure)) return out;
  for (std::size_t k = 0; k < slots_.size(); ++k)
    if (!slots_[k].held) out.effects.push_back({delaying_effect(), {values[k]}});
  return out;
}

}  // namespace lab
}  // namespace tractus
