/// A probe that ends in a ball: the tip's force is the mean of the force over the ball.
///
///     F = 1/V ∫ F(p + x) d³x over |x| ≤ R
///
/// by the product of Gauss' rule in the radius (weight r², three nodes; the mean over a sphere is
/// even in r) and Lebedev's rule of 50 points on the sphere (the octahedral rule of degree 11):
/// exact where the field is a polynomial of degree 11 in x.
#include <array>
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace effects {
namespace {

/// Positive nodes and weights of seven points; with 3 x² they integrate over the radius.
constexpr std::array<std::array<double, 2>, 3> kGauss{{{0.9491079123427585, 0.1294849661688697},
                                                       {0.7415311855993945, 0.2797053914892766},
                                                       {0.4058451513773972, 0.3818300505051189}}};

constexpr int kOnSphere = 50, kNodes = 3 * kOnSphere;

class TipBall final : public TipSpread {
 public:
  explicit TipBall(double radius_m) {
    std::size_t next = 0;
    const auto add = [&](double x, double y, double z, double weight) {
      for (const auto& [node, gauss] : kGauss) {
        const Vec3 offset_m = radius_m * node * Vec3(x, y, z);
        nodes_[next++] = {offset_m, 3.0 * node * node * gauss * weight};
      }
    };
    const double edge = std::sqrt(0.5), corner = std::sqrt(1.0 / 3.0);
    const double l = std::sqrt(1.0 / 11.0), m = 3.0 * l;
    constexpr double kFace = 4.0 / 315.0, kEdge = 64.0 / 2835.0, kCorner = 27.0 / 1280.0,
                     kOther = 14641.0 / 725760.0;
    for (const double a : {-1.0, 1.0}) {
      add(a, 0, 0, kFace), add(0, a, 0, kFace), add(0, 0, a, kFace);
      for (const double b : {-1.0, 1.0}) {
        add(a * edge, b * edge, 0, kEdge), add(a * edge, 0, b * edge, kEdge);
        add(0, a * edge, b * edge, kEdge);
        for (const double c : {-1.0, 1.0}) {
          add(a * corner, b * corner, c * corner, kCorner);
          add(a * l, b * l, c * m, kOther), add(a * l, b * m, c * l, kOther);
          add(a * m, b * l, c * l, kOther);
        }
      }
    }
  }

  std::span<const Node> nodes() const noexcept override { return nodes_; }

 private:
  std::array<Node, kNodes> nodes_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo tip_ball() {
  return {
      .facts = {.id = "tip_ball",
                .kind = Kind::structure,
                .summary = "A ball at the tip: bone is felt over all of it",
                .equation = "the tip's force is the mean of c_f g over a ball",
                .source = "own; the ball tip that [Zoller2020, \"Discussion\"] leaves for later",
                .params = {{.name = "radius_m",
                            .meaning = "radius of the ball, R",
                            .initial = 7e-4,
                            .low = 0.0,
                            .high = 4e-3}}},
      .make = [](std::span<const double> values) -> PalpationEffect {
        return std::make_unique<TipBall>(values[0]);
      }};
}
}  // namespace palpation

}  // namespace effects
