/// What the tests of DICOM share: phantoms, and how what was read is held against them.
#pragma once

#include <gtest/gtest.h>

#include "volume/io/read_volume.hpp"

namespace tractus::volume_io::testing {
using volume::Vec3;
using volume::Volume;

/// Simulated: a slanted gradient with a bright ball, 24 × 20 × 6, oblique; counts 0 … about 3000,
/// HU = count − 1024.
inline Volume phantom() {
  Volume v;
  v.geometry.dims = {24, 20, 6};
  v.geometry.spacing_m = {0.7e-3, 0.8e-3, 2e-3};
  v.geometry.origin_m = {-0.1, 0.05, 0.3};
  v.geometry.directions = Eigen::AngleAxisd(0.2, Vec3(1, 1, 0).normalized()).toRotationMatrix();
  v.intercept = -1024.0;
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 24; ++i) {
        const bool ball = (i - 12) * (i - 12) + (j - 8) * (j - 8) + 4 * (k - 3) * (k - 3) < 30;
        v.counts.push_back(
            static_cast<std::uint16_t>(11 * i + 7 * j + 131 * k + (ball ? 2000 : 0)));
      }
  return v;
}

/// Simulated: the first 4 slices of the phantom, 5 mm thick.
inline Volume thick() {
  Volume v = phantom();
  v.geometry.dims[2] = 4;
  v.geometry.spacing_m.z() = 5e-3;
  v.counts.resize(v.geometry.voxel_count());
  return v;
}

inline void expect_same(const core::Result<Imported>& in, const Volume& v) {
  ASSERT_TRUE(in) << in.error().what;
  const auto &got = in->volume.geometry, &want = v.geometry;
  ASSERT_EQ(got.dims, want.dims);
  EXPECT_LT((got.spacing_m - want.spacing_m).norm(), 1e-9);
  EXPECT_LT((got.origin_m - want.origin_m).norm(), 1e-8);
  EXPECT_LT((got.directions - want.directions).norm(), 1e-6);
  for (int k = 0; k < want.dims[2]; ++k)
    for (int j = 0; j < want.dims[1]; ++j)
      for (int i = 0; i < want.dims[0]; ++i)
        ASSERT_EQ(in->volume.value(i, j, k), v.value(i, j, k)) << i << ' ' << j << ' ' << k;
}

inline void expect_word(const std::string& message, const std::string& word) {
  EXPECT_NE(message.find(word), std::string::npos) << message;
}

}  // namespace tractus::volume_io::testing
