#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/try.hpp"
#include "volume/carve.hpp"

namespace tractus {
namespace volume {
namespace {

constexpr double kWallStep_m = 1e-4;
constexpr double kFelt = 0.03;       // opacity from which a run of bone goes on
constexpr double kLeastPeak = 0.06;  // a run that never reaches it is noise or marrow
constexpr double kFirmPeak =
    0.2;  // a run that never reaches it may be a trabecula: more must be free behind it
constexpr double kOutside_m = 0.002, kOutsideOfFaint_m = 0.005;  // so much without bone is outside
constexpr double kMouthGap_m = 0.005, kMouthReach_m = 0.040;
constexpr double kPedicle_m =
    0.012;  // from the axis to where a wall begins; lumbar pedicles are up to 18 mm high
constexpr double kWider = 1.15;      // than the isthmus is no longer pedicle
constexpr double kAlike_m = 0.0003;  // lengths that differ by less are taken for equal
constexpr double kAlong_m = 0.0005, kPastEntry_m = 0.005, kCoarsely_m = 0.002;
constexpr double kHexagon = 0.7;  // of the tract's radius

core::Error refused(std::string why) { return {core::Errc::out_of_range, std::move(why)}; }

Vec3 outwards(const Tract& tract, Wall wall) {
  switch (wall) {
    case Wall::medial:
      return tract.medial;
    case Wall::lateral:
      return -tract.medial;
    case Wall::superior:
      return tract.superior;
    case Wall::inferior:
      return -tract.superior;
    case Wall::anterior:
      return tract.axis;
  }
  return tract.axis;
}

}  // namespace

struct WallFinder::Bundle {
  Vec3 origin;
  Vec3 along;                // unit
  std::array<Vec3, 7> feet;  // of the rays, from origin, perpendicular to along
  Bundle(const Vec3& from, const Vec3& direction, double radius_m)
      : origin(from), along(direction) {
    const Vec3 u = along.unitOrthogonal(), v = along.cross(u);
    feet[0] = Vec3::Zero();
    for (std::size_t k = 1; k < feet.size(); ++k) {
      const double turn = std::numbers::pi / 3.0 * double(k);
      feet[k] = kHexagon * radius_m * (std::cos(turn) * u + std::sin(turn) * v);
    }
  }
};

std::optional<double> WallFinder::opacity_at(const Bundle& bundle, double distance_m) const {
  double sum = 0.0;
  for (const Vec3& foot : bundle.feet) {
    const Vec3 p = bundle.origin + foot + distance_m * bundle.along;
    if (!volume_.geometry.contains(p)) return std::nullopt;
    sum += transfer_.opacity(volume_.value_at(p));
  }
  return sum / double(bundle.feet.size());
}

core::Result<WallFound> WallFinder::first_run(const Bundle& bundle, WallFound found,
                                              double from_m) const {
  std::vector<double> run;  // opacity from the run's first step on
  double start = 0.0, peak = 0.0;
  std::size_t last = 0;  // of the run, still bone
  for (double d = from_m; d <= from_m + kReach_m; d += kWallStep_m) {
    const auto opacity = opacity_at(bundle, d);
    if (!opacity)
      return refused(fmt::format("{}: the volume ends before the wall is left", name(found.wall)));
    if (run.empty() && *opacity < kFelt) continue;
    if (run.empty()) start = d;
    run.push_back(*opacity);
    peak = std::max(peak, *opacity);
    if (*opacity >= kFelt) last = run.size() - 1;
    const double free_m = peak < kFirmPeak ? kOutsideOfFaint_m : kOutside_m;
    if (double(run.size() - 1 - last) * kWallStep_m < free_m) continue;
    if (peak < kLeastPeak) {
      run.clear(), peak = 0.0, last = 0;
      continue;
    }
    std::size_t first = 0;
    while (run[first] < peak / 2) ++first;
    while (run[last] < peak / 2) --last;
    found.inner_m = start + double(first) * kWallStep_m;
    found.outer_m = start + double(last) * kWallStep_m;
    return found;
  }
  const bool bone = !run.empty() && peak >= kLeastPeak;
  return refused(fmt::format("{}: {} within {:.0f} mm of the tract at depth {:.1f} mm",
                             name(found.wall), bone ? "the bone is never left" : "there is no bone",
                             kReach_m * 1e3, found.at_m * 1e3));
}

core::Result<WallFound> WallFinder::wall_at(const Tract& tract, Wall wall, double at_m) const {
  if (wall == Wall::anterior)
    return first_run(Bundle(tract.end_m(), tract.axis, tract.radius_m),
                     {.wall = wall, .at_m = tract.length_m}, 0.0);
  return first_run(Bundle(tract.entry_m + at_m * tract.axis, outwards(tract, wall), tract.radius_m),
                   {.wall = wall, .at_m = at_m}, tract.radius_m);
}

core::Result<WallFound> WallFinder::wall_towards(const Tract& tract, double angle_rad,
                                                 double at_m) const {
  const math::Vec2 towards(std::cos(angle_rad), std::sin(angle_rad));
  const Vec3 out = towards.x() * tract.medial + towards.y() * tract.superior;
  return first_run(Bundle(tract.entry_m + at_m * tract.axis, out, tract.radius_m),
                   {.wall = Tract::side_of(towards), .at_m = at_m}, tract.radius_m);
}

std::optional<WallFinder::Section> WallFinder::section_at(const Tract& tract, double at_m) const {
  Section section;
  for (std::size_t k = 0; k < section.size(); ++k) {
    const auto found = wall_at(tract, kWalls[k], at_m);
    if (!found || found->inner_m > kPedicle_m) return std::nullopt;
    section[k] = *found;
  }
  return section;
}

std::vector<WallFinder::Section> WallFinder::sections_of(const Tract& tract) const {
  std::vector<double> depths_m;
  for (double at = 0.0; at <= tract.length_m; at += kAlong_m) depths_m.push_back(at);
  std::vector<std::optional<Section>> found(depths_m.size());
  tbb::parallel_for(std::size_t(0), found.size(),
                    [&](std::size_t k) { found[k] = section_at(tract, depths_m[k]); });
  std::vector<Section> sections;
  std::optional<double> enclosed_m;
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k] && !enclosed_m) enclosed_m = depths_m[k];
    if (found[k] && depths_m[k] >= *enclosed_m + kPastEntry_m) sections.push_back(*found[k]);
  }
  return sections;
}

