#include "models/probing_step.hpp"

#include <algorithm>
#include <cmath>

namespace tractus {
namespace models {
namespace {

using effects::ProbingMemory;
using effects::ProbingTick;

constexpr double kNearlyZero_m = 1e-12;
constexpr double kJustMoving_m_s = 1e-12;  // either side of the jump of dry friction
constexpr double kCreep_m_s = 1e-9;        // a slower motion is rest
constexpr double kNothing = 1e-9;          // of a tick
constexpr double kExact_N = 1e-10;
constexpr int kPieces = 8, kIterations = 60;

/// A root of `excess` between a, where it is <= 0, and b, where it is >= 0: false position, cut in
/// half whenever that gains too little, so that a jump is found as surely as a root.
template <class Excess>
double crossing(const Excess& excess, double a, double at_a, double b, double at_b) {
  for (int i = 0; i < kIterations; ++i) {
    const double width = b - a;
    if (std::abs(width) <= kJustMoving_m_s) break;
    double v = i % 3 == 2 || !(at_b > at_a) ? 0.5 * (a + b) : a - at_a * width / (at_b - at_a);
    if (!(std::min(a, b) < v && v < std::max(a, b))) v = 0.5 * (a + b);
    const double at_v = excess(v);
    if (std::abs(at_v) <= kExact_N) return v;
    (at_v < 0.0 ? a : b) = v;
    (at_v < 0.0 ? at_a : at_b) = at_v;
  }
  return std::abs(at_a) < std::abs(at_b) ? a : b;
}

/// The speed of one sense of motion (that of `sign`) at which resistance and push are even, nearest
/// to `near` >= 0; negative if there is none. `excess(speed)` is the resistance less the push, both
/// counted along the motion.
template <class Excess>
double moving_speed(const Excess& excess, double near, double top) {
  double low = std::clamp(near, kJustMoving_m_s, top), at_low = excess(low);
  double high = low, at_high = at_low;
  if (at_low <= 0.0) {
    at_high = excess(top);
    if (at_high <= 0.0) return top;
    return crossing(excess, low, at_low, top, at_high);
  }
  while (at_low > 0.0) {
    if (low <= kCreep_m_s) return -1.0;
    high = low, at_high = at_low;
    low = std::max(0.25 * low, kJustMoving_m_s);
    at_low = excess(low);
  }
  return crossing(excess, low, at_low, high, at_high);
}

}  // namespace

ProbingStep::ProbingStep(const laws::ProbingLaw& law, const ProbingStages& stages,
                         double turning_rad_s, double dt_s, ProbingLive& live) noexcept
    : law_(law),
      stages_(stages),
      turning_rad_s_(turning_rad_s),
      dt_s_(dt_s),
      torque_Nm_(law.torque_Nm(live.at.x_m, live.theta_rad, turning_rad_s)),
      live_(live) {
  if (live_.started) return;
  live_.started = true;
  for (ProbingMemory& memory : live_.effects) memory = {.depth_m = live_.at.x_m};
}

ProbingTick ProbingStep::candidate(double v_m_s, double over_s) const noexcept {
  return {.t_s = live_.t_s + over_s,
          .dt_s = over_s,
          .x_m = live_.at.x_m + v_m_s * over_s,
          .v_m_s = v_m_s,
          .a_m_s2 = (v_m_s - live_.v_m_s) / over_s,
          .theta_rad = live_.theta_rad + turning_rad_s_ * over_s,
          .omega_rad_s = turning_rad_s_,
          .tz_Nm = torque_Nm_};
}

/// As the bone sees it.
ProbingTick ProbingStep::seen(ProbingTick tick) const noexcept {
  for (std::size_t e = 0; e < stages_.depths.size(); ++e) {
    ProbingMemory memory = live_.effects[e];
    stages_.depths[e]->see(tick, memory);
  }
  return tick;
}

double ProbingStep::resistance_N(double v_m_s, const Piece& piece) const noexcept {
  const ProbingTick tick = candidate(v_m_s, piece.left_s);
  const ProbingTick bone = seen(tick);
  double base_N = law_.force_N(std::min(std::max(bone.x_m, piece.low_m), piece.high_m), bone.v_m_s);
  for (const auto& factor : stages_.scales) base_N *= factor->scale(tick);
  double added_N = 0.0;
  for (std::size_t e = 0; e < stages_.forces.size(); ++e) {
    ProbingMemory memory = live_.effects[stages_.depths.size() + e];
    added_N += stages_.forces[e]->force_N(tick, base_N, memory);
  }
  return base_N + added_N;
}

double ProbingStep::speed_m_s(double force_N, const Piece& piece) const noexcept {
  const double top = law_.parameters().max_speed_m_s, now = live_.v_m_s;
  const auto in = [&](double speed) { return resistance_N(speed, piece) - force_N; };
  const auto out = [&](double speed) { return force_N - resistance_N(-speed, piece); };
  // A motion under way goes on if it can.
  if (now > kCreep_m_s)
    if (const double v = moving_speed(in, now, top); v >= 0.0) return v;
  if (now < -kCreep_m_s)
    if (const double v = moving_speed(out, -now, top); v >= 0.0) return -v;
  if (in(kJustMoving_m_s) < 0.0) return moving_speed(in, 0.0, top);
  if (out(kJustMoving_m_s) < 0.0) return -moving_speed(out, 0.0, top);
  return 0.0;
}

void ProbingStep::commit(const ProbingTick& tick) noexcept {
  ProbingTick bone = tick;
  auto memory = live_.effects.begin();
  for (const auto& depth : stages_.depths) depth->see(bone, *memory++);
  double base_N = law_.force_N(bone.x_m, bone.v_m_s);
  for (const auto& factor : stages_.scales) base_N *= factor->scale(tick);
  for (const auto& force : stages_.forces) force->force_N(tick, base_N, *memory++);
  live_.at.x_m = tick.x_m;
  live_.v_m_s = tick.v_m_s;
  live_.t_s = tick.t_s;
  live_.theta_rad = tick.theta_rad;
}

/// As far as the speed leads before the bone's depth leaves the piece's stretch or the probe its
/// travel; returns the time used, s.
double ProbingStep::move(double v_m_s, const Piece& piece) noexcept {
  const double from_m = live_.at.x_m;
  ProbingTick tick = candidate(v_m_s, piece.left_s);
  const double bone_m = seen(tick).x_m;
  // Past a border, the depths seen and real move together: what is too far is too far for both.
  const double over_m = v_m_s > 0.0   ? std::max(bone_m - piece.high_m - kNearlyZero_m,
                                                 tick.x_m - law_.parameters().travel_m)
                        : v_m_s < 0.0 ? std::max(piece.low_m - bone_m - kNearlyZero_m, -tick.x_m)
                                      : 0.0;
  if (over_m > 0.0) {
    const double way_m = std::max(0.0, std::abs(tick.x_m - from_m) - over_m);
    const double used_s = std::max(way_m / std::abs(v_m_s), kNothing * dt_s_);
    tick = candidate(v_m_s, std::min(used_s, piece.left_s));
    tick.x_m = from_m + std::copysign(way_m, v_m_s);
  }
  commit(tick);
  return tick.dt_s;
}

double ProbingStep::take(double force_N) noexcept {
  const double start_m = live_.at.x_m, travel_m = law_.parameters().travel_m;
  const bool holds = std::abs(turning_rad_s_) <= law_.parameters().min_turning_rad_s;
  double left_s = dt_s_;
  for (int i = 0; i < kPieces && left_s > kNothing * dt_s_ && !holds; ++i) {
    const double bone_m = seen(candidate(0.0, left_s)).x_m;
    const Piece piece{left_s, law_.next_border_m(bone_m, false) + kNearlyZero_m,
                      law_.next_border_m(bone_m, true) - kNearlyZero_m};
    const double v = speed_m_s(force_N, piece);
    if ((v > 0.0 && live_.at.x_m >= travel_m) || (v < 0.0 && live_.at.x_m <= 0.0)) break;
    left_s -= move(v, piece);
    if (v == 0.0) break;
  }
  if (left_s > 0.0) commit(candidate(0.0, left_s));  // held, at an end, or at rest
  live_.at.mode = holds ? laws::ProbingMode::holding : law_.mode_at(seen(candidate(0.0, 1.0)).x_m);
  live_.v_m_s = (live_.at.x_m - start_m) / dt_s_;
  return live_.v_m_s;
}

}  // namespace models
}  // namespace tractus
