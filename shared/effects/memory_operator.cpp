#include "effects/memory_operator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tractus {
namespace effects {
namespace {

constexpr double kMostDecay = 50.0;      // e^50: what grows is cut there
constexpr double kMostStretch = 1000.0;  // of the yield: hysteresis that hardens is held there

/// z after the way w ≥ 0 of dz/dw = goal_rate − rate z, exact; the limit for rate 0.
double relaxed(double z, double source, double rate, double way) {
  const double decay = std::clamp(rate * way, -kMostDecay, kMostDecay);
  const double gained = std::abs(decay) < 1e-12 ? way : -std::expm1(-decay) / rate;
  return z * std::exp(-decay) + source * gained;
}

/// dz = du − (|du| z + g du |z|)/δ over a way without a turn, cut where z changes its sign.
double bouc_wen_after(double z, double du, double yield, double g) {
  const double heading = std::copysign(1.0, du);
  double way = std::abs(du);
  if (heading * z < 0.0) {  // unloading: the rate is (1 − g)/δ until z is 0
    const double rate = (1.0 - g) / yield;
    const double to_zero =
        std::abs(rate) < 1e-300 ? std::abs(z) : std::log1p(rate * std::abs(z)) / rate;
    if (!(to_zero < way)) return relaxed(z, heading, rate, way);
    way -= to_zero;
    z = 0.0;
  }
  return relaxed(z, heading, (1.0 + g) / yield, way);
}

/// y, dy/dt of a mass that x draws, over a step in which x is straight: the difference to x swings
/// freely. States: y, dy/dt, x before.
double drawn_mass(double x, double frequency_Hz, double ratio, double dt, MemoryStates s) {
  const double natural = 2.0 * std::numbers::pi * frequency_Hz;
  const double rate = dt > 0.0 ? (x - s[2]) / dt : 0.0;
  double apart = s[0] - s[2], apart_rate = s[1] - rate;
  if (dt > 0.0) {
    const double a = ratio * natural, square = natural * natural - a * a;
    const double fade = std::exp(-a * dt), w = std::sqrt(std::abs(square));
    const double c = square >= 0.0 ? std::cos(w * dt) : std::cosh(w * dt);
    const double sine =
        w * dt < 1e-9 ? dt : (square >= 0.0 ? std::sin(w * dt) : std::sinh(w * dt)) / w;
    const double from = apart, from_rate = apart_rate;
    apart = fade * (from * c + (from_rate + a * from) * sine);
    apart_rate = fade * (from_rate * c - (natural * natural * from + a * from_rate) * sine);
    s[0] = x + apart;
    s[1] = rate + apart_rate;
    s[2] = x;
  }
  return -natural * natural * apart - 2.0 * ratio * natural * apart_rate;
}

using enum MemoryArgument;
constexpr std::array<MemoryOperatorInfo, 9> kOperators{
    {{MemoryOperator::lag, "lag", "u, time_s", 2, {any, second}, MemoryUnit::as_first, true},
     {MemoryOperator::play, "play", "u, gap", 2, {any, as_first}, MemoryUnit::as_first, true},
     {MemoryOperator::dahl, "dahl", "u, yield", 2, {any, as_first}, MemoryUnit::as_first, true},
     {MemoryOperator::bouc_wen,
      "bouc_wen",
      "u, yield, g",
      3,
      {any, as_first, plain},
      MemoryUnit::as_first,
      true},
     {MemoryOperator::work, "work", "f, x", 2, {any, any}, MemoryUnit::product, true},
     {MemoryOperator::since_reversal,
      "since_reversal",
      "x",
      1,
      {length},
      MemoryUnit::as_first,
      true},
     {MemoryOperator::since_stop, "since_stop", "v", 1, {speed}, MemoryUnit::second, true},
     {MemoryOperator::age, "age", "x, way", 2, {any, as_first}, MemoryUnit::second, false},
     {MemoryOperator::resonator,
      "resonator",
      "x, frequency_Hz, damping_ratio",
      3,
      {any, hertz, plain},
      MemoryUnit::per_second_squared,
      true}}};

}  // namespace

std::span<const MemoryOperatorInfo> memory_operators() { return kOperators; }

const MemoryOperatorInfo* find_memory_operator(std::string_view name) {
  const auto* found = std::ranges::find(kOperators, name, &MemoryOperatorInfo::name);
  return found == kOperators.end() ? nullptr : found;
}

double begin(MemoryOperator which, const MemoryArguments& of, MemoryStates s) noexcept {
  std::ranges::fill(s, 0.0);
  switch (which) {
    case MemoryOperator::lag:
      s[0] = s[1] = of[0];
      return of[0];
    case MemoryOperator::play:
      s[0] = of[0];
      return of[0];
    case MemoryOperator::resonator:
      s[0] = s[2] = of[0];
      return 0.0;
    case MemoryOperator::work:
      s[2] = of[1];
      return 0.0;
    case MemoryOperator::dahl:
    case MemoryOperator::bouc_wen:
    case MemoryOperator::age:
    case MemoryOperator::since_reversal:
      s[1] = of[0];
      return 0.0;
    case MemoryOperator::since_stop:
      return 0.0;
  }
  return 0.0;
}

double advance(MemoryOperator which, const MemoryArguments& of, const MemoryStep& step,
               MemoryStates s) noexcept {
  const double u = of[0], dt = step.dt_s;
  switch (which) {
    case MemoryOperator::lag: {
      const double tau = of[1], rate = dt > 0.0 ? (u - s[1]) / dt : 0.0;
      if (!(tau > 0.0)) {
        s[0] = s[1] = u;
        return u;
      }
      const double gone = -std::expm1(-dt / tau);
      s[0] = u - rate * tau * gone + (s[0] - s[1]) * (1.0 - gone);
      s[1] = u;
      return s[0];
    }
    case MemoryOperator::play: {
      const double half = 0.5 * std::max(of[1], 0.0);
      return s[0] = std::clamp(s[0], u - half, u + half);
    }
    case MemoryOperator::dahl: {
      const double du = u - s[1], goal = std::copysign(of[1], du);
      s[0] = of[1] > 0.0 ? goal + (s[0] - goal) * std::exp(-std::abs(du) / of[1]) : 0.0;
      s[1] = u;
      return s[0];
    }
    case MemoryOperator::bouc_wen: {
      const double most = kMostStretch * std::max(of[1], 0.0);
      s[0] =
          of[1] > 0.0 ? std::clamp(bouc_wen_after(s[0], u - s[1], of[1], of[2]), -most, most) : 0.0;
      s[1] = u;
      return s[0];
    }
    case MemoryOperator::work: {  // states: work, force and place before, is the force known?
      if (s[3] == 0.0) s[1] = u, s[3] = 1.0;  // a start may know the place alone
      s[0] += std::max(0.0, 0.5 * (s[1] + u) * (of[1] - s[2]));
      s[1] = u, s[2] = of[1];
      return s[0];
    }
    case MemoryOperator::since_reversal: {  // states: way, x before, heading
      const double du = u - s[1];
      s[1] = u;
      if (std::abs(du) <= step.rest_m_s * dt) return s[0];
      const double heading = std::copysign(1.0, du);
      s[0] = heading == s[2] ? s[0] + std::abs(du) : std::abs(du);
      s[2] = heading;
      return s[0];
    }
    case MemoryOperator::since_stop:
      return s[0] = std::abs(u) <= step.rest_m_s ? 0.0 : s[0] + dt;
    case MemoryOperator::age: {
      const double way = std::abs(u - s[1]);
      s[1] = u;
      const double decay = of[1] > 0.0 ? std::min(way / of[1], kMostDecay) : 0.0;
      const double gained = decay < 1e-9 ? dt : dt * -std::expm1(-decay) / decay;
      return s[0] = s[0] * std::exp(-decay) + gained;
    }
    case MemoryOperator::resonator:
      return drawn_mass(u, of[1], of[2], dt, s);
  }
  return 0.0;
}

}  // namespace effects
}  // namespace tractus
