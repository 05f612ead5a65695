#include "lab/discover/grammar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "core/require.hpp"
#include "effects/expression.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kGrammar = kSettings.grammar;

effects::Dimension dimension(std::string_view unit) {
  const auto found = effects::Dimension::parse(unit);
  core::require(bool(found), "a unit of the grammar is one");
  return *found;
}

/// `count` values from low to high, evenly in their logarithm.
std::vector<double> from_to(double low, double high, int count) {
  std::vector<double> out;
  for (int k = 0; k < count; ++k)
    out.push_back(count == 1 ? low : low * std::pow(high / low, k / double(count - 1)));
  return out;
}

FactorNumber scale_number(const char* name, const char* unit, const char* meaning, double value) {
  return {name, unit, meaning, value, value / kGrammar.number_reach, value * kGrammar.number_reach};
}
FactorNumber depth_number(const char* name, const char* meaning, double value,
                          const SignalScales& s) {
  const double range = s.most_depth_m - s.least_depth_m;
  return {name, "m", meaning, value, s.least_depth_m - range, s.most_depth_m + range, false};
}

/// The list as it grows.
class Factors {
 public:
  explicit Factors(const SignalScales& scales) : s_(scales) {}

  std::vector<Factor> all() {
    places();
    speeds();
    if (s_.turning_rad_s > 0.0) turnings();
    memories();
    wholes();
    return std::move(out_);
  }

 private:
  Factor& add(FactorPart part, std::string text, const char* unit, std::string words,
              std::vector<FactorNumber> numbers = {}) {
    out_.push_back({part, std::move(text), dimension(unit), std::move(numbers), std::move(words)});
    return out_.back();
  }
  double range() const { return s_.most_depth_m - s_.least_depth_m; }
  double depth(double share) const { return s_.least_depth_m + share * range(); }

  void places() {
    add(FactorPart::place, "x_m", "m", "that grows with depth");
    add(FactorPart::place, "base_N", "N", "in proportion to the bone's resistance");
    add(FactorPart::place, "abs(base_N)", "N", "in proportion to the load (Amontons)");
    for (const double l : from_to(0.05 * range(), 1.5 * range(), 5))
      add(FactorPart::place, "exp(-x_m/decay_m)", "1", "that fades with depth",
          {scale_number("decay_m", "m", "depth over which it falls to 1/e", l)});
    for (int k = 0; k < 9; ++k)
      for (const double w : from_to(0.05 * range(), 0.4 * range(), 4))
        add(FactorPart::place, "exp(-((x_m - centre_m)/width_m)^2)", "1", "about one depth",
            {depth_number("centre_m", "depth of the middle", depth((k + 0.5) / 9), s_),
             scale_number("width_m", "m", "half width at 1/e", w)});
    for (const double at : {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9})
      add(FactorPart::place, "max(x_m - edge_m, 0)", "m", "a spring that begins at a depth",
          {depth_number("edge_m", "depth at which it begins", depth(at), s_)})
          .alone = true;
    add(FactorPart::place, "(x_m - centre_m)^2", "m^2",
        "a spring that stiffens to one side (quadratic)",
        {depth_number("centre_m", "depth at which it is 0", depth(0.5), s_)})
        .alone = true;
    for (const double at : {0.2, 0.5, 0.8})
      add(FactorPart::place, "(x_m - centre_m)^3", "m^3",
          "a spring that stiffens to both sides (Duffing)",
          {depth_number("centre_m", "depth at which it is 0", depth(at), s_)})
          .alone = true;
    for (const double share : {0.1, 0.2, 0.3, 0.5, 0.7, 0.85})
      add(FactorPart::place, "(max(abs(x_m - centre_m) - clearance_m, 0)*sgn(x_m - centre_m))", "m",
          "end stops with a clearance",
          {depth_number("centre_m", "depth of the middle", depth(0.5), s_),
           scale_number("clearance_m", "m", "way to each side without contact",
                        0.5 * share * range())})
          .alone = true;
    const double shortest = std::max(range() / kGrammar.most_waves, 1e-5);
    const int waves = int(2.0 * kGrammar.most_waves);
    for (int k = 1; k <= waves; ++k) {
      const double period = 1.0 / (1.0 / range() + k * (1.0 / shortest - 1.0 / range()) / waves);
      for (const double phase : {0.0, 0.5 * std::numbers::pi})
        add(FactorPart::place, "sin(2*pi*x_m/period_m + phase_rad)", "1",
            "a ripple along the depth",
            {scale_number("period_m", "m", "its period", period),
             {"phase_rad", "rad", "its phase at depth 0", phase, -7.0, 7.0, false}})
            .alone = true;
    }
  }

