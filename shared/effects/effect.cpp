#include "effects/effect.hpp"

#include <fmt/format.h>

#include <cmath>

namespace effects {

std::string_view name(Kind kind) {
  switch (kind) {
    case Kind::force:
      return "force";
    case Kind::structure:
      return "structure";
    case Kind::measurement:
      return "measurement";
  }
  return "";
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
      if (!(std::isfinite(value) && value >= param.low && value <= param.high))
        return core::Error{core::Errc::out_of_range,
                           fmt::format("{}/{}: {} is outside {} … {}", facts.id, param.name, value,
                                       param.low, param.high)};
    }
  return {};
}

}  // namespace effects
