#include "cases/carving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "volume/resample.hpp"

namespace tractus {
namespace cases {
namespace {

using core::Errc;
using core::Error;
using math::Vec3;

constexpr double kLongest_m = 0.2, kWidest_m = 0.01, kThinnest_m = 0.0002;
constexpr double kSurroundings_m = 0.040, kSurroundingsSpacing_m = 0.0005;
constexpr double kFarthestMove_m = 0.003;
constexpr double kFarthestMidline_m = 0.1;   // a pedicle is some 10 to 30 mm from it
constexpr double kFarBehindFront_m = 0.004;  // a tract that ends farther back has no anterior wall
constexpr double kOpenAir_m = 0.002;         // the channel goes on for so much behind the bone

std::string mm(const Vec3& p_m) {
  return fmt::format("({:.1f}, {:.1f}, {:.1f}) mm", p_m.x() * 1e3, p_m.y() * 1e3, p_m.z() * 1e3);
}

Error outside(const char* what, const Vec3& p, const volume::Geometry& geometry) {
  Vec3 low = Vec3::Constant(1e30), high = Vec3::Constant(-1e30);
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a)
      index[a] = (corner >> a) & 1 ? geometry.dims[std::size_t(a)] - 1 : 0;
    low = low.cwiseMin(geometry.position_of(index));
    high = high.cwiseMax(geometry.position_of(index));
  }
  return {Errc::out_of_range,
          fmt::format("{} {} lies outside the volume, which spans {} to {} in LPS", what, mm(p),
                      mm(low), mm(high))};
}

/// A number within limits, told in millimetres.
core::Result<void> within(const char* what, double value_m, double low_m, double high_m) {
  if (value_m >= low_m && value_m <= high_m) return {};
  return Error{Errc::out_of_range, fmt::format("{} of {:.4g} mm is outside {:g} … {:g} mm", what,
                                               value_m * 1e3, low_m * 1e3, high_m * 1e3)};
}

core::Result<void> check_marks(const std::vector<volume::EnvelopeMark>& marks) {
  using volume::EnvelopeMark;
  if (marks.size() > EnvelopeMark::kMostMarks)
    return Error{Errc::out_of_range, fmt::format("{} marks of the envelope: at most {} are allowed",
                                                 marks.size(), EnvelopeMark::kMostMarks)};
  for (const EnvelopeMark& mark : marks) {
    if (!mark.at_m.allFinite())
      return Error{Errc::bad_input, "marks of the envelope must be finite numbers"};
    TRY(within("a mark's radius", mark.radius_m, EnvelopeMark::kLeast_m, EnvelopeMark::kMost_m));
  }
  return {};
}

core::Result<void> check(const CarvingPlan& plan, double length_m,
                         const volume::Geometry& geometry) {
  if (!plan.entry_m.allFinite() || !plan.target_m.allFinite())
    return Error{Errc::bad_input, "entry and target must be finite numbers"};
  if (plan.breach && !plan.drilled)
    return Error{Errc::bad_input, "a bone that is not drilled has no breach"};
  TRY(within("a length", length_m, 1e-4, kLongest_m));
  TRY(within("a radius", plan.radius_m, kThinnest_m, kWidest_m));
  TRY(within("a margin", plan.margin_m, 1e-3, 0.1));
  TRY(within("a way to move", plan.may_move_m, 0.0, kFarthestMove_m));
  TRY(within("a spacing", plan.spacing_m, 5e-5, 5e-3));
  TRY(check_marks(plan.envelope_marks));
  if (!geometry.contains(plan.entry_m)) return outside("the entry", plan.entry_m, geometry);
  return {};
}

double length_of(const CarvingPlan& plan) {
  return plan.length_m.value_or((plan.target_m - plan.entry_m).norm());
}

core::Result<volume::Midline> midline_of(const volume::Volume& ct,
                                         const volume::TransferFunction& transfer,
                                         const CarvingPlan& plan) {
  if (plan.midline_x_m) {
    const double aside_m = std::abs(plan.entry_m.x() - *plan.midline_x_m);
    TRY(within("a distance from entry to midline", aside_m, 0.0, kFarthestMidline_m));
    return volume::stated_midline(*plan.midline_x_m, plan.entry_m);
  }
  return volume::midline_about(ct, transfer, plan.entry_m, plan.target_m);
}

core::Result<volume::Tract> tract_of(const volume::Volume& ct,
                                     const volume::TransferFunction& transfer,
                                     const CarvingPlan& plan, double length_m,
                                     const volume::Midline& midline) {
  auto tract = volume::tract_between(plan.entry_m, plan.target_m, length_m, plan.radius_m, midline);
  if (!tract) return tract;
  if (!ct.geometry.contains(tract->end_m()))
    return outside("the tract's end", tract->end_m(), ct.geometry);
  if (!volume::WallFinder(ct, transfer).bone_about(*tract))
    return Error{Errc::out_of_range,
                 fmt::format("the tract from {} to {} meets no bone: are these LPS coordinates?",
                             mm(tract->entry_m), mm(tract->end_m()))};
  return tract;
}

/// Does half of the tract's width lie in the envelope at that depth?
bool lies_in(const volume::Envelope& envelope, const volume::Tract& tract, double depth_m) {
  const Vec3 at = tract.entry_m + depth_m * tract.axis;
  return std::ranges::all_of(
      std::array{tract.medial, Vec3(-tract.medial), tract.superior, Vec3(-tract.superior)},
      [&](const Vec3& out) { return envelope.share(at + 0.5 * tract.radius_m * out) >= 0.5; });
}

/// The envelope of filled bone about a tract, which must lie in it beyond its first third.
core::Result<std::shared_ptr<const volume::Envelope>> envelope_of(const volume::Volume& ct,
                                                                  const CarvingPlan& plan,
                                                                  const volume::Tract& tract) {
  std::shared_ptr<const volume::Envelope> envelope = plan.envelope;
  if (!envelope) envelope = TRY(volume::envelope_about(ct, tract, plan.envelope_marks));
  for (const double share : {0.4, 0.6, 0.8}) {
    const double depth_m = share * tract.length_m;
    if (!lies_in(*envelope, tract, depth_m))
      return Error{Errc::out_of_range,
                   fmt::format("the tract leaves the vertebra's envelope at depth {:.1f} mm: move "
                               "entry or target, or give the envelope",
                               depth_m * 1e3)};
  }
  return envelope;
}

volume::Calibration calibration_of(const volume::Volume& ct, const volume::Envelope& envelope,
                                   const volume::Tract& tract) {
  auto found = volume::calibrate(volume::histogram_of(ct), ct.geometry);
  volume::calibrate_bone(ct, envelope, tract, found);
  return found;
}

/// The tract's length in filled bone, where none is asked for: to shortly before the anterior face.
double length_to_front_m(const volume::WallFinder& finder, const volume::Tract& tract) {
  const auto front = finder.wall_at(tract, volume::Wall::anterior, tract.length_m);
  return front ? tract.length_m + front->outer_m - kBehindFront_m : tract.length_m;
}

volume::Box region_of(const volume::Geometry& geometry, const Placed& placed, double margin_m) {
  std::vector<Vec3> points{placed.tract.entry_m, placed.tract.end_m()};
  if (placed.breach) points.push_back(placed.breach->tip_m);
  return volume::box_about(geometry, points, margin_m);
}

/// Adds what the walls of the prepared bone say: mouth, walls, breach.
core::Result<Placed> with_walls(const volume::Volume& bone,
                                const volume::TransferFunction& transfer, const CarvingPlan& plan,
                                Placed placed) {
  const volume::WallFinder finder(bone, transfer);
  placed.mouth_m = finder.behind_entry_m(placed.tract) + kOpenAir_m;
  placed.walls = finder.thinnest(placed.tract);
  if (plan.breach)
    placed.breach = TRY(volume::place_breach(bone, transfer, placed.tract, *plan.breach));
  return placed;
}

core::Result<volume::Volume> prepared_ct(const volume::Volume& ct,
                                         const volume::TransferFunction& transfer,
                                         const Placed& placed) {
  const auto& tract = placed.tract;
  const auto box = TRY(box_that_matters(ct.geometry, tract.entry_m, tract.end_m()));
  auto part = TRY(volume::resample_finer(ct, box, ct.geometry.spacing_m.maxCoeff()));
  if (placed.envelope)
    TRY(volume::Filling::make(transfer)).fill(part, *placed.envelope, placed.tract);
  return part;
}

/// An anterior breach is felt by taps at the end: its wall must be there.
core::Result<void> check_front(const Placed& placed) {
  if (!placed.breach || placed.breach->wall.wall != volume::Wall::anterior) return {};
  const double behind_m = placed.breach->wall.outer_m;
  if (behind_m <= kFarBehindFront_m) return {};
  return Error{Errc::out_of_range,
               fmt::format("anterior: the tract ends {:.1f} mm behind the bone's anterior face, at "
                           "most {:g} mm are allowed: give a length of {:.1f} mm, or none",
                           behind_m * 1e3, kFarBehindFront_m * 1e3,
                           (placed.tract.length_m + behind_m - kBehindFront_m) * 1e3)};
}

/// Beyond the tract's ends, along x, y and z of V: the halves of the vertebra are compared up to 71
/// mm aside, turned by up to 12 degrees; walls are looked for within 25 mm, bone behind the entry
/// within 45 mm; the drilled volume has 20 mm about tract and breach.
const Vec3 kMatters_m(0.090, 0.060, 0.050);

}  // namespace

