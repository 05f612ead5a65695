#include "app/lengths.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/trim.hpp"

namespace tractus {
namespace commands {
namespace {

/// Takes a unit off the end; metres per unit.
double unit_of(std::string_view& text) {
  text = core::trimmed(text);
  double metres = 1e-3;
  if (text.ends_with("mm"))
    text.remove_suffix(2);
  else if (text.ends_with('m'))
    metres = 1.0, text.remove_suffix(1);
  text = core::trimmed(text);
  return metres;
}

std::optional<double> number(std::string_view text) {
  text = core::trimmed(text);
  double value = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
    return std::nullopt;
  return value;
}

core::Error bad(const std::string& option, const std::string& text, const char* expected) {
  return {core::Errc::bad_input, fmt::format("{}: '{}': {} is expected", option, text, expected)};
}

}  // namespace

core::Result<double> length_m(const std::string& text, const std::string& option) {
  std::string_view rest = text;
  const double metres = unit_of(rest);
  const auto value = number(rest);
  if (!value) return bad(option, text, "a length in mm, as 1.5, 1.5mm or 0.0015m,");
  return *value * metres;
}

core::Result<math::Vec3> point_m(const std::string& text, const std::string& option) {
  std::string_view rest = text;
  const double metres = unit_of(rest);
  math::Vec3 point;
  for (int a = 0; a < 3; ++a) {
    const auto comma = rest.find(',');
    const auto value = number(rest.substr(0, comma));
    if (!value || (a < 2) == (comma == std::string_view::npos))
      return bad(option, text, "a point x,y,z in mm (LPS), as 45.5,200,-61,");
    point[a] = *value * metres;
    if (a < 2) rest.remove_prefix(comma + 1);
  }
  return point;
}

}  // namespace commands
}  // namespace tractus
