#include "volume/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tractus {
namespace volume {
namespace {

struct Range {
  double low, high;
};
constexpr Range kAir{-1100.0, -850.0}, kFat{-160.0, -40.0}, kSoftTissue{-10.0, 120.0};
constexpr Range kContrastAgents{150.0, 700.0};
constexpr double kOwnPeak = 1.3;       // times the least bin below it
constexpr double kLeastShare = 0.002;  // of all voxels, in the bins of a peak
constexpr double kMetalFrom = 2500.0, kMostMetal_m3 = 5e-8;
constexpr double kThick_m = 0.002, kWeakCortex = 500.0;
constexpr double kAirFrom = -1060.0, kAirTo = -940.0;  // of a calibrated scan
constexpr double kAirHU = -1000.0, kFatHU = -100.0, kSoftTissueHU = 50.0;
constexpr double kMostSlopeOff = 0.3;
constexpr double kNoAirFrom = -500.0;
constexpr double kDeep_m = 0.003, kFaceLayer_m = 0.002, kRayStep_m = 0.0005;
constexpr int kDirections = 16;

/// Voxels per CT value, smoothed over three bins.
class Spectrum {
 public:
  explicit Spectrum(const Histogram& h) : low_(h.low), width_(h.width) {
    for (std::size_t k = 0; k < h.voxels.size(); ++k) {
      double sum = 0.0, bins = 0.0;
      for (std::size_t n = k == 0 ? 0 : k - 1; n <= std::min(k + 1, h.voxels.size() - 1); ++n)
        sum += double(h.voxels[n]), bins += 1.0;
      smooth_.push_back(sum / bins);
      all_ += double(h.voxels[k]);
    }
  }
  double value(std::size_t bin) const { return low_ + (double(bin) + 0.5) * width_; }
  std::vector<std::size_t> bins_in(const Range& range) const {
    std::vector<std::size_t> out;
    for (std::size_t k = 0; k < smooth_.size(); ++k)
      if (value(k) >= range.low && value(k) <= range.high) out.push_back(k);
    return out;
  }
  /// The greatest bin of a range, where it is more than both ends of the range.
  std::optional<double> peak(const Range& range) const {
    const auto bins = bins_in(range);
    if (bins.size() < 3) return std::nullopt;
    const auto by_voxels = [&](std::size_t k) { return smooth_[k]; };
    const std::size_t top = *std::ranges::max_element(bins, {}, by_voxels);
    if (top == bins.front() || top == bins.back()) return std::nullopt;
    if (smooth_[top] < kLeastShare * all_ / double(bins.size())) return std::nullopt;
    return value(top);
  }
  /// A peak that rises out of what falls towards it.
  std::optional<double> own_peak(const Range& range) const {
    double least = 1e300;
    for (const std::size_t k : bins_in(range)) {
      const bool top = k > 0 && k + 1 < smooth_.size() && smooth_[k] >= smooth_[k - 1] &&
                       smooth_[k] > smooth_[k + 1];
      if (top && smooth_[k] > kOwnPeak * least && smooth_[k] > kLeastShare * all_ / 8.0)
        return value(k);
      least = std::min(least, smooth_[k]);
    }
    return std::nullopt;
  }