core::Result<volume::Box> box_that_matters(const volume::Geometry& geometry, const Vec3& entry_m,
                                           const Vec3& target_m) {
  if (!entry_m.allFinite() || !target_m.allFinite())
    return Error{Errc::bad_input, "entry and target must be finite numbers"};
  if (!geometry.contains(entry_m)) return outside("the entry", entry_m, geometry);
  if (!geometry.contains(target_m)) return outside("the target", target_m, geometry);
  const Vec3 low = entry_m.cwiseMin(target_m) - kMatters_m;
  const Vec3 high = entry_m.cwiseMax(target_m) + kMatters_m;
  Vec3 first = Vec3::Constant(1e30), last = Vec3::Constant(-1e30);
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p;
    for (int a = 0; a < 3; ++a) p[a] = (corner >> a) & 1 ? high[a] : low[a];
    const Vec3 index = geometry.index_of(p);
    first = first.cwiseMin(index);
    last = last.cwiseMax(index);
  }
  volume::Box box;
  for (int a = 0; a < 3; ++a) {
    const auto at = std::size_t(a);
    const double top = geometry.dims[at];
    box.begin[at] = int(std::clamp(std::floor(first[a]), 0.0, top));
    box.end[at] = int(std::clamp(std::ceil(last[a]) + 1.0, 0.0, top));
  }
  return box;
}

