#include "server/api/cases/preview.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace api {
namespace {

TEST(Preview, AveragesBlocksAndPlacesTheirCentres) {
  volume::Volume box;
  box.geometry.dims = {3, 2, 1};
  box.geometry.spacing_m = {0.001, 0.002, 0.003};
  box.geometry.origin_m = {1.0, 2.0, 3.0};
  box.counts.assign(6, 0);
  // By hand: the first block holds all of 1, 0, 0, 1 (mean ½ → 128), the second the last column, 1
  // and 0.5 (191.25 → 191).
  const Preview preview = averaged(box, {1, 0, 1, 0, 1, 0.5F}, 2);
  EXPECT_EQ(preview.geometry.dims, (std::array<int, 3>{2, 1, 1}));
  ASSERT_EQ(preview.opacity.size(), 2u);
  EXPECT_EQ(static_cast<unsigned char>(preview.opacity[0]), 128);
  EXPECT_EQ(static_cast<unsigned char>(preview.opacity[1]), 191);
  EXPECT_TRUE(preview.geometry.spacing_m.isApprox(volume::Vec3(0.002, 0.004, 0.006)));
  EXPECT_TRUE(preview.geometry.origin_m.isApprox(volume::Vec3(1.0005, 2.001, 3.0015)));
}

}  // namespace
}  // namespace api
}  // namespace tractus
