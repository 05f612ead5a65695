#include "effects/palpation_effect.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "effects/palpation_expression.hpp"

namespace tractus {
namespace effects {
namespace palpation {
std::vector<PalpationEffectInfo> all();  // made by the build from the files of palpation/
}

const std::vector<PalpationEffectInfo>& palpation_effects() {
  static const std::vector<PalpationEffectInfo> kAll = palpation::all();
  return kAll;
}

const PalpationEffectInfo* find_palpation_effect(std::string_view id) {
  for (const PalpationEffectInfo& info : palpation_effects())
    if (info.facts.id == id) return &info;
  return nullptr;
}

namespace {

core::Error unknown_palpation_effect(std::string_view id) {
  return {core::Errc::not_found, fmt::format("'{}' is not an effect of palpation", id)};
}

}  // namespace

core::Result<EffectFacts> palpation_facts(const EffectInstance& use) {
  if (is_expression(use.id)) {
    const auto expression = TRY(Expression::of(use, palpation_expressions()));
    return expression.facts();
  }
  const auto* found = find_palpation_effect(use.id);
  if (!found) return unknown_palpation_effect(use.id);
  return found->facts;
}

core::Result<PalpationEffect> make_palpation_effect(const EffectInstance& use) {
  if (is_expression(use.id)) return make_palpation_expression(use);
  const auto* found = find_palpation_effect(use.id);
  if (!found) return unknown_palpation_effect(use.id);
  TRY(check(found->facts, use.values));
  return found->make(use.values);
}

}  // namespace effects
}  // namespace tractus