core::Result<WallFound> WallFinder::thinnest_of(std::vector<Section> sections, Wall wall) {
  const auto width = [](const Section& s) { return s[0].outer_m + s[1].outer_m; };
  const auto thickness = [&](const Section& s) { return s[std::size_t(wall)].thickness_m(); };
  if (sections.empty())
    return refused(
        fmt::format("{}: no part of the tract is enclosed by bone on all four sides within {:.0f} "
                    "mm; say the depth",
                    name(wall), kPedicle_m * 1e3));
  const double narrowest_m = width(*std::ranges::min_element(sections, {}, width));
  std::erase_if(sections, [&](const Section& s) { return width(s) > kWider * narrowest_m; });
  double isthmus_m = 0.0, narrow = 0.0;  // the middle of what is as narrow as the narrowest
  for (const Section& s : sections)
    if (width(s) <= narrowest_m + kAlike_m) isthmus_m += s[0].at_m, narrow += 1.0;
  isthmus_m /= narrow;
  const double thin_m = thickness(*std::ranges::min_element(sections, {}, thickness));
  std::erase_if(sections, [&](const Section& s) { return thickness(s) > thin_m + kAlike_m; });
  const auto away = [&](const Section& s) { return std::abs(s[0].at_m - isthmus_m); };
  return (*std::ranges::min_element(sections, {}, away))[std::size_t(wall)];
}

core::Result<WallFound> WallFinder::thinnest(const Tract& tract, Wall wall) const {
  if (wall == Wall::anterior) return wall_at(tract, wall, tract.length_m);
  return thinnest_of(sections_of(tract), wall);
}

std::vector<core::Result<WallFound>> WallFinder::thinnest(const Tract& tract) const {
  const auto sections = sections_of(tract);
  std::vector<core::Result<WallFound>> out;
  for (const Wall wall : kWalls)
    out.push_back(wall == Wall::anterior ? wall_at(tract, wall, tract.length_m)
                                         : thinnest_of(sections, wall));
  return out;
}

double WallFinder::behind_entry_m(const Tract& tract) const {
  const Bundle bundle(tract.entry_m, -tract.axis, tract.radius_m);
  double last = 0.0;
  for (double d = 0.0; d <= kMouthReach_m && d - last <= kMouthGap_m; d += kWallStep_m) {
    const auto opacity = opacity_at(bundle, d);
    if (!opacity) break;
    if (*opacity >= kFelt) last = d;
  }
  return last;
}

bool WallFinder::bone_about(const Tract& tract) const {
  for (double at = 0.0; at <= tract.length_m; at += kCoarsely_m) {
    if (transfer_.opacity(volume_.value_at(tract.entry_m + at * tract.axis)) > 0.0) return true;
    for (const Wall side : {Wall::medial, Wall::lateral, Wall::superior, Wall::inferior})
      if (const auto found = wall_at(tract, side, at); found && found->inner_m <= kPedicle_m)
        return true;
  }
  return false;
}

core::Result<Breach> place_breach(const Volume& volume, const TransferFunction& transfer,
                                  const Tract& tract, const BreachPlan& plan) {
  const auto bad = [&](const char* what, double value) {
    return core::Error{core::Errc::bad_input,
                       fmt::format("{} {:.3g} mm {}", what, value * 1e3,
                                   "must be a positive length of at most 25 mm")};
  };
  if (!(plan.depth_m > 0.0 && plan.depth_m <= WallFinder::kReach_m))
    return bad("the breach's depth of", plan.depth_m);
  if (plan.at_m && plan.wall == Wall::anterior)
    return core::Error{core::Errc::bad_input,
                       "an anterior breach lies at the tract's end: no other place can be given"};
  if (plan.at_m && !(*plan.at_m >= 0.0 && *plan.at_m <= tract.length_m))
    return core::Error{
        core::Errc::bad_input,
        fmt::format("the breach's place {:.3g} mm is not along the tract of {:.3g} mm",
                    *plan.at_m * 1e3, tract.length_m * 1e3)};
  const WallFinder finder(volume, transfer);
  const auto found = TRY(plan.at_m ? finder.wall_at(tract, plan.wall, *plan.at_m)
                                   : finder.thinnest(tract, plan.wall));
  const Vec3 out = outwards(tract, plan.wall), from = tract.entry_m + found.at_m * tract.axis;
  Breach breach{.wall = found, .depth_m = plan.depth_m, .from_m = from};
  breach.tip_m = from + (found.outer_m + plan.depth_m) * out;
  breach.centre_m = from + (found.inner_m + found.outer_m) / 2 * out;
  if (!volume.geometry.contains(breach.tip_m))
    return refused(fmt::format("{}: the breach leaves the volume", name(plan.wall)));
  return breach;
}

}  // namespace volume
}  // namespace tractus
