#include "volume/envelope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/try.hpp"

namespace tractus {
namespace volume {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kAround = 32;             // rays about the axis
constexpr int kPolar = 10;              // rows of rays of each hemisphere
constexpr double kAlongStep_m = 0.001;  // between the rows of rays along the tract
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
constexpr double kMetal = 2500.0, kNearMetal_m = 0.006;     // cortex stays under 2000 HU
constexpr double kRing_m = 0.014;                           // faces of a pedicle lie within it
constexpr int kShortestRing = 4;                            // rows
constexpr double kCanal_m = 0.006, kContrastAgent = 150.0;  // beyond a medial face lies the canal

core::Error refusal(std::string why) { return {core::Errc::out_of_range, std::move(why)}; }

/// The fan of rays that leaves a tract: rows along it with a hemisphere at each end.
class Fan {
 public:
  explicit Fan(const Tract& tract)
      : tract_(tract), along_(1 + std::max(1, int(std::lround(tract.length_m / kAlongStep_m)))) {}

  int rows() const { return along_ + 2 * kPolar; }
  Vec3 foot(int row) const {
    const double share = std::clamp(double(row - kPolar) / (along_ - 1), 0.0, 1.0);
    return tract_.entry_m + share * tract_.length_m * tract_.axis;
  }
  Vec3 direction(int row, int turn) const {
    const double lift = lift_rad(row), angle = 2.0 * kPi * turn / kAround;
    const Vec3 out = std::cos(angle) * tract_.medial + std::sin(angle) * tract_.superior;
    return std::cos(lift) * out + std::sin(lift) * tract_.axis;
  }
  /// Row, turn (both continuous) and distance from the tract of a point.
  struct Place {
    double row, turn, distance_m;
  };
  Place place_of(const Vec3& p) const {
    const double depth = tract_.depth_of(p);
    const math::Vec2 off = tract_.offset_of(p);
    const double inside = std::clamp(depth, 0.0, tract_.length_m), over = depth - inside;
    const double lift = std::atan2(over, off.norm()) / (kPi / 2.0);  // −1 … 1
    const double row = kPolar + inside / tract_.length_m * (along_ - 1) + lift * kPolar;
    double turn = std::atan2(off.y(), off.x()) / (2.0 * kPi) * kAround;
    if (turn < 0.0) turn += kAround;
    return {row, turn, std::hypot(over, off.norm())};
  }
  bool beside(int row) const { return row >= kPolar && row < kPolar + along_; }
  double depth_m(int row) const { return double(row - kPolar) / (along_ - 1) * tract_.length_m; }

 private:
  double lift_rad(int row) const {
    const int over = row < kPolar ? row - kPolar : std::max(0, row - (kPolar + along_ - 1));
    return double(over) / kPolar * kPi / 2.0;
  }
  Tract tract_;
  int along_;
};

using Costs = std::vector<float>;  // [row][turn][radius]

std::size_t column(int row, int turn) {
  return (std::size_t(row) * kAround + std::size_t(turn)) * std::size_t(kRadial);
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
  Costs sums(costs.size(), 0.0f), scratch(kRadial);
  const auto run = [&](int steps, int quiet, const auto& place) {
    std::vector<float> before(kRadial, 0.0f);
    for (int k = 0; k < steps; ++k) {
      const std::size_t at = place(k);
      path_step(&costs[at], before, k < quiet ? scratch.data() : &sums[at]);
    }
  };
  for (int turn = 0; turn < kAround; ++turn) {
    run(rows, 0, [&](int k) { return column(k, turn); });
    run(rows, 0, [&](int k) { return column(rows - 1 - k, turn); });
  }
  for (int row = 0; row < rows; ++row) {
    run(2 * kAround, kAround, [&](int k) { return column(row, k % kAround); });
    run(2 * kAround, kAround, [&](int k) { return column(row, kAround - 1 - k % kAround); });
  }
  return sums;
}

class FoundEnvelope final : public Envelope {
 public:
  FoundEnvelope(const Fan& fan, std::vector<double> face_m, double voxel_m)
      : Envelope(voxel_m), fan_(fan), face_m_(std::move(face_m)) {}

