/// A recording whose positions are off by a constant: a translation in the volume's frame, added to
/// every recorded position. It mends a comparison and is never rendered.
#include "effects/palpation_effect.hpp"

namespace tractus {
namespace effects {
namespace {

class PoseOffset final : public PosePlacement {
 public:
  explicit PoseOffset(const Vec3& offset_m) : offset_m_(offset_m) {}
  void place(math::Pose& X_VH) const noexcept override { X_VH.p += offset_m_; }

 private:
  Vec3 offset_m_;
};

}  // namespace

namespace palpation {
PalpationEffectInfo pose_offset() {
  return {
      .facts = {.id = "pose_offset",
                .label = "pose offset",
                .kind = Kind::measurement,
                .summary = "Recorded positions that are off by a constant in the volume's frame",
                .equation = "p = recorded p + offset",
                .source = "[Zoller2020, \"Parameter tuning\"]",
                .experiment = "presses into opposite walls in three directions, with two rolls",
                .params = {{.name = "offset_m",
                            .meaning = "added to recorded positions, x y z of V",
                            .initial = 0.0,
                            .low = -0.02,
                            .high = 0.02,
                            .components = 3,
                            .step = 2e-5}},
                .starts = {{1e-5, 1e-5, 1e-5}}},
      .make = [](std::span<const double> values) -> PalpationEffect {
        return std::make_unique<PoseOffset>(Vec3(values[0], values[1], values[2]));
      }};
}
}  // namespace palpation

}  // namespace effects
}  // namespace tractus
