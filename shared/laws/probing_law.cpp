#include "laws/probing_law.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/try.hpp"

namespace tractus {
namespace laws {
namespace {

constexpr double kNearlyZero_m = 1e-12;

core::Error refused(std::string what) { return {core::Errc::out_of_range, std::move(what)}; }

bool within(double value, double low, double high) { return value >= low && value <= high; }

core::Result<void> check(const std::vector<Layer>& layers, double travel_m) {
  double end_m = 0.0;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const Layer& layer = layers[k];
    const auto no = [&](const char* field, double value, const char* why) {
      return refused(fmt::format("layers/{}/{}: {} {}", k, field, value, why));
    };
    if (!(layer.thickness_m > 0.0 && layer.thickness_m <= travel_m))
      return no("thickness_m", layer.thickness_m, "must be above 0 and within the travel");
    if (!(layer.start_m >= end_m - 1e-9))
      return no("start_m", layer.start_m, "lies inside the layer before it");
    if (!within(layer.stiffness_N_per_m, 0.0, 2e5))
      return no("stiffness_N_per_m", layer.stiffness_N_per_m, "is outside 0 … 2e5");
    if (!(layer.damping_Ns_per_m > 0.0 && layer.damping_Ns_per_m <= 1e6))
      return no("damping_Ns_per_m", layer.damping_Ns_per_m, "must be above 0 and at most 1e6");
    if (!within(layer.equilibrium_m, -travel_m, travel_m))
      return no("equilibrium_m", layer.equilibrium_m, "is outside the travel");
    end_m = layer.start_m + layer.thickness_m;
  }
  return {};
}

core::Result<void> check(const std::vector<CorticalWall>& walls, double travel_m) {
  double end_m = 0.0;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const CorticalWall& wall = walls[k];
    const auto no = [&](const char* field, double value, const char* why) {
      return refused(fmt::format("walls/{}/{}: {} {}", k, field, value, why));
    };
    if (!within(wall.resistance_interval_m, 0.0, travel_m))
      return no("resistance_interval_m", wall.resistance_interval_m, "is outside 0 … travel");
    if (!within(wall.resistance_factor_per_m, 0.0, 1e5))
      return no("resistance_factor_per_m", wall.resistance_factor_per_m, "is outside 0 … 1e5");
    if (!(wall.breach_interval_m > 0.0))
      return no("breach_interval_m", wall.breach_interval_m, "must be above 0");
    if (!(wall.breach_damping_Ns_per_m > 0.0 && wall.breach_damping_Ns_per_m <= 1e6))
      return no("breach_damping_Ns_per_m", wall.breach_damping_Ns_per_m,
                "must be above 0 and at most 1e6");
    if (!(wall.position_m - wall.resistance_interval_m >= end_m - 1e-9))
      return no("position_m", wall.position_m,
                "less its resistance interval lies before the bone's entry or inside the breach "
                "before it");
    end_m = wall.position_m + wall.breach_interval_m;
    if (!(end_m <= travel_m + 1e-9))
      return no("position_m", wall.position_m, "plus its breach interval lies beyond the travel");
  }
  return {};
}

}  // namespace

core::Result<ProbingLaw> ProbingLaw::make(ProbingParameters p) {
  if (!(p.travel_m > 0.0 && p.travel_m <= 1.0))
    return refused(fmt::format("travel_m: {} must be above 0 and at most 1", p.travel_m));
  if (!(p.max_speed_m_s > 0.0))
    return refused(fmt::format("max_speed_m_s: {} must be above 0", p.max_speed_m_s));
  if (!(p.min_turning_rad_s >= 0.0))
    return refused(fmt::format("min_turning_rad_s: {} must be 0 or more", p.min_turning_rad_s));
  if (!within(p.rotary.viscous_Nms_per_rad, 0.0, 10.0) || !within(p.rotary.detent_Nm, 0.0, 10.0) ||
      !within(p.rotary.detent_pitch_rad, 1e-3, 7.0))
    return refused(
        "rotary: viscous_Nms_per_rad 0 … 10, detent_Nm 0 … 10 and detent_pitch_rad 0.001 … 7 are "
        "expected");
  TRY(check(p.layers, p.travel_m));
  TRY(check(p.walls, p.travel_m));
  ProbingLaw law(std::move(p));
  law.lay_out();
  return law;
}