  double inside_m(const Vec3& p) const noexcept override {
    const Fan::Place place = fan_.place_of(p);
    if (place.distance_m >= kReach_m) return -kReach_m;
    const int row = std::clamp(int(place.row), 0, fan_.rows() - 2), turn = int(place.turn);
    const double a = place.row - row, b = place.turn - turn;
    const double face = (1 - a) * ((1 - b) * at(row, turn) + b * at(row, turn + 1)) +
                        a * ((1 - b) * at(row + 1, turn) + b * at(row + 1, turn + 1));
    return face - place.distance_m;
  }
  double at(int row, int turn) const {
    return face_m_[std::size_t(row) * kAround + std::size_t(turn % kAround)];
  }

 private:
  Fan fan_;
  std::vector<double> face_m_;  // [row][turn]
};

/// Rows along the tract whose faces all lie as near as a pedicle's.
std::vector<int> ring_rows(const Fan& fan, const FoundEnvelope& envelope) {
  std::vector<int> out;
  for (int row = 0; row < fan.rows(); ++row) {
    double farthest_m = fan.beside(row) ? 0.0 : kRing_m;
    for (int turn = 0; turn < kAround; ++turn)
      farthest_m = std::max(farthest_m, envelope.at(row, turn));
    if (farthest_m < kRing_m) out.push_back(row);
  }
  return out;
}

core::Result<void> check_metal(const Volume& ct, const Fan& fan) {
  for (int row = 0; row < fan.rows(); ++row)
    for (int turn = 0; turn < kAround; turn += 4)
      for (double r = 0.0; r <= kNearMetal_m; r += kAlongStep_m)
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
        fmt::format("{:.0f} HU are measured in the spinal canal: a contrast agent there "
                    "cannot be told from bone; choose another CT, or give the envelope",
                    mean));
  return {};
}

/// A vertebra ends within reach to lateral, superior and inferior; a rib, a fused neighbour or the
/// facet of one goes on. To medial its body may be wider than that.
core::Result<void> check_leak(const Fan& fan, const FoundEnvelope& envelope) {
  for (const auto& [side, middle] :
       {std::pair("superior", kAround / 4), std::pair("lateral", kAround / 2),
        std::pair("inferior", 3 * kAround / 4)}) {
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

/// The median of each face and its eight neighbours.
std::vector<double> smoothed(const std::vector<double>& face, int rows) {
  std::vector<double> out(face.size());
  for (int row = 0; row < rows; ++row)
    for (int turn = 0; turn < kAround; ++turn) {
      std::array<double, 9> near{};
      for (int n = 0; n < 9; ++n) {
        const int r = std::clamp(row + n / 3 - 1, 0, rows - 1);
        const int t = (turn + n % 3 - 1 + kAround) % kAround;
        near[std::size_t(n)] = face[std::size_t(r) * kAround + std::size_t(t)];
      }
      std::ranges::nth_element(near, near.begin() + 4);
      out[std::size_t(row) * kAround + std::size_t(turn)] = near[4];
    }
  return out;
}

}  // namespace

core::Result<std::unique_ptr<Envelope>> envelope_about(const Volume& ct, const Tract& tract) {
  const double coarsest_m = ct.geometry.spacing_m.maxCoeff();
  if (coarsest_m > kThickestSlice_m)
    return refusal(
        fmt::format("the CT's slices are {:.1f} mm thick: the vertebra's outer face is "
                    "found in slices of at most {:.1f} mm",
                    coarsest_m * 1e3, kThickestSlice_m * 1e3));
  const Fan fan(tract);
  TRY(check_metal(ct, fan));
  Costs costs(column(fan.rows(), 0));
  const double width_m = std::max(kFaceWidth_m, 0.8 * coarsest_m);
  for (int row = 0; row < fan.rows(); ++row)
    for (int turn = 0; turn < kAround; ++turn)
      ray_costs(ct, fan.foot(row), fan.direction(row, turn), width_m, &costs[column(row, turn)]);
  const Costs sums = path_sums(costs, fan.rows());
  std::vector<double> face_m;
  for (std::size_t at = 0; at < sums.size(); at += std::size_t(kRadial)) {
    const auto first = sums.begin() + std::ptrdiff_t(at);
    face_m.push_back(double(std::min_element(first, first + kRadial) - first) * kRadialStep_m);
  }
  auto found = std::make_unique<FoundEnvelope>(fan, smoothed(face_m, fan.rows()),
                                               ct.geometry.spacing_m.mean());
  TRY(check_ring(ct, fan, *found));
  TRY(check_leak(fan, *found));
  return std::unique_ptr<Envelope>(std::move(found));
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
