#include "volume/envelope.hpp"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "core/try.hpp"
#include "volume/cortex.hpp"
#include "volume/ray_fan.hpp"

namespace tractus {
namespace volume {
namespace {

constexpr double kRadialStep_m = 0.0005;
constexpr int kRadial = int(Envelope::kReach_m / kRadialStep_m) + 1;
constexpr double kFaceWidth_m = 0.0015;  // w, at least
constexpr double kMostValue = 600.0, kContrast = 300.0;
constexpr float kFaceBehind = 0.5f;                 // μ
constexpr float kFaint = 0.2f;                      // e₀
constexpr float kNoFace = -0.1f;                    // cost of no face within reach
constexpr float kStep = 0.06f, kMostSteps = 12.0f;  // price of a step of kRadialStep_m, and its cap
constexpr double kNoFace_m = 0.021;                 // a face beyond it is none
constexpr int kAside = 2;                           // rays to each side of a wall's direction
constexpr double kMostOpen = 0.15;                  // of them without a face
constexpr double kThickestSlice_m = 0.0035;
constexpr double kMetal = 2500.0, kNearMetal_m = 0.006;  // cortex stays under 2000 HU
constexpr double kRing_m = 0.014;                        // faces of a pedicle lie within it
constexpr int kShortestRing = 4;                         // rows
constexpr float kForbidden = 50.0f;   // cost of a face where a mark says that none is
constexpr std::size_t kBlurFrom = 8;  // rays, from which the blur is measured
constexpr double kProfileFrom_m = -0.005, kProfileTo_m = 0.0025;  // of a cortex, about its face
constexpr double kThinnestCortex_m = 0.0003;                // [Treece2010] is unbiased down to it
constexpr double kCanal_m = 0.006, kContrastAgent = 150.0;  // beyond a medial face lies the canal

core::Error refusal(std::string why) { return {core::Errc::out_of_range, std::move(why)}; }

using Costs = std::vector<float>;  // [row][turn][radius]

std::size_t column(int row, int turn) {
  return (std::size_t(row) * Fan::kRays + std::size_t(turn)) * std::size_t(kRadial);
}

/// Costs of a face along one ray.
void ray_costs(const Volume& ct, const Vec3& foot, const Vec3& direction, double width_m,
               float* cost) {
  const int w = int(std::lround(width_m / kRadialStep_m));
  std::vector<double> sums{0.0};  // of clamped values, from −w steps on
  for (int r = -w; r <= kRadial + w; ++r) {
    const Vec3 p = foot + std::max(r, 0) * kRadialStep_m * direction;
    sums.push_back(sums.back() + std::clamp(ct.value_at(p), 0.0, kMostValue));
  }
  float passed = 0.0f;
  for (int r = 0; r < kRadial; ++r) {
    const auto at = std::size_t(r + w);
    const double within = sums[at] - sums[at - std::size_t(w)];
    const double beyond = sums[at + std::size_t(w)] - sums[at];
    const float edge = float((within - beyond) / w / kContrast);
    cost[r] = r + 1 == kRadial ? kNoFace + passed : passed - edge;
    passed += kFaceBehind * std::max(0.0f, edge - kFaint) / float(w);
  }
}

/// Where a ray runs through a mark there is no face: of bone, none nearer than its far end; of no
/// bone, none beyond its near end.
void heed_marks(std::span<const EnvelopeMark> marks, const Vec3& foot, const Vec3& direction,
                float* cost) {
  for (const EnvelopeMark& mark : marks) {
    const Vec3 to = mark.at_m - foot;
    const double along_m = to.dot(direction),
                 half2 = mark.radius_m * mark.radius_m - (to.squaredNorm() - along_m * along_m);
    if (!(half2 > 0.0)) continue;
    const double half_m = std::sqrt(half2);
    if (along_m + half_m <= 0.0 || along_m - half_m >= Envelope::kReach_m) continue;
    const int near = std::clamp(int((along_m - half_m) / kRadialStep_m), 0, kRadial - 1),
              far = std::clamp(int((along_m + half_m) / kRadialStep_m) + 1, 0, kRadial - 1);
    if (mark.bone)
      for (int r = 0; r < far; ++r) cost[r] += kForbidden;
    else
      for (int r = near + 1; r < kRadial; ++r) cost[r] += kForbidden;
  }
}

/// Adds one step of a path: what the best way to each radius costs, coming from `before`.
void path_step(const float* cost, std::vector<float>& before, float* sum) {
  const float least = *std::ranges::min_element(before), most = least + kStep * kMostSteps;
  for (std::size_t r = 1; r < before.size(); ++r)
    before[r] = std::min(before[r], before[r - 1] + kStep);
  for (std::size_t r = before.size() - 1; r-- > 0;)
    before[r] = std::min(before[r], before[r + 1] + kStep);
  for (std::size_t r = 0; r < before.size(); ++r) {
    before[r] = cost[r] + std::min(before[r], most) - least;
    sum[r] += before[r];
  }
}

/// Sums of the path costs from four directions; those about the axis run round twice.
Costs path_sums(const Costs& costs, int rows) {
  Costs sums(costs.size(), 0.0f);
  const auto run = [&](int steps, int quiet, const auto& place) {
    std::vector<float> before(kRadial, 0.0f), scratch(kRadial);
    for (int k = 0; k < steps; ++k) {
      const std::size_t at = place(k);
      path_step(&costs[at], before, k < quiet ? scratch.data() : &sums[at]);
    }
  };
  tbb::parallel_for(0, Fan::kRays, [&](int turn) {
    run(rows, 0, [&](int k) { return column(k, turn); });
    run(rows, 0, [&](int k) { return column(rows - 1 - k, turn); });
  });
  tbb::parallel_for(0, rows, [&](int row) {
    run(2 * Fan::kRays, Fan::kRays, [&](int k) { return column(row, k % Fan::kRays); });
    run(2 * Fan::kRays, Fan::kRays,
        [&](int k) { return column(row, Fan::kRays - 1 - k % Fan::kRays); });
  });
  return sums;
}

/// A number for each ray; between rays bilinear.
class PerRay {
 public:
  PerRay(int rows, std::vector<double> values) : rows_(rows), values_(std::move(values)) {}
  double at(int row, int turn) const {
    return values_[std::size_t(row) * Fan::kRays + std::size_t(turn % Fan::kRays)];
  }
  double near(const Fan::Place& place) const {
    const int row = std::clamp(int(place.row), 0, rows_ - 2), turn = int(place.turn);
    const double a = place.row - row, b = place.turn - turn;
    return (1 - a) * ((1 - b) * at(row, turn) + b * at(row, turn + 1)) +
           a * ((1 - b) * at(row + 1, turn) + b * at(row + 1, turn + 1));
  }

