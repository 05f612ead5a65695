#include "scenarios/scenario.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace scenarios {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr double kNearly_m = 1e-9;
constexpr double kThinnestLayer_m = 1e-4;
constexpr std::size_t kMaxWalls = 16, kMaxStretches = 256;

Error refused(std::string_view field, const std::string& why) {
  return {Errc::out_of_range, fmt::format("/{}: {}", field, why)};
}

/// low <= value <= high; not a number is outside.
struct Within {
  std::string field;
  double value, low, high;
};

Result<void> check(std::initializer_list<Within> all) {
  for (const Within& one : all)
    if (!(one.value >= one.low && one.value <= one.high))
      return refused(one.field, fmt::format("{} is outside {} … {}", one.value, one.low, one.high));
  return {};
}

Result<void> check_walls(const Scenario& s) {
  const bool breached = s.kind == Kind::lateral_breach || s.kind == Kind::in_out_in;
  if (!breached && !s.walls_m.empty())
    return refused("walls_m", fmt::format("'{}' has no wall to breach", name(s.kind)));
  if (breached && s.walls_m.empty())
    return refused("walls_m", fmt::format("'{}' needs a wall to breach", name(s.kind)));
  if (s.walls_m.size() > kMaxWalls || (s.kind == Kind::lateral_breach && s.walls_m.size() > 1))
    return refused("walls_m", fmt::format("{} walls are too many", s.walls_m.size()));
  double bone_from_m = 0.0;
  for (std::size_t k = 0; k < s.walls_m.size(); ++k) {
    const double wall_m = s.walls_m[k], behind_m = wall_m + s.breach.breach_interval_m;
    const std::string field = fmt::format("walls_m/{}", k);
    if (!(wall_m - s.breach.resistance_interval_m >= bone_from_m - kNearly_m &&
          wall_m > bone_from_m))
      return refused(field, fmt::format("{} less the resistance interval lies before the bone that "
                                        "begins at {} m",
                                        wall_m, bone_from_m));
    if (!(behind_m <= s.travel_m + kNearly_m))
      return refused(
          field, fmt::format("{} plus the breach interval lies beyond the travel of {} m", wall_m,
                             s.travel_m));
    bone_from_m = behind_m;
  }
  const double left_m = s.travel_m - bone_from_m;
  if (s.kind == Kind::lateral_breach && left_m > kNearly_m)
    return refused("travel_m",
                   fmt::format("{} lies behind the breach, which ends at {} m: there is "
                               "no bone there ('in_out_in' returns into it)",
                               s.travel_m, bone_from_m));
  if (s.kind == Kind::in_out_in && left_m < s.bone.interval_m - kNearly_m)
    return refused("travel_m", fmt::format("{} leaves less than a layer of bone behind the breach, "
                                           "which ends at {} m",
                                           s.travel_m, bone_from_m));
  return {};
}

Result<void> check_stretches(const Scenario& s) {
  if (s.layers.size() > kMaxStretches) return refused("layers", "are too many");
  double end_m = 0.0;
  for (std::size_t k = 0; k < s.layers.size(); ++k) {
    const DensityRegion& stretch = s.layers[k];
    const std::string at = fmt::format("layers/{}/", k);
    TRY(check({{at + "start_m", stretch.start_m, 0.0, s.travel_m},
               {at + "thickness_m", stretch.thickness_m, kThinnestLayer_m, s.travel_m},
               {at + "density", stretch.density, 0.05, 20.0}}));
    if (stretch.start_m < end_m - kNearly_m)
      return refused(at + "start_m", fmt::format("{} lies inside the layer before it, which ends "
                                                 "at {} m",
                                                 stretch.start_m, end_m));
    end_m = stretch.start_m + stretch.thickness_m;
    if (end_m > s.travel_m + kNearly_m)
      return refused(at + "thickness_m",
                     fmt::format("{} reaches beyond the travel", stretch.thickness_m));
  }
  return {};
}

double density_at(const Scenario& s, double x_m) {
  for (const DensityRegion& stretch : s.layers)
    if (x_m >= stretch.start_m && x_m < stretch.start_m + stretch.thickness_m)
      return s.density * stretch.density;
  return s.density;
}

/// Layers of length L from `from_m` to `to_m`; the last one may be shorter.
void add_lattice(const Scenario& s, double from_m, double to_m, std::vector<laws::Layer>& out) {
  const double length_m = s.bone.interval_m;
  const int count = int(std::ceil((to_m - from_m - kNearly_m) / length_m));
  for (int k = 0; k < count; ++k) {
    const double start_m = from_m + k * length_m;
    const double thickness_m = std::min(length_m, to_m - start_m);
    const double density = density_at(s, start_m + 0.5 * thickness_m);
    out.push_back({start_m, thickness_m, density * s.bone.stiffness_N_per_m,
                   density * s.bone.damping_Ns_per_m, start_m + s.bone.equilibrium_m});
  }
}

}  // namespace

Result<void> Scenario::check() const {
  TRY(scenarios::check(
      {{"travel_m", travel_m, 0.005, 0.1},
       {"density", density, 0.05, 20.0},
       {"bone/stiffness_N_per_m", bone.stiffness_N_per_m, 0.0, 2e5},
       {"bone/damping_Ns_per_m", bone.damping_Ns_per_m, 1.0, 1e6},
       {"bone/interval_m", bone.interval_m, kThinnestLayer_m, travel_m},
       {"bone/equilibrium_m", bone.equilibrium_m, -travel_m, 0.0},
       {"breach/resistance_interval_m", breach.resistance_interval_m, 0.0, travel_m},
       {"breach/resistance_factor_per_m", breach.resistance_factor_per_m, 0.0, 1e5},
       {"breach/breach_interval_m", breach.breach_interval_m, kThinnestLayer_m, travel_m},
       {"breach/breach_damping_Ns_per_m", breach.breach_damping_Ns_per_m, 1.0, 1e6},
       {"rotary/viscous_Nms_per_rad", rotary.viscous_Nms_per_rad, 0.0, 10.0},
       {"rotary/detent_Nm", rotary.detent_Nm, 0.0, 10.0},
       {"rotary/detent_pitch_rad", rotary.detent_pitch_rad, 1e-3, 7.0}}));
  TRY(check_stretches(*this));
  return check_walls(*this);
}

Result<laws::ProbingParameters> Scenario::expanded() const {
  TRY(check());
  laws::ProbingParameters out;
  out.travel_m = travel_m;
  out.rotary = rotary;
  double from_m = 0.0;
  for (const double wall_m : walls_m) {
    add_lattice(*this, from_m, wall_m, out.layers);
    out.walls.push_back({wall_m, breach.resistance_interval_m, breach.resistance_factor_per_m,
                         breach.breach_interval_m, breach.breach_damping_Ns_per_m});
    from_m = wall_m + breach.breach_interval_m;
  }
  add_lattice(*this, from_m, travel_m, out.layers);
  // What density makes of K and D is the law's to judge.
  if (auto law = laws::ProbingLaw::make(out); !law)
    return Error{law.error().code, "/density: expands to /" + law.error().what};
  return out;
}

Result<models::ProbingModel> Scenario::model() const {
  auto parameters = TRY(expanded());
  return models::ProbingModel{name, std::move(parameters.layers), rotary, {}, {}};
}

}  // namespace scenarios
}  // namespace tractus
