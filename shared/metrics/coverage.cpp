/// Wall contact unrolled into bins of depth and angle.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "metrics/metric.hpp"
#include "trial/signals.hpp"

namespace tractus {
namespace metrics {
namespace {
/// First of the three bins of a side wall's quarter: medial is centred on bin 0.
int first_bin(volume::Wall side) {
  switch (side) {
    case volume::Wall::medial:
      return kAngleBins - 1;
    case volume::Wall::superior:
      return 2;
    case volume::Wall::lateral:
      return 5;
    case volume::Wall::inferior:
      return 8;
    case volume::Wall::anterior:
      break;
  }
  core::require(false, "the anterior end has no angle");
  return 0;
}
}  // namespace

void Coverage::add(double depth_share, double angle_rad) {
  if (!(depth_share >= 0.0 && depth_share <= 1.0) || !std::isfinite(angle_rad)) return;
  const int depth = std::min(int(depth_share * depth_bins), depth_bins - 1);
  const double turns = angle_rad / (2.0 * std::numbers::pi);
  const double within = turns - std::floor(turns);  // 0 … 1
  const int angle = int(within * angle_bins + 0.5) % angle_bins;
  ++samples[std::size_t(depth * angle_bins + angle)];
}

double Coverage::share(std::optional<volume::Wall> side) const {
  const int width = side ? angle_bins / 4 : angle_bins;
  const int first = side ? first_bin(*side) : 0;
  int touched = 0;
  for (int depth = 0; depth < depth_bins; ++depth)
    for (int i = 0; i < width; ++i)
      touched += samples[std::size_t(depth * angle_bins + (first + i) % angle_bins)] > 0;
  return double(touched) / double(depth_bins * width);
}

namespace {

std::optional<Coverage> computed_coverage(const Subject& subject) {
  const auto probe = trial::probe_shape(subject.trial.header);
  if (!probe || !subject.tract) return std::nullopt;
  const volume::Tract& tract = *subject.tract;
  Coverage out{kDepthBins, kAngleBins, std::vector<std::uint32_t>(kDepthBins * kAngleBins)};
  for (const auto& sample : subject.trial.samples) {
    const math::Vec3 force_V =
        sample.pose().q * math::Vec3(sample.force_N[0], sample.force_N[1], sample.force_N[2]);
    const math::Vec2 towards(-force_V.dot(tract.medial), -force_V.dot(tract.superior));
    if (!(towards.norm() >= kContact_N)) continue;
    const double depth_m = tract.depth_of(trial::tip_m(sample, *probe));
    out.add(depth_m / tract.length_m, std::atan2(towards.y(), towards.x()));
  }
  return out;
}

}  // namespace

const std::optional<Coverage>& coverage(const Subject& subject) {
  auto& kept = subject.derived.coverage;
  if (!kept) kept = std::make_shared<const std::optional<Coverage>>(computed_coverage(subject));
  return *kept;
}

}  // namespace metrics
}  // namespace tractus