 private:
  int rows_;
  std::vector<double> values_;  // [row][turn]
};

/// The rays of a pole are one ray, found as often: there their mean is taken.
OuterFace outer_face_of(const Fan& fan, const PerRay& face_m) {
  OuterFace out{.around = Fan::kRays, .points_m = {}};
  for (int row = 0; row < fan.rows(); ++row) {
    double mean_m = 0.0;
    for (int turn = 0; turn < Fan::kRays; ++turn) mean_m += face_m.at(row, turn) / Fan::kRays;
    const bool pole = row == 0 || row + 1 == fan.rows();
    for (int turn = 0; turn < Fan::kRays; ++turn)
      out.points_m.push_back(fan.foot(row) +
                             (pole ? mean_m : face_m.at(row, turn)) * fan.direction(row, turn));
  }
  return out;
}

class FoundEnvelope final : public Envelope {
 public:
  FoundEnvelope(const Fan& fan, PerRay face_m, PerRay cortex_m, double voxel_m)
      : Envelope(voxel_m), fan_(fan), face_m_(std::move(face_m)), cortex_m_(std::move(cortex_m)) {}

  double inside_m(const Vec3& p) const noexcept override { return depth(p).inside_m; }
  Depth depth(const Vec3& p) const noexcept override {
    const auto place = fan_.place_within(kReach_m, p);
    if (!place) return {-kReach_m, kCortex_m};
    return {face_m_.near(*place) - place->distance_m, cortex_m_.near(*place)};
  }
  OuterFace outer_face() const override { return outer_face_of(fan_, face_m_); }
  double at(int row, int turn) const { return face_m_.at(row, turn); }