  void speeds() {
    add(FactorPart::speed, "v_m_s", "m/s", "viscous drag").odd_in_speed = true;
    add(FactorPart::speed, "sgn(v_m_s)", "1", "dry friction (Coulomb)").odd_in_speed = true;
    add(FactorPart::speed, "abs(v_m_s)", "m/s",
        "viscous drag that depends on the direction of motion");
    add(FactorPart::speed, "max(v_m_s, 0)", "m/s", "viscous drag on the way in alone");
    add(FactorPart::speed, "min(v_m_s, 0)", "m/s", "viscous drag on the way out alone");
    add(FactorPart::speed, "v_m_s*abs(v_m_s)", "m^2/s^2", "quadratic drag").odd_in_speed = true;
    add(FactorPart::speed, "v_m_s^3", "m^3/s^3", "cubic drag").odd_in_speed = true;
    for (const double v : from_to(0.5 * s_.slow_m_s, s_.fast_m_s, 7)) {
      add(FactorPart::speed, "sgn(v_m_s)*exp(-(v_m_s/stribeck_m_s)^2)", "1",
          "dry friction that falls with speed (Stribeck)",
          {scale_number("stribeck_m_s", "m/s", "speed at which it has fallen to 1/e", v)})
          .odd_in_speed = true;
      add(FactorPart::speed, "tanh(v_m_s/speed_m_s)", "1", "friction that saturates with speed",
          {scale_number("speed_m_s", "m/s", "speed at which it bends", v)})
          .odd_in_speed = true;
    }
    for (const double v : from_to(0.5 * s_.slow_m_s, s_.fast_m_s, 5))
      for (const double n : {0.25, 0.35})
        add(FactorPart::speed, "v_m_s*(1 + (v_m_s/speed_m_s)^2)^(-thinning)", "m/s",
            "drag that thins with speed (Carreau)",
            {scale_number("speed_m_s", "m/s", "speed at which it begins to thin", v),
             {"thinning", "1", "half of one less the exponent", n, 0.02, 0.6, false}})
            .odd_in_speed = true;
    for (int n = 12; n <= 54; n += 6) {  // sixtieths, which units are kept in
      Factor& f = add(FactorPart::speed, fmt::format("sgn(v_m_s)*abs(v_m_s)^{:.4g}", n / 60.0),
                      "m/s", "drag by a power of the speed (Ostwald)");
      f.unit = *f.unit.power(n / 60.0);
      f.odd_in_speed = true;
    }
  }

  void turnings() {
    add(FactorPart::turning, "abs(omega_rad_s)", "1/s", "in proportion to the turning");
    for (const double w : from_to(0.3 * s_.turning_rad_s, 3.0 * s_.turning_rad_s, 3))
      add(FactorPart::turning, "1/(1 + abs(omega_rad_s)/turning_rad_s)", "1", "eased by turning",
          {scale_number("turning_rad_s", "rad/s", "turning at which half is left", w)});
    const double radius = s_.fast_m_s / s_.turning_rad_s;
    for (const double r : from_to(0.1 * radius, 10.0 * radius, 7))
      add(FactorPart::whole, "v_m_s/max(sqrt(v_m_s^2 + (radius_m*omega_rad_s)^2), rest_m_s)", "1",
          "dry friction whose direction turns with the probe's surface",
          {scale_number("radius_m", "m", "radius at which it rubs", r),
           {"rest_m_s", "m/s", "a slower motion is rest", 1e-6, 5e-7, 2e-6}})
          .odd_in_speed = true;
  }

