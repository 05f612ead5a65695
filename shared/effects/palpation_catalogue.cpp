#include <fmt/format.h>

#include <algorithm>

#include "effects/palpation_effect.hpp"

namespace effects {
namespace {

using core::Errc;
using core::Error;

}  // namespace

std::vector<PalpationEffectInfo> palpation_effects() { return palpation::all(); }

core::Result<PalpationEffect> make_palpation_effect(const Use& use) {
  const auto catalogue = palpation_effects();
  const auto info = std::ranges::find_if(
      catalogue, [&](const PalpationEffectInfo& each) { return each.facts.id == use.id; });
  if (info == catalogue.end())
    return Error{Errc::not_found, fmt::format("'{}' is not an effect of palpation", use.id)};
  std::size_t next = 0;
  for (const Param& param : info->facts.params)
    for (int c = 0; c < param.components; ++c, ++next) {
      if (next >= use.values.size()) break;
      const double value = use.values[next];
      if (!(value >= param.low && value <= param.high))
        return Error{Errc::out_of_range, fmt::format("{}: {} is outside {} … {}", param.name, value,
                                                     param.low, param.high)};
    }
  if (next != use.values.size())
    return Error{Errc::bad_input, fmt::format("'{}' has {} numbers, {} were given", use.id, next,
                                              use.values.size())};
  return info->make(use.values);
}

}  // namespace effects