void ProbingLaw::lay_out() {
  borders_m_.reserve(2 * parameters_.layers.size() + 3 * parameters_.walls.size() + 1);
  for (const Layer& layer : parameters_.layers)
    borders_m_.insert(borders_m_.end(), {layer.start_m, layer.start_m + layer.thickness_m});
  for (const CorticalWall& wall : parameters_.walls)
    borders_m_.insert(borders_m_.end(),
                      {wall.position_m - wall.resistance_interval_m, wall.position_m,
                       wall.position_m + wall.breach_interval_m});
  borders_m_.push_back(parameters_.travel_m);
  std::ranges::sort(borders_m_);
  const auto same = std::ranges::unique(borders_m_);
  borders_m_.erase(same.begin(), same.end());
  stretches_.reserve(borders_m_.size() + 1);
  stretches_.push_back({.start_m = -std::numeric_limits<double>::infinity()});
  for (const double border_m : borders_m_) stretches_.push_back(stretch_from(border_m));
}

ProbingLaw::Stretch ProbingLaw::stretch_from(double start_m) const {
  Stretch out{.start_m = start_m};
  for (const CorticalWall& wall : parameters_.walls) {
    const double grows_from_m = wall.position_m - wall.resistance_interval_m;
    if (start_m >= wall.position_m && start_m < wall.position_m + wall.breach_interval_m) {
      out.at_start = {0.0, wall.breach_damping_Ns_per_m, 0.0};  // eq. (3)
      out.mode = ProbingMode::breach;
      return out;
    }
    if (start_m >= grows_from_m && start_m < wall.position_m) {
      out.mode = ProbingMode::resistance;
      out.grows_from_m = grows_from_m;
      out.growth_per_m = wall.resistance_factor_per_m;
    }
  }
  for (const Layer& layer : parameters_.layers)
    if (start_m >= layer.start_m && start_m < layer.start_m + layer.thickness_m) {
      out.at_start = {layer.stiffness_N_per_m, layer.damping_Ns_per_m, layer.equilibrium_m};
      break;
    }
  return out;
}

const ProbingLaw::Stretch& ProbingLaw::stretch_at(double x_m) const noexcept {
  const auto after = std::upper_bound(borders_m_.begin(), borders_m_.end(), x_m);
  return stretches_[std::size_t(after - borders_m_.begin())];
}

ProbingMode ProbingLaw::mode_at(double x_m) const noexcept {
  return x_m >= parameters_.travel_m ? ProbingMode::stopped : stretch_at(x_m).mode;
}

ProbingLaw::Local ProbingLaw::local(double x_m) const noexcept {
  const Stretch& s = stretch_at(x_m);
  const double grown = 1.0 + s.growth_per_m * (x_m - s.grows_from_m);
  return {grown * s.at_start.stiffness_N_per_m, grown * s.at_start.damping_Ns_per_m,
          s.at_start.equilibrium_m};
}

double ProbingLaw::force_N(double x_m, double speed_m_s) const noexcept {
  const Local l = local(x_m);
  return l.damping_Ns_per_m * speed_m_s + l.stiffness_N_per_m * (x_m - l.equilibrium_m);
}

double ProbingLaw::force_N(double x_m, double speed_m_s, std::size_t& stretch) const noexcept {
  stretch = std::min(stretch, borders_m_.size());
  while (stretch < borders_m_.size() && x_m >= borders_m_[stretch]) ++stretch;
  while (stretch > 0 && x_m < borders_m_[stretch - 1]) --stretch;
  const Stretch& s = stretches_[stretch];
  const double grown = 1.0 + s.growth_per_m * (x_m - s.grows_from_m);
  return grown * (s.at_start.damping_Ns_per_m * speed_m_s +
                  s.at_start.stiffness_N_per_m * (x_m - s.at_start.equilibrium_m));
}