 private:
  double low_, width_, all_ = 0.0;
  std::vector<double> smooth_;
};

double volume_above_m3(const Histogram& h, const Geometry& geometry, double value) {
  double voxels = 0.0;
  for (std::size_t k = 0; k < h.voxels.size(); ++k)
    if (h.low + double(k) * h.width >= value) voxels += double(h.voxels[k]);
  return voxels * geometry.spacing_m.prod();
}

double median_of(std::vector<double>& values) {
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

Calibration calibrate(const Histogram& histogram, const Geometry& geometry) {
  const Spectrum spectrum(histogram);
  Calibration out{.air = spectrum.peak(kAir),
                  .fat = spectrum.peak(kFat),
                  .soft_tissue = spectrum.peak(kSoftTissue)};
  const auto warn = [&](std::string line) { out.warnings.push_back(std::move(line)); };
  if (out.air && (*out.air < kAirFrom || *out.air > kAirTo))
    warn(fmt::format("air measures {:.0f}, not -1000: the values may not be HU", *out.air));
  if (!out.fat && !out.soft_tissue)
    warn(
        "neither fat (about -100) nor soft tissue (about 50) shows a peak: the values may not be "
        "HU, or the part is too small to tell");
  if (histogram.low > kNoAirFrom)
    warn(
        fmt::format("nothing measures under {:.0f}, as air does: the values may not be HU, or the "
                    "part lies within the body",
                    kNoAirFrom));
  if (const double metal = volume_above_m3(histogram, geometry, kMetalFrom); metal > kMostMetal_m3)
    warn(fmt::format("{:.2f} ml measure over {:.0f}: metal, with streaks about it", metal * 1e6,
                     kMetalFrom));
  if (const auto agent = spectrum.own_peak(kContrastAgents))
    warn(
        fmt::format("a peak at {:.0f}, where bone alone has none: a contrast agent, which cannot "
                    "be told from bone",
                    *agent));
  if (const double slice_m = geometry.spacing_m.maxCoeff(); slice_m > kThick_m + 1e-9)
    warn(
        fmt::format("voxels of {:.1f} mm: thin cortex measures as soft tissue, and the outer face "
                    "is placed coarsely",
                    slice_m * 1e3));
  return out;
}

core::Result<TransferFunction> calibrated(const TransferFunction& transfer,
                                          const Calibration& calibration) {
  std::vector<std::pair<double, double>> known;  // HU, and what the scan has there
  for (const auto& [value, peak] : {std::pair(kAirHU, calibration.air),
                                    {kFatHU, calibration.fat},
                                    {kSoftTissueHU, calibration.soft_tissue}})
    if (peak) known.emplace_back(value, *peak);
  if (known.size() < 2)
    return core::Error{
        core::Errc::out_of_range,
        "the transfer function cannot be calibrated: of air, fat and soft tissue the "
        "scan must show two peaks"};
  const auto &low = known.front(), &high = known.back();
  const double slope = (high.second - low.second) / (high.first - low.first);
  if (std::abs(slope - 1.0) > kMostSlopeOff)
    return core::Error{core::Errc::out_of_range,
                       fmt::format("the transfer function cannot be calibrated: between its peaks "
                                   "the scan has {:.2f} units a HU",
                                   slope)};
  auto points = transfer.points();
  for (auto& point : points) point.value = low.second + slope * (point.value - low.first);
  return TransferFunction::make(std::move(points));
}

void calibrate_bone(const Volume& ct, const Envelope& envelope, const Tract& tract,
                    Calibration& out) {
  std::vector<double> deep, cortex, thickness_m;
  for (double at = 0.0; at <= tract.length_m; at += kFaceLayer_m)
    for (int turn = 0; turn < kDirections; ++turn) {
      const double angle = 2.0 * std::numbers::pi * turn / kDirections;
      const Vec3 along = std::cos(angle) * tract.medial + std::sin(angle) * tract.superior;
      double most = -1e300, last_inside_m = 1.0;
      thickness_m.push_back(
          envelope.depth(tract.entry_m + at * tract.axis + kDeep_m * along).cortex_m);
      for (double r = 0.0; r <= Envelope::kReach_m && last_inside_m >= 0.0; r += kRayStep_m) {
        const Vec3 p = tract.entry_m + at * tract.axis + r * along;
        last_inside_m = envelope.inside_m(p);
        if (last_inside_m >= kDeep_m) deep.push_back(ct.value_at(p));
        if (last_inside_m >= 0.0 && last_inside_m <= kFaceLayer_m)
          most = std::max(most, ct.value_at(p));
      }
      if (last_inside_m < 0.0 && most > -1e300) cortex.push_back(most);
    }
  if (!deep.empty()) out.cancellous = median_of(deep);
  if (cortex.empty()) return;
  out.cortical = median_of(cortex);
  out.cortex_m = median_of(thickness_m);
  if (*out.cortical < kWeakCortex)
    out.warnings.push_back(fmt::format(
        "cortex measures {:.0f}, under {:.0f}: a soft kernel, coarse voxels or porous bone; its "
        "thickness is an estimate from how it is blurred",
        *out.cortical, kWeakCortex));
}

}  // namespace volume
}  // namespace tractus