  void memories() {
    for (const double l : from_to(1e-4, 0.3 * range(), 6)) {
      add(FactorPart::memory, "since_reversal(x_m)/(since_reversal(x_m) + way_m)", "1",
          "that builds up after each reversal",
          {scale_number("way_m", "m", "way after which half is there", l)});
      add(FactorPart::memory, "exp(-since_reversal(x_m)/way_m)", "1",
          "that fades after each reversal",
          {scale_number("way_m", "m", "way after which 1/e is left", l)});
    }
    for (const double t : from_to(0.01, 0.3 * s_.longest_s, 5))
      add(FactorPart::memory, "exp(-since_stop(v_m_s)/time_s)", "1", "that fades after each stop",
          {scale_number("time_s", "s", "time after which 1/e is left", t)});
    for (const double d : from_to(3e-5, 1e-3, 4))
      for (const double t : {0.01, 0.1})
        add(FactorPart::memory, "ln(1 + age(x_m, way_m)/first_s)", "1",
            "that grows as the contact ages (Dieterich)",
            {scale_number("way_m", "m", "way that renews the contact", d),
             scale_number("first_s", "s", "age at which it begins to grow", t)});
    if (!(s_.work_J > 0.0)) return;
    for (const double w : from_to(0.03 * s_.work_J, 2.0 * s_.work_J, 6)) {
      add(FactorPart::memory, "(1 - exp(-work(base_N, x_m)/work_J))", "1",
          "lost with the work done (Mullins)",
          {scale_number("work_J", "N*m", "work that takes away 1 − 1/e", w)});
      add(FactorPart::memory, "(1 - exp(-(work(base_N, x_m) + work(-base_N, x_m))/work_J))", "1",
          "lost with the work done both ways (Mullins)",
          {scale_number("work_J", "N*m", "work that takes away 1 − 1/e", w)});
      for (const double sharp : {0.05, 0.2})
        add(FactorPart::memory, "1/(1 + exp((threshold_J - work(base_N, x_m))/width_J))", "1",
            "lost as the work done passes a threshold",
            {scale_number("threshold_J", "N*m", "work at which half is lost", w),
             scale_number("width_J", "N*m", "width of the threshold", sharp * w)});
    }
  }

  void wholes() {
    for (const double t : from_to(0.005, s_.longest_s, 9))
      add(FactorPart::whole, "(x_m - lag(x_m, time_s))", "m", "a spring that relaxes (Maxwell)",
          {scale_number("time_s", "s", "time in which it falls to 1/e", t)});
    for (const double t : from_to(5e-4, 0.2, 7))
      add(FactorPart::whole, "(lag(base_N, time_s) - base_N)", "N",
          "the bone's force late by a lag",
          {scale_number("time_s", "s", "time constant of the lag", t)});
    for (const double d : from_to(2e-5, 0.2 * range(), 9)) {
      add(FactorPart::whole, "dahl(x_m, yield_m)", "m", "hysteresis (Dahl)",
          {scale_number("yield_m", "m", "way over which it builds up", d)});
      for (const double g : {-1.3, -0.6, 0.5, 2.0})
        add(FactorPart::whole, "bouc_wen(x_m, yield_m, g)", "m", "hysteresis (Bouc–Wen)",
            {scale_number("yield_m", "m", "way over which it builds up", d),
             {"g", "1", "shape: below −1 it hardens, above 0 it softens", g, -5.0, 10.0, false}});
      add(FactorPart::whole, "(play(x_m, gap_m) - x_m)", "m", "a spring behind a play",
          {scale_number("gap_m", "m", "full width of the play", d)});
    }
    for (const double f : from_to(2.5, 70.0, 36))
      add(FactorPart::whole, "resonator(x_m, frequency_Hz, damping_ratio)", "m/s^2",
          "a mass on a spring and a damper inside the tool",
          {scale_number("frequency_Hz", "Hz", "its natural frequency", f),
           {"damping_ratio", "1", "its damping over the critical", 0.05, 1e-3, 2.0}})
          .alone = true;
  }

  const SignalScales& s_;
  std::vector<Factor> out_;
};

