/// A probe that ends in a ball: the tip's force is the mean of the force over the ball.
///
///     F = 1/V ∫ F(p + x) d³x over |x| ≤ R
///
/// by the product of Gauss' rule in the radius (weight r²; the mean over a sphere is even in r) and
/// a Lebedev rule on the sphere: three radii of 50 points, exact where the field is a polynomial of
/// degree 11 in x, for a ball of a few voxels of a clinical CT two radii of 26 points, exact to
/// degree 7, and for one of about a voxel the centre and the corners of an icosahedron, exact to
/// degree 5 [Stroud1971, S3: 5]. (The field was blurred by a voxel: of what varies fastest in it,
/// as exp(i x/voxel), the last misses 10⁻⁴ at a radius of 1.5 voxels.)
#include <array>
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

/// Positive nodes and weights of Gauss–Legendre's seven and five points; with 3 x² they integrate
/// over the radius.
constexpr std::array<std::array<double, 2>, 3> kSeven{{{0.9491079123427585, 0.1294849661688697},
                                                       {0.7415311855993945, 0.2797053914892766},
                                                       {0.4058451513773972, 0.3818300505051189}}};
constexpr std::array<std::array<double, 2>, 2> kFive{
    {{0.9061798459386640, 0.2369268850561891}, {0.5384693101056831, 0.4786286704993665}}};
constexpr double kSmall_m = 1e-3, kSmallest_m = 7e-4;

/// Weights of a rule on the sphere with the symmetry of the cube: of its faces, edges and corners,
/// and of the 24 points (l, l, m), l = 1/√11, m = 3/√11.
struct OnSphere {
  double face, edge, corner, other;
};
constexpr OnSphere kDegree11{4.0 / 315.0, 64.0 / 2835.0, 27.0 / 1280.0, 14641.0 / 725760.0};
constexpr OnSphere kDegree7{1.0 / 21.0, 4.0 / 105.0, 9.0 / 280.0, 0.0};

class TipBall final : public TipSpread {
 public:
  explicit TipBall(double radius_m) : radius_m_(radius_m) {
    if (radius_m <= kSmallest_m)
      fill_icosahedron();
    else if (radius_m > kSmall_m)
      fill(kSeven, kDegree11);
    else
      fill(kFive, kDegree7);
  }

  std::span<const Node> nodes() const noexcept override { return std::span(nodes_).first(count_); }

 private:
  void fill(std::span<const std::array<double, 2>> radii, const OnSphere& rule) {
    const double e = std::sqrt(0.5), c = std::sqrt(1.0 / 3.0), l = std::sqrt(1.0 / 11.0),
                 m = 3.0 * l;
    for (const auto& [node, gauss] : radii) {
      const double r = radius_m_ * node, share = 3.0 * node * node * gauss;
      const auto add = [&](double x, double y, double z, double weight) {
        if (weight > 0.0) nodes_[count_++] = {r * Vec3(x, y, z), share * weight};
      };
      for (const double a : {-1.0, 1.0}) {
        add(a, 0, 0, rule.face), add(0, a, 0, rule.face), add(0, 0, a, rule.face);
        for (const double b : {-1.0, 1.0}) {
          add(a * e, b * e, 0, rule.edge), add(a * e, 0, b * e, rule.edge);
          add(0, a * e, b * e, rule.edge);
          for (const double d : {-1.0, 1.0}) {
            add(a * c, b * c, d * c, rule.corner), add(a * l, b * l, d * m, rule.other);
            add(a * l, b * m, d * l, rule.other), add(a * m, b * l, d * l, rule.other);
          }
        }
      }
    }
  }

  void fill_icosahedron() {
    const double golden = 0.5 * (1.0 + std::sqrt(5.0)), r = radius_m_ * std::sqrt(5.0 / 7.0);
    const double a = r / std::sqrt(1.0 + golden * golden), b = a * golden;
    nodes_[count_++] = {Vec3::Zero(), 4.0 / 25.0};
    for (const double s : {-a, a})
      for (const double t : {-b, b})
        for (const Vec3& corner : {Vec3(0, s, t), Vec3(s, t, 0), Vec3(t, 0, s)})
          nodes_[count_++] = {corner, 7.0 / 100.0};
  }

  double radius_m_;
  std::size_t count_ = 0;
  std::array<Node, 150> nodes_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo tip_ball() {
  return {
      .facts = {.id = "tip_ball",
                .label = "tip ball",
                .kind = Kind::structure,
                .summary = "A ball at the tip: bone is felt over all of it",
                .equation = "the tip's force is the mean of c_f g over a ball",
                .source = "own; the ball tip that [Zoller2020, \"Discussion\"] leaves for later",
                .experiment =
                    "light touches of the end and of all walls, from free to just touching",
                .params = {{.name = "radius_m",
                            .meaning = "radius of the ball, R",
                            .initial = 7e-4,
                            .low = 0.0,
                            .high = 4e-3,
                            .step = 3e-5}},
                .starts = {{5e-4}}},
      .make = [](std::span<const double> values) -> PalpationEffect {
        return std::make_unique<TipBall>(values[0]);
      }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
