#include "effects/probing_effect.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace effects {
namespace probing {
std::vector<ProbingEffectInfo> all();  // made by the build from the files of probing/
}

const std::vector<ProbingEffectInfo>& probing_effects() {
  static const std::vector<ProbingEffectInfo> kAll = probing::all();
  return kAll;
}

core::Result<std::unique_ptr<ProbingEffect>> make_probing_effect(const Use& use) {
  const auto& all = probing_effects();
  const auto found =
      std::ranges::find_if(all, [&](const auto& info) { return info.facts.id == use.id; });
  if (found == all.end())
    return core::Error{core::Errc::not_found,
                       fmt::format("'{}' is not an effect of the probing rig", use.id)};
  if (auto ok = check(found->facts, use.values); !ok) return ok.error();
  return found->make(use.values);
}

}  // namespace effects
