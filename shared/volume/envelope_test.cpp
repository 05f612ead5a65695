#include "volume/envelope.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace tractus {
namespace volume {
namespace {

using testing::HasSubstr;
using Scene = std::function<double(const Vec3&)>;

constexpr double kPedicle_mm = 6.0;  // outer radius, along y from −20 to 20; the canal is at x < −6
constexpr double kBody_mm = 16.0;  // a ball about (0, −30, 0) that the pedicle runs into

bool within(const Vec3& p_mm, double thinner_mm) {
  const bool pedicle =
      std::hypot(p_mm.x(), p_mm.z()) < kPedicle_mm - thinner_mm && p_mm.y() > -30 && p_mm.y() < 20;
  return pedicle || (p_mm - Vec3(0, -30, 0)).norm() < kBody_mm - thinner_mm;
}

/// A pedicle and a body: 1.2 mm of cortex about marrow that measures as the soft tissue outside.
double soft_bone(const Vec3& p_m) {
  const Vec3 p = p_m * 1e3;
  if (within(p, 1.2)) return 60.0;
  return within(p, 0.0) ? 700.0 : 50.0;
}

/// Drawn in voxels of 1 mm, each the mean of 27 parts, with noise of 15 HU.
Volume drawn_soft(const Scene& scene, double slice_mm = 1.0) {
  const Vec3 spacing(0.001, 0.001, slice_mm * 1e-3);
  Volume v{.geometry = {{60, 90, int(60 / slice_mm)},
                        spacing,
                        Vec3(-0.030, -0.055, -0.030),
                        Mat3::Identity()},
           .slope = 1,
           .intercept = -1024,
           .counts = {}};
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 15.0);
  for (int k = 0; k < v.geometry.dims[2]; ++k)
    for (int j = 0; j < v.geometry.dims[1]; ++j)
      for (int i = 0; i < v.geometry.dims[0]; ++i) {
        double sum = 0.0;
        for (int part = 0; part < 27; ++part)
          sum += scene(v.geometry.position_of(
              Vec3(i, j, k) + Vec3(part % 3 - 1, part / 3 % 3 - 1, part / 9 - 1) / 3.0));
        v.counts.push_back(v.count_of(sum / 27.0 + noise(random)));
      }
  return v;
}

Tract soft_tract() {
  return {.entry_m = Vec3(0, 0.018, 0),
          .axis = -Vec3::UnitY(),
          .length_m = 0.050,
          .radius_m = 0.0015,
          .medial = -Vec3::UnitX(),
          .superior = Vec3::UnitZ()};
}

TEST(EnvelopeAbout, FindsTheOuterFaceWhereMarrowMeasuresAsSoftTissue) {
  const auto envelope = envelope_about(drawn_soft(soft_bone), soft_tract());
  ASSERT_TRUE(envelope) << envelope.error().what;
  const auto face_mm = [&](const Vec3& from_mm, const Vec3& along) {
    double r = 0.0;
    while (r < 25.0 && (*envelope)->share((from_mm + r * along) * 1e-3) > 0.5) r += 0.05;
    return r;
  };
  for (const Vec3& along : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    for (const double y : {10.0, 4.0, -4.0})
      EXPECT_NEAR(face_mm(Vec3(0, y, 0), along), kPedicle_mm, 0.8) << y;
    EXPECT_NEAR(face_mm(Vec3(0, -30, 0), along), kBody_mm, 0.8);
  }
  EXPECT_NEAR(face_mm(Vec3(0, -32, 0), -Vec3::UnitY()), kBody_mm - 2.0, 0.8);  // the front
}

TEST(EnvelopeAbout, SaysWhatItCannotBeFoundIn) {
  const auto why = [](const Volume& ct, const Tract& tract) {
    const auto found = envelope_about(ct, tract);
    return found ? std::string("found") : found.error().what;
  };
  EXPECT_THAT(why(drawn_soft(soft_bone, 5.0), soft_tract()), HasSubstr("slices are 5.0 mm thick"));
  const auto screw = [](const Vec3& p) {
    return std::hypot(p.x() - 0.003, p.z()) < 0.002 ? 3000.0 : soft_bone(p);
  };
  EXPECT_THAT(why(drawn_soft(screw), soft_tract()), HasSubstr("metal"));
  const auto dye = [](const Vec3& p) {
    return p.x() < -0.0065 && soft_bone(p) == 50.0 ? 320.0 : soft_bone(p);
  };
  EXPECT_THAT(why(drawn_soft(dye), soft_tract()), HasSubstr("spinal canal"));
  Tract beside = soft_tract();
  beside.entry_m.x() = 0.020;
  EXPECT_THAT(why(drawn_soft(soft_bone), beside), HasSubstr("no closed ring"));
}

/// Bone that goes on from the body: as a rib to lateral, as a fused neighbour to superior.
TEST(EnvelopeAbout, RefusesBoneThatGoesOnBeyondTheVertebra) {
  const auto why = [](const Scene& scene) {
    const auto found = envelope_about(drawn_soft(scene), soft_tract());
    return found ? std::string("found") : found.error().what;
  };
  const auto joined = [](const Vec3& p_m, const Vec3& along) {
    const Vec3 p = p_m * 1e3 - Vec3(0, -30, 0);
    const double far = p.dot(along), off = (p - far * along).norm();
    if (far < 0.0 || off > 14.0) return soft_bone(p_m);
    return off > 12.8 ? 700.0 : 60.0;
  };
  EXPECT_THAT(why([&](const Vec3& p) { return joined(p, Vec3::UnitX()); }),
              HasSubstr("to lateral"));
  EXPECT_THAT(why([&](const Vec3& p) { return joined(p, Vec3::UnitZ()); }),
              HasSubstr("to superior"));
}

/// The same rib, of which a person says that it is none of this vertebra.
TEST(EnvelopeAbout, IsMendedByMarks) {
  const auto rib = [](const Vec3& p_m) {
    const Vec3 p = p_m * 1e3 - Vec3(0, -30, 0);
    const double off = std::hypot(p.y(), p.z());
    if (p.x() < 0.0 || off > 14.0) return soft_bone(p_m);
    return off > 12.8 ? 700.0 : 60.0;
  };
  const Volume ct = drawn_soft(rib);
  EXPECT_FALSE(envelope_about(ct, soft_tract()));
  std::vector<EnvelopeMark> marks;
  for (const double y : {-40.0, -34.0, -28.0, -22.0})
    for (const double z : {-12.0, -6.0, 0.0, 6.0, 12.0})
      marks.push_back({Vec3(21.0, y, z) * 1e-3, 0.005, false});
  const auto mended = envelope_about(ct, soft_tract(), marks);
  ASSERT_TRUE(mended) << mended.error().what;
  EXPECT_LT((*mended)->inside_m(Vec3(0.018, -0.030, 0.0)), 0.0);
  EXPECT_GT((*mended)->inside_m(Vec3(0.012, -0.030, 0.0)), 0.0);
  EXPECT_GT((*mended)->inside_m(Vec3(-0.014, -0.030, 0.0)), 0.0);  // the other side, as before
}

TEST(EnvelopeAbout, TakesInWhatIsMarkedAsBone) {
  const auto ct = drawn_soft(soft_bone);
  const Vec3 beyond(0.009, 0.004, 0.0);  // 3 mm outside the pedicle's face
  const std::vector<EnvelopeMark> marks{{beyond, 0.003, true}};
  EXPECT_LT((*envelope_about(ct, soft_tract()))->inside_m(beyond), 0.0);
  EXPECT_GT((*envelope_about(ct, soft_tract(), marks))->inside_m(beyond), 0.0);
}

/// Cortex of several thicknesses, drawn in voxels of 1 mm: what blurs it is the voxel itself and what
/// reads between voxels, of which the model knows nothing.
TEST(EnvelopeAbout, IsNotMovedByMarksThatNoRayMeets) {
  const auto ct = drawn_soft(soft_bone);
  const auto plain = envelope_about(ct, soft_tract());
  for (const double far : {0.05, 1.0, 1e9, 1e300}) {
    const std::vector<EnvelopeMark> marks{{Vec3(far, 0.0, 0.0), 0.003, true},
                                          {Vec3(far, far, 0.0), 0.003, false}};
    const auto marked = envelope_about(ct, soft_tract(), marks);
    ASSERT_TRUE(marked) << marked.error().what;
    for (const Vec3& p :
         {Vec3(0.004, 0.0, 0.002), Vec3(0.008, -0.02, 0.0), Vec3(-0.003, 0.01, 0.0)})
      EXPECT_EQ((*marked)->inside_m(p), (*plain)->inside_m(p)) << far;
  }
}

TEST(EnvelopeAbout, MeasuresTheCortexOfADrawnVertebra) {
  for (const double thickness_mm : {0.6, 1.2, 2.0}) {
    const auto scene = [&](const Vec3& p_m) {
      const Vec3 p = p_m * 1e3;
      if (within(p, thickness_mm)) return 60.0;
      return within(p, 0.0) ? 1200.0 : 50.0;
    };
    const auto envelope = envelope_about(drawn_soft(scene), soft_tract());
    ASSERT_TRUE(envelope) << envelope.error().what;
    double sum = 0.0, worst = 0.0;
    int places = 0;
    for (double y = -8.0; y <= 10.0; y += 1.0)
      for (double angle = 0.0; angle < 6.28; angle += 0.2) {
        const Vec3 p = Vec3(3.0 * std::cos(angle), y, 3.0 * std::sin(angle)) * 1e-3;
        const double off = (*envelope)->depth(p).cortex_m * 1e3 - thickness_mm;
        sum += off, worst = std::max(worst, std::abs(off)), ++places;
      }
    EXPECT_NEAR(sum / places, 0.0, 0.2) << thickness_mm;
    EXPECT_LT(worst, 0.7) << thickness_mm;
  }
}

TEST(OuterFaceAbout, ShowsTheFaceAlsoWhereItIsRefused) {
  const auto face = outer_face_about(drawn_soft(soft_bone), soft_tract());
  ASSERT_TRUE(face);
  ASSERT_GT(face->around, 8);
  EXPECT_EQ(face->points_m.size() % std::size_t(face->around), 0u);
  int beside_pedicle = 0;
  for (const Vec3& p : face->points_m) {
    if (std::abs(p.y()) > 0.008) continue;
    EXPECT_NEAR(std::hypot(p.x(), p.z()) * 1e3, kPedicle_mm, 1.0) << p.transpose();
    ++beside_pedicle;
  }
  EXPECT_GT(beside_pedicle, 10 * face->around);
  for (int turn = 0; turn < face->around; ++turn)
    EXPECT_NEAR((face->points_m[std::size_t(turn)] - face->points_m.front()).norm(), 0.0, 1e-9);
  Tract beside = soft_tract();
  beside.entry_m.x() = 0.020;
  EXPECT_TRUE(outer_face_about(drawn_soft(soft_bone), beside));
  EXPECT_FALSE(outer_face_about(drawn_soft(soft_bone, 5.0), soft_tract()));
}

TEST(EnvelopeOfLabels, IsTheLabelsVoxels) {
  Volume labels{.geometry = {{4, 4, 4}, Vec3::Constant(0.001), Vec3::Zero(), Mat3::Identity()},
                .slope = 1,
                .intercept = 0,
                .counts = std::vector<std::uint16_t>(64, 21)};
  labels.counts[labels.offset(1, 1, 1)] = labels.counts[labels.offset(2, 1, 1)] = 22;
  const auto envelope = envelope_of_labels(labels, 22);
  ASSERT_TRUE(envelope);
  EXPECT_EQ((*envelope)->share(Vec3(0.0015, 0.001, 0.001)), 1.0);
  EXPECT_NEAR((*envelope)->share(Vec3(0.001, 0.0015, 0.001)), 0.5, 1e-9);
  EXPECT_EQ((*envelope)->share(Vec3(0.003, 0.003, 0.003)), 0.0);
  EXPECT_EQ((*envelope)->share(Vec3(0.1, 0.0, 0.0)), 0.0);
  EXPECT_EQ((*envelope)->depth(Vec3(0.001, 0.001, 0.001)).cortex_m, Envelope::kCortex_m);
  EXPECT_FALSE(envelope_of_labels(labels, 5));
}

}  // namespace
}  // namespace volume
}  // namespace tractus
