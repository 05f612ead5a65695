#include "volume/calibration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tractus {
namespace volume {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A scan of 80 by 80 by 40 mm: air about a round of soft tissue with a rim of fat, and within it
/// a rod of bone, 8 mm of marrow (180 HU) in 2 mm of cortex. Noise of 10 HU.
struct DrawnScan {
  double cortex = 1100.0, agent = NAN, metal = NAN, slice_mm = 1.0, shift = 0.0;

  double at(double x_mm, double y_mm) const {
    const double r = std::hypot(x_mm, y_mm), vessel = std::hypot(x_mm - 20, y_mm);
    if (r < 8.0) return 180.0;
    if (r < 10.0) return cortex;
    if (vessel < 6.0 && !std::isnan(agent)) return agent;
    if (std::hypot(x_mm + 20, y_mm) < 2.0 && !std::isnan(metal)) return metal;
    return r < 30.0 ? 50.0 : r < 35.0 ? -100.0 : -1000.0;
  }
  Volume drawn() const {
    Volume v{.geometry = {{80, 80, int(40 / slice_mm)},
                          Vec3(0.001, 0.001, slice_mm * 1e-3),
                          Vec3(-0.040, -0.040, 0.0),
                          Mat3::Identity()},
             .slope = 1,
             .intercept = -4096,
             .counts = {}};
    std::mt19937 random(3);
    std::normal_distribution<double> noise(shift, 10.0);
    for (int k = 0; k < v.geometry.dims[2]; ++k)
      for (int j = 0; j < 80; ++j)
        for (int i = 0; i < 80; ++i) {
          const double value = at(i - 40, j - 40);
          v.counts.push_back(v.count_of(value + noise(random)));
        }
    return v;
  }
};

Calibration of_scan(const DrawnScan& scan) {
  const auto v = scan.drawn();
  return calibrate(histogram_of(v), v.geometry);
}

TEST(Calibrate, FindsThePeaksThatWereDrawn) {
  const auto found = of_scan({});
  EXPECT_NEAR(found.air.value_or(0), -1000.0, 12.0);
  EXPECT_NEAR(found.fat.value_or(0), -100.0, 12.0);
  EXPECT_NEAR(found.soft_tissue.value_or(0), 50.0, 12.0);
}

TEST(Calibrate, WarnsOfMetalContrastThickSlicesAndForeignValues) {
  EXPECT_THAT(of_scan({.metal = 3000.0}).warnings, Contains(HasSubstr("metal")));
  EXPECT_THAT(of_scan({.agent = 330.0}).warnings, Contains(HasSubstr("contrast agent")));
  EXPECT_THAT(of_scan({.slice_mm = 5.0}).warnings, Contains(HasSubstr("5.0 mm")));
  EXPECT_THAT(of_scan({.shift = 1024.0}).warnings, Contains(HasSubstr("may not be HU")));
  const auto plain = of_scan({}).warnings;
  EXPECT_THAT(plain, Not(Contains(HasSubstr("metal"))));
  EXPECT_THAT(plain, Not(Contains(HasSubstr("mm"))));
  EXPECT_THAT(plain, Not(Contains(HasSubstr("HU"))));
}

TEST(CalibratedTransfer, FollowsTheLineThroughTheScansPeaks) {
  // A scan that reads 0.95 of each value and 20 more: 150 → 162.5, 700 → 685, by hand.
  const Calibration off{.air = -930.0, .fat = -75.0, .soft_tissue = 67.5};
  const auto moved = calibrated(TransferFunction::bone(), off);
  ASSERT_TRUE(moved) << moved.error().what;
  ASSERT_EQ(moved->points().size(), 2u);
  EXPECT_NEAR(moved->points()[0].value, 162.5, 1e-9);
  EXPECT_NEAR(moved->points()[1].value, 685.0, 1e-9);
  EXPECT_EQ(moved->points()[1].opacity, 1.0);
  EXPECT_FALSE(calibrated(TransferFunction::bone(), Calibration{.air = -1000.0}));
  EXPECT_FALSE(
      calibrated(TransferFunction::bone(), Calibration{.fat = -160.0, .soft_tissue = 120.0}));
}

/// The rod's own outer face.
class RodEnvelope final : public Envelope {
 public:
  RodEnvelope() : Envelope(0.001) {}
  double inside_m(const Vec3& p) const noexcept override {
    return 0.010 - std::hypot(p.x(), p.y());
  }
};

TEST(Calibrate, MeasuresTheBoneAboutATract) {
  const Tract tract{.entry_m = Vec3(0, 0, 0.005), .length_m = 0.030};
  Calibration found;
  calibrate_bone(DrawnScan{}.drawn(), RodEnvelope(), tract, found);
  EXPECT_NEAR(found.cancellous.value_or(0), 180.0, 5.0);
  EXPECT_GT(found.cortical.value_or(0), 900.0);
  EXPECT_THAT(found.warnings, IsEmpty());
  calibrate_bone(DrawnScan{.cortex = 350.0}.drawn(), RodEnvelope(), tract, found);
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("soft kernel")));
}

}  // namespace
}  // namespace volume
}  // namespace tractus