 private:
  Fan fan_;
  PerRay face_m_, cortex_m_;
};

/// Rows along the tract whose faces all lie as near as a pedicle's.
std::vector<int> ring_rows(const Fan& fan, const FoundEnvelope& envelope) {
  std::vector<int> out;
  for (int row = 0; row < fan.rows(); ++row) {
    double farthest_m = fan.beside(row) ? 0.0 : kRing_m;
    for (int turn = 0; turn < Fan::kRays; ++turn)
      farthest_m = std::max(farthest_m, envelope.at(row, turn));
    if (farthest_m < kRing_m) out.push_back(row);
  }
  return out;
}

core::Result<void> check_metal(const Volume& ct, const Fan& fan) {
  for (int row = 0; row < fan.rows(); ++row)
    for (int turn = 0; turn < Fan::kRays; turn += 4)
      for (double r = 0.0; r <= kNearMetal_m; r += Fan::kRowStep_m)
        if (const Vec3 p = fan.foot(row) + r * fan.direction(row, turn); ct.value_at(p) > kMetal)
          return refusal(
              fmt::format("metal lies {:.0f} mm from the tract ({:.0f} HU): a screw or "
                          "a cage? Choose another vertebra",
                          r * 1e3, ct.value_at(p)));
  return {};
}

core::Result<void> check_ring(const Volume& ct, const Fan& fan, const FoundEnvelope& envelope) {
  const auto ring = ring_rows(fan, envelope);
  if (int(ring.size()) < kShortestRing)
    return refusal(
        fmt::format("no closed ring of bone within {:.0f} mm surrounds the tract for {} "
                    "mm of its length: it leaves the pedicle, or the CT is too coarse",
                    kRing_m * 1e3, kShortestRing));
  double sum = 0.0;
  for (const int row : ring)
    sum += ct.value_at(fan.foot(row) + (envelope.at(row, 0) + kCanal_m) * fan.direction(row, 0));
  if (const double mean = sum / double(ring.size()); mean > kContrastAgent)
    return refusal(
        fmt::format("{:.0f} HU are measured where the spinal canal should be, {:.0f} mm beyond the "
                    "medial face: a contrast agent, which cannot be told from bone, or a face in "
                    "the wrong place; mark the bone, choose another CT, or give the envelope",
                    mean, kCanal_m * 1e3));
  return {};
}

/// A vertebra ends within reach to lateral, superior and inferior; a rib, a fused neighbour or the
/// facet of one goes on. To medial its body may be wider than that.
core::Result<void> check_leak(const Fan& fan, const FoundEnvelope& envelope) {
  for (const auto& [side, middle] :
       {std::pair("superior", Fan::kRays / 4), std::pair("lateral", Fan::kRays / 2),
        std::pair("inferior", 3 * Fan::kRays / 4)}) {
    int open = 0, rays = 0;
    for (int row = 0; row < fan.rows(); ++row)
      for (int turn = middle - kAside; fan.beside(row) && turn <= middle + kAside; ++turn)
        open += envelope.at(row, turn) >= kNoFace_m, ++rays;
    if (open > kMostOpen * rays)
      return refusal(fmt::format(
          "the bone is not left within {:.0f} mm to {} of {:.0f} % of the tract: a rib, a fused "
          "neighbour or its facet? Move entry or target, or give the envelope",
          kNoFace_m * 1e3, side, 100.0 * open / rays));
  }
  return {};
}

class LabelEnvelope final : public Envelope {
 public:
  explicit LabelEnvelope(Volume inside)
      : Envelope(inside.geometry.spacing_m.mean()),
        inside_(std::move(inside)),
        voxel_m_(inside_.geometry.spacing_m.mean()) {}
  double inside_m(const Vec3& p) const noexcept override {
    return ((inside_.geometry.contains(p) ? inside_.value_at(p) : 0.0) - 0.5) * voxel_m_;
  }

