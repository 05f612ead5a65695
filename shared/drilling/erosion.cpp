#include "drilling/erosion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "core/try.hpp"
#include "volume/carve.hpp"
#include "volume/force_field.hpp"

namespace tractus {
namespace drilling {
namespace {

using math::Vec3;
using volume::Box;

constexpr double kLongest_s = 0.020;   // between two samples of one motion
constexpr double kFarthest_m = 0.020;  // likewise: 1 m/s, where every speed guard has struck

bool is_empty(const Box& box) { return box.begin[0] >= box.end[0]; }

/// The voxels whose centres may lie in the ball, clipped to the volume.
Box box_of_ball(const volume::Geometry& geometry, const Vec3& index, double radius_m) {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    const double at = index[int(a)], reach = radius_m / geometry.spacing_m[int(a)];
    const double top = geometry.dims[a];
    box.begin[a] = int(std::clamp(std::ceil(at - reach), 0.0, top));
    box.end[a] = int(std::clamp(std::floor(at + reach) + 1.0, 0.0, top));
    if (box.begin[a] >= box.end[a]) return {};
  }
  return box;
}

double push_N(const trial::Sample& sample) {
  return Vec3(sample.force_N[0], sample.force_N[1], sample.force_N[2]).norm();
}

/// What a ball that lies across voxel borders in the worst way needs.
std::size_t floats_of_ball(const volume::Geometry& geometry, double radius_m) {
  std::size_t floats = 1;
  for (int a = 0; a < 3; ++a) {
    const auto voxels = std::size_t(2.0 * radius_m / geometry.spacing_m[a]) + 2 + 14;  // and blur
    floats *= a == 0 ? voxels + 14 : voxels;  // rows are whole eights
  }
  return floats;
}

}  // namespace

Box united(const Box& a, const Box& b) noexcept {
  if (is_empty(a)) return b;
  if (is_empty(b)) return a;
  Box out;
  for (std::size_t k = 0; k < 3; ++k) {
    out.begin[k] = std::min(a.begin[k], b.begin[k]);
    out.end[k] = std::max(a.end[k], b.end[k]);
  }
  return out;
}

ErodedShares worn_of(const Erosion& erosion) {
  ErodedShares out{.box = erosion.worn(), .lost = {}, .removed_m3 = erosion.removed_m3()};
  const auto& [begin, end] = out.box;
  out.lost.reserve(std::size_t(end[0] - begin[0]) * std::size_t(end[1] - begin[1]) *
                   std::size_t(end[2] - begin[2]));
  for (int k = begin[2]; k < end[2]; ++k)
    for (int j = begin[1]; j < end[1]; ++j)
      for (int i = begin[0]; i < end[0]; ++i) out.lost.push_back(float(erosion.lost(i, j, k)));
  return out;
}

core::Result<Erosion> Erosion::make(const volume::Volume& bone,
                                    const volume::TransferFunction& transfer, const Burr& burr,
                                    const trial::ProbeShape& probe) {
  core::require(bone.slope > 0.0 && bone.counts.size() == bone.geometry.voxel_count(),
                "a volume's values grow with its counts, and it holds all of them");
  const auto empty = TRY(volume::empty_value(bone, transfer));
  if (floats_of_ball(bone.geometry, burr.radius_m) > kMostPatchFloats)
    return core::Error{core::Errc::out_of_range,
                       fmt::format("a burr of {:.2f} mm radius is too large for voxels of {:.3g} "
                                   "mm: what it changes at once could not be felt in time",
                                   burr.radius_m * 1e3, bone.geometry.spacing_m.minCoeff() * 1e3)};
  Erosion made(bone, burr, probe, bone.count_of(empty));
  if (!made.lost_)
    return core::Error{core::Errc::too_large, "drilling: there is not enough memory"};
  for (std::size_t count = 0; count < made.opacity_.size(); ++count)
    made.opacity_[count] = float(transfer.opacity(bone.intercept + bone.slope * double(count)));
  return made;
}

Erosion::Erosion(const volume::Volume& bone, const Burr& burr, const trial::ProbeShape& probe,
                 std::uint16_t empty)
    : bone_(&bone),
      drilled_(bone),
      lost_(static_cast<float*>(std::calloc(bone.counts.size(), sizeof(float)))),
      opacity_(std::size_t(1) << 16),
      burr_(burr),
      probe_(probe),
      empty_(empty),
      finest_m_(bone.geometry.spacing_m.minCoeff()) {}

void Erosion::add(const trial::Sample& sample, const Take& changed) {
  if (const auto chunk = sample.tick / kChunkTicks; chunk != chunk_) {
    flush(changed);
    chunk_ = chunk;
  }
  if (sample.flags & trial::kStale) {  // where the tip is now is not known
    last_.reset();
    return;
  }
  const Vec3 centre_m =
      trial::tip_m(sample, probe_) - burr_.nose_m * (sample.pose().q * Vec3::UnitZ());
  const double dt_s = last_ ? sample.t_s - last_->t_s : 0.0;
  const bool moved_on =
      dt_s > 0.0 && dt_s <= kLongest_s && (centre_m - last_->centre_m).norm() <= kFarthest_m;
  if (moved_on && (sample.flags & trial::kPressed)) {
    const double opacity = mean_opacity(centre_m);
    const double rate_per_s =
        opacity > 0.0 ? burr_.rate_at_per_s(push_N(sample) / opacity) : burr_.rate_per_s;
    const double dose = rate_per_s * dt_s;
    if (dose > 0.0) sweep(last_->centre_m, centre_m, dose, changed);
  }
  last_ = {centre_m, sample.t_s};
}

// ᾱ of the ball at its place.
double Erosion::mean_opacity(const Vec3& centre_m) const noexcept {
  const volume::Geometry& geometry = bone_->geometry;
  const Vec3 index = geometry.index_of(centre_m);
  const Box ball = box_of_ball(geometry, index, burr_.radius_m);
  const double r2 = burr_.radius_m * burr_.radius_m;
  double sum = 0.0, weight = 0.0;
  for (int k = ball.begin[2]; k < ball.end[2]; ++k)
    for (int j = ball.begin[1]; j < ball.end[1]; ++j)
      for (int i = ball.begin[0]; i < ball.end[0]; ++i) {
        const Vec3 off_m = (Vec3(i, j, k) - index).cwiseProduct(geometry.spacing_m);
        const double w = 1.0 - off_m.squaredNorm() / r2;
        if (w <= 0.0) continue;
        sum += w * double(opacity_[drilled_.counts[bone_->offset(i, j, k)]]);
        weight += w;
      }
  return weight > 0.0 ? sum / weight : 0.0;
}

void Erosion::finish(const Take& changed) { flush(changed); }

void Erosion::sweep(const Vec3& from_m, const Vec3& to_m, double dose, const Take& changed) {
  const int steps = std::max(1, int(std::ceil((to_m - from_m).norm() / (0.5 * finest_m_))));
  for (int step = 1; step <= steps; ++step)
    place(from_m + (double(step) / steps) * (to_m - from_m), dose / steps, changed);
}

void Erosion::place(const Vec3& centre_m, double dose, const Take& changed) {
  if (dose_.sum > 0.0 && (centre_m - dose_.at_m).norm() > 0.25 * finest_m_) wear(changed);
  if (dose_.sum == 0.0) dose_.at_m = centre_m;
  dose_.moment_m += dose * centre_m;
  dose_.sum += dose;
}

// Eq. (1) for one ball and its dose.
void Erosion::wear(const Take& changed) {
  const Dose dose = std::exchange(dose_, {});
  if (dose.sum == 0.0) return;
  const volume::Geometry& geometry = bone_->geometry;
  const Vec3 index = geometry.index_of(dose.moment_m / dose.sum);
  const Box ball = box_of_ball(geometry, index, burr_.radius_m);
  if (is_empty(ball)) return;
  const auto room = volume::FieldPatch::floats_for(united(changing_, ball), geometry.dims);
  if (room > kMostPatchFloats) tell(changed);
  const double r2 = burr_.radius_m * burr_.radius_m;
  for (int k = ball.begin[2]; k < ball.end[2]; ++k)
    for (int j = ball.begin[1]; j < ball.end[1]; ++j)
      for (int i = ball.begin[0]; i < ball.end[0]; ++i) {
        const Vec3 off_m = (Vec3(i, j, k) - index).cwiseProduct(geometry.spacing_m);
        const double share = dose.sum * (1.0 - off_m.squaredNorm() / r2);
        if (share > 0.0) wear_voxel(bone_->offset(i, j, k), i, j, k, share);
      }
}

void Erosion::wear_voxel(std::size_t at, int i, int j, int k, double share) noexcept {
  const std::uint16_t whole = bone_->counts[at];
  const float before = lost_[at];
  if (before >= 1.0f) return;
  const float after = std::min(1.0f, before + float(share));
  lost_[at] = after;
  worn_ = united(worn_, {{i, j, k}, {i + 1, j + 1, k + 1}});
  if (whole <= empty_) return;  // fat, air: the burr went there, and nothing changes
  if (opacity_[whole] > 0.0f)
    removed_m3_ += double(after - before) * bone_->geometry.spacing_m.prod();
  const auto gone = std::uint16_t(std::lround(double(after) * (whole - empty_)));
  const auto count = std::uint16_t(whole - gone);
  if (count == drilled_.counts[at]) return;
  drilled_.counts[at] = count;
  changing_ = united(changing_, {{i, j, k}, {i + 1, j + 1, k + 1}});
}

void Erosion::flush(const Take& changed) {
  wear(changed);
  tell(changed);
}

void Erosion::tell(const Take& changed) {
  if (is_empty(changing_)) return;
  const Box box = std::exchange(changing_, {});
  box_ = united(box_, box);
  ++changes_;
  if (changed) changed({box, changes_, last_ ? last_->t_s : 0.0});
}

}  // namespace drilling
}  // namespace tractus
