#include "effects/catalogues.hpp"

#include <algorithm>

#include "effects/expression.hpp"
#include "effects/palpation_effect.hpp"
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects {

const EffectFacts* find_facts(std::string_view rig, std::string_view id) {
  if (rig == probing_expressions().rig) {
    const auto* info = find_probing_effect(id);
    return info ? &info->facts : nullptr;
  }
  const auto* info = find_palpation_effect(id);
  return info ? &info->facts : nullptr;
}

std::string label_of(std::string_view id) {
  if (is_expression(id)) return expression_label(id);
  if (const auto* info = find_probing_effect(id)) return info->facts.label;
  if (const auto* info = find_palpation_effect(id)) return info->facts.label;
  std::string out(id);
  std::ranges::replace(out, '_', ' ');
  return out;
}

std::map<std::string, std::string> labels() {
  std::map<std::string, std::string> out;
  for (const auto& info : probing_effects()) out[info.facts.id] = info.facts.label;
  for (const auto& info : palpation_effects()) out[info.facts.id] = info.facts.label;
  return out;
}

}  // namespace effects
}  // namespace tractus
