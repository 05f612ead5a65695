#include "effects/palpation_effect.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace effects {
namespace palpation {
std::vector<PalpationEffectInfo> all();  // made by the build from the files of palpation/
}

const std::vector<PalpationEffectInfo>& palpation_effects() {
  static const std::vector<PalpationEffectInfo> kAll = palpation::all();
  return kAll;
}

core::Result<PalpationEffect> make_palpation_effect(const Use& use) {
  const auto& all = palpation_effects();
  const auto found =
      std::ranges::find_if(all, [&](const auto& info) { return info.facts.id == use.id; });
  if (found == all.end())
    return core::Error{core::Errc::not_found,
                       fmt::format("'{}' is not an effect of palpation", use.id)};
  if (auto ok = check(found->facts, use.values); !ok) return ok.error();
  return found->make(use.values);
}

}  // namespace effects
