#include "volume/fill.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "volume/resample.hpp"

namespace tractus {
namespace volume {
namespace {

constexpr double kCortexEnds_m = 0.0005;  // over which its share falls

double cortex_share(const Envelope::Depth& depth) {
  return std::clamp(1.0 - (depth.inside_m - depth.cortex_m) / kCortexEnds_m, 0.0, 1.0);
}

}  // namespace

core::Result<Filling> Filling::make(const TransferFunction& transfer) {
  const auto& points = transfer.points();
  const bool rises = std::ranges::is_sorted(points, {}, &TransferFunction::Point::opacity);
  const auto full = std::ranges::find_if(
      points, [&](const auto& point) { return point.opacity == points.back().opacity; });
  if (!rises || points.back().opacity < 1.0 - 1e-9 || !(full->value > 0.0))
    return core::Error{core::Errc::out_of_range,
                       "marrow is filled for a transfer function that rises to the opacity 1 at a "
                       "positive CT value, and this one does not"};
  return Filling(transfer, full->value);
}

/// The least CT value with an opacity; it lies on one of the rising pieces.
double Filling::value_of(double opacity) const noexcept {
  const auto& points = transfer_.points();
  for (std::size_t k = 1; k < points.size(); ++k) {
    const auto &low = points[k - 1], &high = points[k];
    if (high.opacity < opacity) continue;
    if (low.opacity >= opacity) return low.value;
    return low.value +
           (opacity - low.opacity) / (high.opacity - low.opacity) * (high.value - low.value);
  }
  return points.back().value;
}

double Filling::filled(double value, double cortex) const noexcept {
  const double lacking = (1.0 - cortex) * (1.0 - std::clamp(value / full_, 0.0, 1.0));
  return std::max(value, value_of(1.0 - (1.0 - kLeastOpacity) * lacking));
}

Box Filling::fill(Volume& volume, const Envelope& envelope, const Tract& tract) const {
  const std::array<Vec3, 2> ends{tract.entry_m, tract.end_m()};
  const Box box = box_about(volume.geometry, ends, Envelope::kReach_m);
  tbb::parallel_for(box.begin[2], box.end[2], [&](int k) {
    for (int j = box.begin[1]; j < box.end[1]; ++j)
      for (int i = box.begin[0]; i < box.end[0]; ++i) {
        const double before = volume.value(i, j, k);
        if (before >= full_) continue;  // as opaque as bone can be
        const auto depth = envelope.depth(volume.geometry.position_of(Vec3(i, j, k)));
        const double share = envelope.share_at(depth.inside_m);
        if (share == 0.0) continue;
        const double after = filled(before, cortex_share(depth));
        volume.counts[volume.offset(i, j, k)] = volume.count_of(before + share * (after - before));
      }
  });
  return box;
}

}  // namespace volume
}  // namespace tractus
