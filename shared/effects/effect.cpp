#include "effects/effect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace tractus {
namespace effects {

namespace {
/// exp(log(high)) may lie a bit beyond high; that is still the range's end.
constexpr double kRounding = 1e-12;
}  // namespace

std::string unit_of(const Param& param) {
  using Ending = std::pair<std::string_view, std::string_view>;
  static constexpr std::array<Ending, 16> kEndings{{{"_Ns2_per_m2", "N·s²/m²"},
                                                    {"_Nm_per_rad", "N·m/rad"},
                                                    {"_Ns_per_m", "N·s/m"},
                                                    {"_N_per_m", "N/m"},
                                                    {"_s_per_rad", "s/rad"},
                                                    {"_per_m", "1/m"},
                                                    {"_rad_s", "rad/s"},
                                                    {"_m_s", "m/s"},
                                                    {"_rad", "rad"},
                                                    {"_Nm", "N·m"},
                                                    {"_Pa", "Pa"},
                                                    {"_kg", "kg"},
                                                    {"_Hz", "Hz"},
                                                    {"_N", "N"},
                                                    {"_m", "m"},
                                                    {"_s", "s"}}};
  if (!param.unit.empty()) return param.unit;
  const auto found = std::ranges::find_if(
      kEndings, [&](const Ending& ending) { return param.name.ends_with(ending.first); });
  return found == kEndings.end() ? "1" : std::string(found->second);
}

std::size_t value_count(const EffectFacts& facts) {
  std::size_t count = 0;
  for (const Param& param : facts.params) count += std::size_t(param.components);
  return count;
}

core::Result<void> check(const EffectFacts& facts, std::span<const double> values) {
  if (values.size() != value_count(facts))
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: {} numbers where {} are expected", facts.id, values.size(),
                                   value_count(facts))};
  std::size_t next = 0;
  for (const Param& param : facts.params)
    for (int k = 0; k < param.components; ++k) {
      const double value = values[next++];
      const double rounding = kRounding * std::max(std::abs(param.low), std::abs(param.high));
      if (!(value >= param.low - rounding && value <= param.high + rounding))
        return core::Error{core::Errc::out_of_range,
                           fmt::format("{}/{}: {} is outside {} … {}", facts.id, param.name, value,
                                       param.low, param.high)};
    }
  return {};
}

}  // namespace effects
}  // namespace tractus