 private:
  Volume inside_;  // 1 where the label is
  double voxel_m_;
};

/// The median of each ray's value and its eight neighbours', of those that have one.
std::vector<double> smoothed(const std::vector<double>& values, int rows) {
  std::vector<double> out(values.size());
  for (int row = 0; row < rows; ++row)
    for (int turn = 0; turn < Fan::kRays; ++turn) {
      std::array<double, 9> near{};
      std::ptrdiff_t count = 0;
      for (int n = 0; n < 9; ++n) {
        const int r = std::clamp(row + n / 3 - 1, 0, rows - 1);
        const int t = (turn + n % 3 - 1 + Fan::kRays) % Fan::kRays;
        const double value = values[std::size_t(r) * Fan::kRays + std::size_t(t)];
        if (!std::isnan(value)) near[std::size_t(count++)] = value;
      }
      double& median = out[std::size_t(row) * Fan::kRays + std::size_t(turn)];
      median = std::numeric_limits<double>::quiet_NaN();
      if (count == 0) continue;
      std::nth_element(near.begin(), near.begin() + count / 2, near.begin() + count);
      median = near[std::size_t(count / 2)];
    }
  return out;
}

std::vector<double> faces_of(const Volume& ct, const Fan& fan,
                             std::span<const EnvelopeMark> marks) {
  Costs costs(column(fan.rows(), 0));
  const double width_m = std::max(kFaceWidth_m, 0.8 * ct.geometry.spacing_m.maxCoeff());
  tbb::parallel_for(0, fan.rows(), [&](int row) {
    for (int turn = 0; turn < Fan::kRays; ++turn) {
      float* cost = &costs[column(row, turn)];
      ray_costs(ct, fan.foot(row), fan.direction(row, turn), width_m, cost);
      heed_marks(marks, fan.foot(row), fan.direction(row, turn), cost);
    }
  });
  const Costs sums = path_sums(costs, fan.rows());
  std::vector<double> out;
  for (std::size_t at = 0; at < sums.size(); at += std::size_t(kRadial)) {
    const auto first = sums.begin() + std::ptrdiff_t(at);
    out.push_back(double(std::min_element(first, first + kRadial) - first) * kRadialStep_m);
  }
  return smoothed(out, fan.rows());
}

CortexProfile profile_of(const Volume& ct, const Fan& fan, int row, int turn, double face_m) {
  CortexProfile out{
      .from_m = std::max(kProfileFrom_m, -face_m), .step_m = kRadialStep_m, .values = {}};
  if (face_m >= kNoFace_m) return out;
  for (double x = out.from_m; x <= kProfileTo_m + 1e-9; x += out.step_m)
    out.values.push_back(ct.value_at(fan.foot(row) + (face_m + x) * fan.direction(row, turn)));
  return out;
}

/// The cortex's thickness on each ray; where the model fits none, its neighbours' or kCortex_m.
std::vector<double> cortices_of(const Volume& ct, const Fan& fan,
                                const std::vector<double>& face_m) {
  std::vector<CortexProfile> profiles(face_m.size()), some;
  tbb::parallel_for(0, int(face_m.size()), [&](int ray) {
    profiles[std::size_t(ray)] =
        profile_of(ct, fan, ray / Fan::kRays, ray % Fan::kRays, face_m[std::size_t(ray)]);
  });
  for (std::size_t ray = kBlurFrom - 1; ray < profiles.size(); ray += kBlurFrom)
    if (fan.beside(int(ray) / Fan::kRays) && !profiles[ray].values.empty())
      some.push_back(profiles[ray]);
  std::vector<double> out(face_m.size(), std::numeric_limits<double>::quiet_NaN());
  const auto scan = cortex_scan_of(some);
  if (scan)
    tbb::parallel_for(std::size_t(0), out.size(), [&](std::size_t ray) {
      if (const auto fit = fit_cortex(profiles[ray], *scan))
        out[ray] = std::max(kThinnestCortex_m, fit->thickness_m);
    });
  out = smoothed(out, fan.rows());
  std::ranges::replace_if(
      out, [](double x) { return std::isnan(x); }, Envelope::kCortex_m);
  return out;
}

core::Result<void> check_slices(const Volume& ct) {
  const double coarsest_m = ct.geometry.spacing_m.maxCoeff();
  if (coarsest_m <= kThickestSlice_m) return {};
  return refusal(
      fmt::format("the CT's slices are {:.1f} mm thick: the vertebra's outer face is "
                  "found in slices of at most {:.1f} mm",
                  coarsest_m * 1e3, kThickestSlice_m * 1e3));
}

}  // namespace

core::Result<std::unique_ptr<Envelope>> envelope_about(const Volume& ct, const Tract& tract,
                                                       std::span<const EnvelopeMark> marks) {
  TRY(check_slices(ct));
  const Fan fan(tract);
  TRY(check_metal(ct, fan));
  auto face_m = faces_of(ct, fan, marks);
  PerRay cortex_m(fan.rows(), cortices_of(ct, fan, face_m));
  auto found = std::make_unique<FoundEnvelope>(fan, PerRay(fan.rows(), std::move(face_m)),
                                               std::move(cortex_m), ct.geometry.spacing_m.mean());
  TRY(check_ring(ct, fan, *found));
  TRY(check_leak(fan, *found));
  return std::unique_ptr<Envelope>(std::move(found));
}

core::Result<OuterFace> outer_face_about(const Volume& ct, const Tract& tract,
                                         std::span<const EnvelopeMark> marks) {
  TRY(check_slices(ct));
  const Fan fan(tract);
  return outer_face_of(fan, PerRay(fan.rows(), faces_of(ct, fan, marks)));
}

core::Result<std::unique_ptr<Envelope>> envelope_of_labels(const Volume& labels, int label) {
  Volume inside{.geometry = labels.geometry, .slope = 1.0, .intercept = 0.0, .counts = {}};
  inside.counts.reserve(labels.counts.size());
  for (const std::uint16_t count : labels.counts)
    inside.counts.push_back(std::lround(labels.intercept + labels.slope * count) == label);
  if (std::ranges::count(inside.counts, 1) == 0)
    return refusal(fmt::format("no voxel of the label map carries the label {}", label));
  return std::unique_ptr<Envelope>(std::make_unique<LabelEnvelope>(std::move(inside)));
}

}  // namespace volume
}  // namespace tractus
