#include "lab/identify/verdict_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "effects/catalogues.hpp"

namespace tractus {
namespace lab {
namespace {

/// Units that a name may end in, longest first, and how people write them.
constexpr std::array<std::pair<std::string_view, std::string_view>, 22> kWrittenUnits{{
    {"_Ns2_per_m2", "N·s²/m²"},
    {"_Nms_per_rad", "N·m·s/rad"},
    {"_Nm_per_rad", "N·m/rad"},
    {"_kg_m2", "kg·m²"},
    {"_Ns_per_m", "N·s/m"},
    {"_N_per_m", "N/m"},
    {"_s_per_rad", "s/rad"},
    {"_rad_s2", "rad/s²"},
    {"_per_rad", "1/rad"},
    {"_rad_s", "rad/s"},
    {"_per_m", "1/m"},
    {"_m_s2", "m/s²"},
    {"_N_s", "N/s"},
    {"_m_s", "m/s"},
    {"_rad", "rad"},
    {"_Nm", "N·m"},
    {"_Pa", "Pa"},
    {"_kg", "kg"},
    {"_N", "N"},
    {"_m", "m"},
    {"_s", "s"},
    {"_Hz", "Hz"},
}};

std::string joined(const std::vector<std::string>& parts) {
  std::string out;
  for (std::size_t k = 0; k < parts.size(); ++k)
    out += (k == 0 ? "" : k + 1 == parts.size() ? " and " : ", ") + parts[k];
  return out;
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = char(text[0] - 'a' + 'A');
  return text;
}

/// What the rest varies with: the engine names signals, or says in a sentence that there is none.
std::string on_what(const std::string& depends) {
  if (depends.empty()) return "";
  return depends.starts_with("no ") ? " " + capital(depends) + "."
                                    : " It varies with " + depends + ".";
}

std::string times_floor(double rmse, double floor) {
  return floor > 0.0 ? fmt::format("{:.2g} times", rmse / floor) : "";
}

}  // namespace

NameAndUnit name_and_unit(std::string_view name) {
  NameAndUnit out{std::string(name), ""};
  for (const auto& [suffix, unit] : kWrittenUnits)
    if (name.ends_with(suffix) && name.size() > suffix.size()) {
      out.name = name.substr(0, name.size() - suffix.size());
      out.unit = unit;
      break;
    }
  std::ranges::replace(out.name, '_', ' ');
  return out;
}

std::string figure(double value) {
  if (value < 0.0 && std::isfinite(value)) return "−" + figure(-value);
  if (!std::isfinite(value)) return "–";
  if (value == 0.0) return "0";
  const double size = std::abs(value);
  if (size >= 1000.0 && size < 1e6) return fmt::format("{:.0f}", value);
  if (size >= 1e6 || size < 1e-3) {
    const int exponent = int(std::floor(std::log10(size)));
    return fmt::format("{:.3g}e{}", value / std::pow(10.0, exponent), exponent);
  }
  return fmt::format("{:.3g}", value);
}

std::string figure_with_uncertainty(double value, double within) {
  if (!(within > 0.0) || !std::isfinite(within) || !std::isfinite(value)) return figure(value);
  const int decimals = 1 - int(std::floor(std::log10(within)));
  const bool plain = decimals <= 6 && std::abs(value) < 1e9 && std::abs(value) >= 1e-3;
  return plain ? fmt::format("{:.{}f}", value, std::max(0, decimals)) : figure(value);
}

std::string figure(double value, std::string_view unit) {
  return unit.empty() ? figure(value) : fmt::format("{} {}", figure(value), unit);
}

std::string text_of(const DetectionLimit& limit) {
  const std::string parameter = limit.parameter.substr(0, limit.parameter.find('/'));
  const auto [name, unit] = name_and_unit(parameter);
  return limit.value ? fmt::format("{} {}", name, figure(*limit.value, unit))
                     : fmt::format("{}: not within its range", name);
}

VerdictText sentences(const Diagnosis& d, std::string_view unit) {
  std::vector<std::string> names;
  for (const FoundEffect& found : d.effects) names.push_back(effects::label_of(found.id));
  const std::string these = capital(joined(names));
  const std::string are = names.size() == 1 ? "is" : "are";
  const double after = d.steps.empty() ? d.base.held_out_rmse : d.steps.back().held_out_rmse;
  const double floor = d.effects.empty() ? d.base.noise_floor : d.final_fit.noise_floor;
  const std::string change =
      fmt::format("On held-out trials the error {} from {} to {}; the noise floor is {}.",
                  after < d.base.held_out_rmse ? "falls" : "does not fall: it goes",
                  figure(d.base.held_out_rmse, unit), figure(after, unit), figure(floor, unit));
  switch (d.verdict) {
    case Verdict::complete:
      return {"No effect is missing.",
              fmt::format("The error of the refitted model on held-out trials, {}, is at the noise "
                          "floor, {}. No effect was added.",
                          figure(d.base.held_out_rmse, unit), figure(floor, unit))};
    case Verdict::missing:
      return {fmt::format("{} {} missing.", these, are),
              change + " This explains the remaining error."};
    case Verdict::partly:
      return {fmt::format("{} {} missing, and at least one other effect.", these, are),
              fmt::format("{} The remaining error is {} the noise floor.{}", change,
                          times_floor(after, floor), on_what(d.depends_on))};
    case Verdict::undecided:
      return {"These recordings cannot tell whether an effect is missing.",
              fmt::format("The error of the refitted model on held-out trials, {}, is at the noise "
                          "floor, but that is {}, "
                          "{:.0f} % of the force: an effect would be lost in it. Record with a "
                          "higher rate or a slower "
                          "motion, so that velocity and acceleration are known better, or with a "
                          "sensor of less noise.",
                          figure(d.base.held_out_rmse, unit), figure(floor, unit),
                          100.0 * d.floor_share)};
    case Verdict::unexplained:
      return {
          "A missing effect is not in the catalogue.",
          fmt::format("The error of the refitted model on held-out trials, {}, is {} the noise "
                      "floor, {}, and no effect of the catalogue explains the difference.{}",
                      figure(d.base.held_out_rmse, unit), times_floor(d.base.held_out_rmse, floor),
                      figure(floor, unit), on_what(d.depends_on))};
  }
  return {};
}

}  // namespace lab
}  // namespace tractus