RotaryGains ProbingLaw::rotary_gains(double x_m, double theta_rad) const noexcept {
  const RotaryStage& r = parameters_.rotary;
  RotaryGains out;
  out.from_detent_rad = std::remainder(theta_rad, r.detent_pitch_rad);
  if (mode_at(x_m) == ProbingMode::breach) return out;  // the rotary motor is off
  const double stiffest = 2.0 * std::numbers::pi * r.detent_Nm / r.detent_pitch_rad;
  const double u = 2.0 * std::numbers::pi * out.from_detent_rad / r.detent_pitch_rad;
  out.proportional_Nm_per_rad = std::abs(u) < 1e-6 ? stiffest : stiffest * std::sin(u) / u;
  out.derivative_Nms_per_rad = r.viscous_Nms_per_rad;
  return out;
}

double ProbingLaw::torque_Nm(double x_m, double theta_rad, double turning_rad_s) const noexcept {
  const RotaryGains g = rotary_gains(x_m, theta_rad);
  return g.proportional_Nm_per_rad * g.from_detent_rad + g.derivative_Nms_per_rad * turning_rad_s;
}

double ProbingLaw::turning_rad_s(double x_m, double theta_rad, double torque_Nm) const noexcept {
  const RotaryGains g = rotary_gains(x_m, theta_rad);
  const double left_Nm = torque_Nm - g.proportional_Nm_per_rad * g.from_detent_rad;
  const double most_Nm = kFreeTurning_rad_s * g.derivative_Nms_per_rad;
  if (std::abs(left_Nm) > most_Nm) return std::copysign(kFreeTurning_rad_s, left_Nm);
  return left_Nm == 0.0 ? 0.0 : left_Nm / g.derivative_Nms_per_rad;
}

double ProbingLaw::speed_m_s(double force_N, double x_m) const noexcept {
  const Local l = local(x_m);
  const double top = parameters_.max_speed_m_s;
  const double push = force_N - l.stiffness_N_per_m * (x_m - l.equilibrium_m);
  if (l.damping_Ns_per_m <= 0.0) return push > 0.0 ? top : push < 0.0 ? -top : 0.0;
  return std::clamp(push / l.damping_Ns_per_m, -top, top);
}

double ProbingLaw::next_border_m(double x_m, bool inward) const noexcept {
  if (inward) {
    const auto after = std::upper_bound(borders_m_.begin(), borders_m_.end(), x_m + kNearlyZero_m);
    return after == borders_m_.end() ? parameters_.travel_m : *after;
  }
  const auto at = std::lower_bound(borders_m_.begin(), borders_m_.end(), x_m - kNearlyZero_m);
  return at == borders_m_.begin() ? 0.0 : *(at - 1);
}

double ProbingLaw::advance(double force_N, double turning_rad_s, double dt_s,
                           ProbingState& state) const noexcept {
  if (std::abs(turning_rad_s) <= parameters_.min_turning_rad_s) {
    state.mode = ProbingMode::holding;
    return 0.0;
  }
  const double start_m = state.x_m;
  double left_s = dt_s;
  for (int piece = 0; piece < 8 && left_s > 0.0; ++piece) {
    const double here = speed_m_s(force_N, state.x_m);
    const bool inward = here > 0.0;
    if (here == 0.0 || (inward && state.x_m >= parameters_.travel_m) ||
        (!inward && state.x_m <= 0.0))
      break;
    // Just inside the stretch that is entered, so that a border belongs to the side the probe moves
    // to.
    const double from_m = state.x_m + (inward ? kNearlyZero_m : -kNearlyZero_m);
    const double border_m = next_border_m(state.x_m, inward);
    const double first = speed_m_s(force_N, from_m);
    const double middle_m = inward
                                ? std::min(from_m + 0.5 * left_s * first, border_m - kNearlyZero_m)
                                : std::max(from_m + 0.5 * left_s * first, border_m + kNearlyZero_m);
    const double v = speed_m_s(force_N, middle_m);
    if (v == 0.0 || (v > 0.0) != inward) break;
    const double needed_s = (border_m - state.x_m) / v;
    if (needed_s >= left_s) {
      state.x_m += v * left_s;
      left_s = 0.0;
    } else {
      state.x_m = border_m;
      left_s -= needed_s;
    }
  }
  state.mode = mode_at(state.x_m);
  return (state.x_m - start_m) / dt_s;
}

}  // namespace laws
}  // namespace tractus
