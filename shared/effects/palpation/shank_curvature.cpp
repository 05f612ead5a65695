/// A shank that is bent already when nothing pushes on it: off ẑ by b (z/L)² in a direction of the
/// handle's frame. Its points lie there and bend further from there; forces turn about the handle
/// with the lever of where they are.
#include <cmath>

#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

class ShankCurvature final : public ShankForm {
 public:
  ShankCurvature(double bow_m, double direction_rad)
      : bow_m_(bow_m * std::cos(direction_rad), bow_m * std::sin(direction_rad)) {}

  void form(laws::Shank& shank) const noexcept override {
    for (std::size_t i = 0; i < std::size_t(shank.points); ++i) {
      const double along = shank.z_m[i] / shank.length_m;
      shank.rest_m[i] += along * along * bow_m_;
    }
    shank.straight = false;
  }

 private:
  math::Vec2 bow_m_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo shank_curvature() {
  return {.facts = {.id = "shank_curvature",
                    .label = "shank curvature",
                    .kind = Kind::structure,
                    .summary = "A shank that is bowed before anything pushes on it",
                    .equation = "x, y of the unloaded shank = b (z/L)² (cos β, sin β) in H",
                    .source = "own",
                    .experiment = "the same sideways press at four rolls of the handle, 90° apart",
                    .params = {{.name = "bow_m",
                                .meaning = "how far the unloaded tip lies off the handle's axis, b",
                                .initial = 5e-4,
                                .low = 0.0,
                                .high = 0.02,
                                .step = 2e-5},
                               {.name = "direction_rad",
                                .meaning = "where to, from x of the handle's frame towards y, β",
                                .initial = 0.0,
                                .low = -2.0 * M_PI,
                                .high = 2.0 * M_PI,
                                .off = kNoOff,
                                .step = 5e-2}},
                    .starts = {{3e-4, 0.0}, {3e-4, M_PI_2}, {3e-4, -M_PI_2}, {3e-4, M_PI}}},
          .make = [](std::span<const double> values) -> PalpationEffect {
            return std::make_unique<ShankCurvature>(values[0], values[1]);
          }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