Truth Placed::truth() const {
  Truth truth;
  if (!breach) return truth;
  truth.breached = breach->wall.wall;
  truth.breach_m = breach->centre_m;
  truth.breach_depth_m = breach->depth_m;
  truth.wall_thickness_m = breach->wall.thickness_m();
  return truth;
}

core::Result<volume::Tract> planned_tract(const volume::Volume& ct,
                                          const volume::TransferFunction& transfer,
                                          const CarvingPlan& plan) {
  const double length_m = length_of(plan);
  TRY(check(plan, length_m, ct.geometry));
  return tract_of(ct, transfer, plan, length_m, TRY(midline_of(ct, transfer, plan)));
}

core::Result<PlacedInBone> place_in_bone(const volume::Volume& ct,
                                         const volume::TransferFunction& transfer,
                                         const CarvingPlan& plan) {
  const double length_m = length_of(plan);
  TRY(check(plan, length_m, ct.geometry));
  const auto empty = TRY(volume::empty_value(ct, transfer));
  const auto midline = TRY(midline_of(ct, transfer, plan));
  const auto tract = TRY(tract_of(ct, transfer, plan, length_m, midline));
  Placed placed{.tract = tract,
                .midline = midline,
                .empty_value = empty,
                .breach = {},
                .envelope = {},
                .walls = {}};
  placed.drilled = plan.drilled;
  const bool filled = plan.preparation == volume::Preparation::filled;
  if (filled) {
    placed.envelope = TRY(envelope_of(ct, plan, tract));
    placed.calibration = calibration_of(ct, *placed.envelope, tract);
  }
  auto bone = TRY(prepared_ct(ct, transfer, placed));
  if (filled && !plan.length_m)
    placed.tract.length_m = length_to_front_m(volume::WallFinder(bone, transfer), tract);
  placed = TRY(with_walls(bone, transfer, plan, std::move(placed)));
  if (filled) TRY(check_front(placed));
  return PlacedInBone{std::move(placed), std::move(bone)};
}

core::Result<Placed> place(const volume::Volume& ct, const volume::TransferFunction& transfer,
                           const CarvingPlan& plan) {
  return TRY(place_in_bone(ct, transfer, plan)).placed;
}

core::Result<volume::Volume> bone_about(const volume::Volume& ct,
                                        const volume::TransferFunction& transfer,
                                        const CarvingPlan& plan, const Placed& placed,
                                        const core::Progress& progress) {
  auto part = TRY(volume::resample_finer(ct, region_of(ct.geometry, placed, plan.margin_m),
                                         plan.spacing_m, progress));
  if (placed.envelope)
    TRY(volume::Filling::make(transfer)).fill(part, *placed.envelope, placed.tract);
  return part;
}

core::Result<Carved> carve(const volume::Volume& ct, const volume::TransferFunction& transfer,
                           const CarvingPlan& plan, const core::Progress& progress) {
  Carved carved{TRY(place(ct, transfer, plan)), {}};
  carved.volume = TRY(bone_about(ct, transfer, plan, carved, progress));
  if (carved.drilled)
    volume::drill(carved.volume, carved.tract, carved.mouth_m, carved.breach, carved.empty_value);
  return carved;
}

core::Result<volume::Volume> drilled_surroundings(const volume::Volume& ct, const Carved& carved) {
  auto part = volume::resample_finer(ct, region_of(ct.geometry, carved, kSurroundings_m),
                                     kSurroundingsSpacing_m);
  if (part && carved.drilled)
    volume::drill(*part, carved.tract, carved.mouth_m, carved.breach, carved.empty_value);
  return part;
}

}  // namespace cases
}  // namespace tractus
