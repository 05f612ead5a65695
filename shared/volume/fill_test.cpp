#include "volume/fill.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace volume {
namespace {

/// All within 4 mm of the z axis, half a millimetre of transition.
class RoundEnvelope final : public Envelope {
 public:
  RoundEnvelope() : Envelope(0.0005) {}
  double inside_m(const Vec3& p) const noexcept override {
    return 0.004 - std::hypot(p.x(), p.y());
  }
};

Filling filling() { return *Filling::make(TransferFunction::bone()); }

TEST(Filling, GradesMarrowByDensityAndLeavesCortex) {
  // α = 0.8 + 0.2 v/700, v′ = 150 + 550 α, by hand.
  EXPECT_NEAR(filling().filled(80.0), 150.0 + 550.0 * (0.8 + 0.2 * 80.0 / 700.0), 1e-9);
  EXPECT_NEAR(filling().filled(-90.0), 590.0, 1e-9);  // fat: the least, 0.8
  EXPECT_NEAR(filling().filled(350.0), 645.0, 1e-9);
  EXPECT_NEAR(filling().filled(700.0), 700.0, 1e-9);
  EXPECT_EQ(filling().filled(1300.0), 1300.0);
}

TEST(Filling, ChangesNothingOutsideTheEnvelope) {
  Volume bone{.geometry = {{31, 31, 21},
                           Vec3::Constant(0.0005),
                           Vec3(-0.0075, -0.0075, 0.0),
                           Mat3::Identity()},
              .slope = 1.0,
              .intercept = -1024.0,
              .counts = std::vector<std::uint16_t>(31 * 31 * 21, 1024 + 80)};
  filling().fill(bone, RoundEnvelope(), {.entry_m = Vec3::Zero(), .length_m = 0.01});
  EXPECT_EQ(bone.value_at(Vec3(0.005, 0.0, 0.005)), 80.0);
  EXPECT_NEAR(bone.value_at(Vec3(0.002, 0.0, 0.005)), 602.57, 0.5);
  EXPECT_EQ(bone.value_at(Vec3(0.0035, 0.0, 0.005)), 700.0);  // cortex
  EXPECT_NEAR(bone.value_at(Vec3(0.0, 0.004, 0.005)), 80.0 + 0.5 * (700.0 - 80.0), 0.5);
}

TEST(Filling, RefusesATransferFunctionThatCannotBeFilled) {
  for (const auto& points : {std::vector<TransferFunction::Point>{{0, 0}, {100, 1}, {200, 0.5}},
                             std::vector<TransferFunction::Point>{{0, 0}, {100, 0.7}},
                             std::vector<TransferFunction::Point>{{-500, 0}, {-100, 1}}})
    EXPECT_FALSE(Filling::make(*TransferFunction::make(points)));
}

}  // namespace
}  // namespace volume
}  // namespace tractus
