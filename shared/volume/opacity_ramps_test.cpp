#include "volume/opacity_ramps.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace tractus {
namespace volume {
namespace {

struct Calibration {
  double slope, intercept;
};

/// Every count there is, against the transfer function in double precision.
double worst_difference(const std::vector<TransferFunction::Point>& points,
                        const Calibration& calibration) {
  const auto transfer = TransferFunction::make(points);
  EXPECT_TRUE(transfer);
  const OpacityRamps ramps(*transfer, calibration.slope, calibration.intercept);
  std::vector<std::uint16_t> counts(65536);
  for (std::size_t c = 0; c < counts.size(); ++c) counts[c] = std::uint16_t(c);
  std::vector<float> got(counts.size());
  ramps.opacities(counts.data() + 1, 65535, got.data() + 1);  // an odd start and an odd number
  got[0] = ramps.opacity(0);
  double worst = 0.0;
  for (std::size_t c = 0; c < counts.size(); ++c)
    worst = std::max(
        worst, std::abs(double(got[c]) -
                        transfer->opacity(calibration.intercept + calibration.slope * double(c))));
  return worst;
}

TEST(OpacityRamps, EqualTheTransferFunctionAtEveryCount) {
  EXPECT_LE(worst_difference({{150, 0}, {700, 1}}, {1.0, -1024.0}), 3e-7);
  EXPECT_LE(
      worst_difference({{-500, 0.3}, {150, 0}, {300, 0.9}, {700, 0.4}, {2000, 1}}, {0.37, -1024.3}),
      3e-7);
  EXPECT_LE(worst_difference({{150, 0.2}, {700, 1}}, {-0.1, 3000.0}), 3e-7)
      << "counts that fall as CT values rise";
  EXPECT_LE(worst_difference({{60000.25, 0}, {60001.5, 1}}, {1.0, 0.0}), 3e-7)
      << "steep and far out";
  EXPECT_LE(worst_difference({{-1e9, 0}, {1e9, 1}}, {1.0, 0.0}), 3e-7) << "wider than counts reach";
  EXPECT_LE(worst_difference({{-1e300, 0}, {-1e299, 0.5}, {1e299, 1}}, {1.0, 0.0}), 3e-7);
  EXPECT_LE(worst_difference({{150, 0.2}, {700, 0.6}}, {0.0, 425.0}), 3e-7)
      << "a volume of one value";
}

}  // namespace
}  // namespace volume
}  // namespace tractus