/// N, N/m, N·s/m, kg … : newtons over powers of metre and second up to the third.
bool of_mechanics(const effects::Dimension& amplitude) {
  static const std::set<std::string> kOthers{"1", "s", "1/m"};
  return amplitude.text().starts_with("N") || amplitude.text().starts_with("kg") ||
         kOthers.contains(amplitude.text());
}

bool may_multiply(const Factor& place_factor, const Factor& speed_factor) {
  if (place_factor.alone) return false;
  if (place_factor.text == "base_N") return false;  // its sign is that of the stroke's depth
  if (place_factor.text == "abs(base_N)") return speed_factor.odd_in_speed;
  return true;
}

}  // namespace

std::vector<Factor> factors_of(const SignalScales& scales) { return Factors(scales).all(); }

std::vector<Term> terms_of(const std::vector<Factor>& factors) {
  std::vector<Term> out;
  const auto keep = [&](std::vector<std::size_t> which) {
    Term term{std::move(which), "", dimension("N")};
    std::size_t numbers = 0;
    for (const std::size_t k : term.factors) {
      term.amplitude = term.amplitude / factors[k].unit;
      term.family += (term.family.empty() ? "" : " * ") + factors[k].text;
      numbers += factors[k].numbers.size();
    }
    if (of_mechanics(term.amplitude) && (term.factors.size() == 1 || numbers <= 2))
      out.push_back(std::move(term));
  };
  std::array<std::vector<std::size_t>, 5> by;
  for (std::size_t k = 0; k < factors.size(); ++k) by[std::size_t(factors[k].part)].push_back(k);
  const auto& [places, speeds, turnings, memories, wholes] = by;
  for (const std::size_t p : places) keep({p});
  for (const std::size_t v : speeds) {
    keep({v});
    for (const std::size_t p : places)
      if (may_multiply(factors[p], factors[v])) keep({p, v});
    for (const std::size_t r : turnings) keep({v, r});
    for (const std::size_t m : memories) {
      if (factors[v].numbers.empty()) keep({v, m});
      if (factors[v].text == "sgn(v_m_s)")
        for (const std::size_t p : places)
          if (may_multiply(factors[p], factors[v]) && factors[p].numbers.empty()) keep({p, v, m});
    }
  }
  for (const std::size_t p : places)
    if (factors[p].text == "base_N") {
      for (const std::size_t r : turnings) keep({p, r});
      for (const std::size_t m : memories) keep({p, m});
    }
  for (const std::size_t w : wholes) {
    keep({w});
    if (factors[w].alone || factors[w].numbers.size() > 1) continue;
    for (const std::size_t p : places)
      if (!factors[p].alone && factors[p].text == "exp(-x_m/decay_m)") keep({p, w});
    for (const std::size_t r : turnings) keep({w, r});
  }
  return out;
}

std::string formula_of(const Term& term) { return "amplitude * " + term.family; }

std::vector<FactorNumber> numbers_of(const Term& term, const std::vector<Factor>& factors) {
  std::vector<FactorNumber> out;
  for (const std::size_t k : term.factors)
    out.insert(out.end(), factors[k].numbers.begin(), factors[k].numbers.end());
  return out;
}

std::string words_of(const Term& term, const std::vector<Factor>& factors) {
  std::string out, rest;
  for (const std::size_t k : term.factors) {
    const std::string& words = factors[k].words;
    const bool adds = words.starts_with("that ") || words.starts_with("in ") ||
                      words.starts_with("about ") || words.starts_with("eased ") ||
                      words.starts_with("lost ");
    (adds ? rest : out) += (adds || !out.empty() ? " " : "") + words;
  }
  return out.empty() ? "a force of the bone" + rest : out + rest;
}

std::vector<effects::Quantity> quantities_of(const Factor& factor) {
  std::vector<effects::Quantity> out;
  for (const auto& state : effects::probing_expressions().states)
    out.push_back({std::string(state.name), dimension(state.unit)});
  for (const FactorNumber& number : factor.numbers)
    out.push_back({number.name, dimension(number.unit)});
  return out;
}

}  // namespace lab
}  // namespace tractus
