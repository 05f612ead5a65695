#include "effects/dimension.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <cstdlib>
#include <vector>

namespace tractus {
namespace effects {
namespace {

constexpr int kOne = 60;
constexpr double kMostPower = 100.0;

core::Error no_unit(std::string_view unit, std::string_view part) {
  return {
      core::Errc::bad_input,
      fmt::format("'{}': '{}' is no unit; m, kg, s, N, Pa, J, W, Hz, rad and 1 are, joined by *, "
                  "/ and ^",
                  unit, part)};
}

/// A unit's symbol and, after ^, its power: "s^2", "m^-1", "s^0.4".
struct UnitFactor {
  std::string_view symbol;
  double power = 1.0;
};

std::optional<UnitFactor> factor_of(std::string_view part) {
  const auto caret = part.find('^');
  if (caret == std::string_view::npos) return UnitFactor{part, 1.0};
  const std::string power(part.substr(caret + 1));
  char* end = nullptr;
  const double value = std::strtod(power.c_str(), &end);
  const bool sixtieth = std::abs(60.0 * value - std::round(60.0 * value)) < 1e-6;
  if (power.empty() || *end != '\0' || !(std::abs(value) <= 12.0) || !sixtieth) return std::nullopt;
  return UnitFactor{part.substr(0, caret), value};
}

void print(std::string& over, std::string& under, const char* symbol, int sixtieths) {
  if (sixtieths == 0) return;
  std::string text = symbol;
  const double power = std::abs(sixtieths) / double(kOne);
  if (power != 1.0) text += fmt::format("^{:.4g}", power);
  if (sixtieths < 0)
    under += "/" + text;
  else
    over += (over.empty() ? "" : "*") + text;
}

}  // namespace

core::Result<Dimension> Dimension::parse(std::string_view unit) {
  Dimension out;
  std::string text;
  for (std::size_t k = 0; k < unit.size(); ++k) {
    if (unit.substr(k).starts_with("·")) {
      text += '*';
      ++k;
    } else if (unit[k] != ' ') {
      text += unit[k];
    }
  }
  if (text.empty() || text.size() > 64)
    return core::Error{core::Errc::bad_input, "a unit is expected, as \"N*s/m\" or \"1\""};
  bool over = true;
  for (std::size_t from = 0; from <= text.size();) {
    const auto to = std::min(text.find_first_of("*/", from), text.size());
    const std::string_view part = std::string_view(text).substr(from, to - from);
    const auto factor = factor_of(part);
    if (!factor) return no_unit(unit, part);
    const auto known = [&]() -> std::optional<Dimension> {
      const std::string_view s = factor->symbol;
      if (s == "1" || s == "rad") return Dimension();
      if (s == "m") return Dimension(kOne, 0, 0);
      if (s == "kg") return Dimension(0, kOne, 0);
      if (s == "s") return Dimension(0, 0, kOne);
      if (s == "Hz") return Dimension(0, 0, -kOne);
      if (s == "N") return Dimension(kOne, kOne, -2 * kOne);
      if (s == "Pa") return Dimension(-kOne, kOne, -2 * kOne);
      if (s == "J") return Dimension(2 * kOne, kOne, -2 * kOne);
      if (s == "W") return Dimension(2 * kOne, kOne, -3 * kOne);
      return std::nullopt;
    }();
    if (!known) return no_unit(unit, part);
    out = out * *known->power(over ? factor->power : -factor->power);
    if (to == text.size()) break;
    over = text[to] == '*';
    from = to + 1;
  }
  return out;
}

std::optional<std::array<int, 3>> Dimension::whole_powers() const noexcept {
  std::array<int, 3> out{};
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (sixtieths_[k] % kOne != 0) return std::nullopt;
    out[k] = sixtieths_[k] / kOne;
  }
  return out;
}

Dimension Dimension::operator*(const Dimension& other) const noexcept {
  return {sixtieths_[0] + other.sixtieths_[0], sixtieths_[1] + other.sixtieths_[1],
          sixtieths_[2] + other.sixtieths_[2]};
}

Dimension Dimension::operator/(const Dimension& other) const noexcept {
  return {sixtieths_[0] - other.sixtieths_[0], sixtieths_[1] - other.sixtieths_[1],
          sixtieths_[2] - other.sixtieths_[2]};
}

std::optional<Dimension> Dimension::power(double exponent) const {
  std::array<int, 3> out{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double exact = sixtieths_[k] * exponent;
    if (!(std::abs(exact) <= kMostPower * kOne) || std::abs(exact - std::round(exact)) > 1e-6)
      return std::nullopt;
    out[k] = int(std::lround(exact));
  }
  return Dimension(out[0], out[1], out[2]);
}

std::string Dimension::text() const {
  const auto [metre, kilogram, second] = sixtieths_;
  std::string over, under;
  const bool newton = kilogram != 0 && (metre != 0 || second != 0);
  print(over, under, newton ? "N" : "kg", kilogram);
  print(over, under, "m", newton ? metre - kilogram : metre);
  print(over, under, "s", newton ? second + 2 * kilogram : second);
  return (over.empty() ? "1" : over) + under;
}

}  // namespace effects
}  // namespace tractus
