/// A field of which a part alone is known, beside the whole.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "volume/force_field.hpp"

namespace tractus {
namespace volume {
namespace {

constexpr Box kPart{{5, 7, 9}, {25, 30, 28}};

/// Counts at random, oblique and off the origin.
Volume random_block() {
  Volume v;
  v.geometry.dims = {37, 41, 43};
  v.geometry.spacing_m = {0.4e-3, 0.5e-3, 0.45e-3};
  v.geometry.origin_m = {0.03, -0.05, 0.11};
  v.geometry.directions = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  v.intercept = -200;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> count(0, 1200);
  v.counts.resize(v.geometry.voxel_count());
  for (auto& c : v.counts) c = std::uint16_t(count(random));
  return v;
}

ForceField whole_field(FieldKind kind) {
  auto field = ForceField::make(random_block(), TransferFunction::bone(), kind);
  EXPECT_TRUE(field);
  return std::move(*field);
}

ForceField part_of(const ForceField& whole, const Box& box) {
  auto part = ForceField::make(whole.stored(box), whole.kind());
  EXPECT_TRUE(part) << part.error().what;
  return std::move(*part);
}

Vec3 point_within(const Geometry& geometry, const Vec3& low, const Vec3& high,
                  std::mt19937& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Vec3 index;
  for (int a = 0; a < 3; ++a) index[a] = low[a] + share(random) * (high[a] - low[a]);
  return geometry.position_of(index);
}

/// How many of both fields' samples, gradients and opacities differ in any bit.
int different_bits(const ForceField& one, const ForceField& other, const Vec3& low,
                   const Vec3& high) {
  std::mt19937 random(4);
  int different = 0;
  for (int n = 0; n < 2000; ++n) {
    const Vec3 p = point_within(one.geometry(), low, high, random);
    const FieldSample a = one.sample(p), b = other.sample(p);
    different += a.g_per_m != b.g_per_m || a.jacobian_per_m2 != b.jacobian_per_m2 ||
                 one.gradient_per_m(p) != other.gradient_per_m(p) ||
                 one.opacity(p) != other.opacity(p);
  }
  return different;
}

TEST(StoredField, IsTheWholeFieldToTheLastBitWhereItsVoxelsAreRead) {
  // A sample reads two voxels before its own and three behind it.
  const Vec3 low(7.0, 9.0, 11.0), high(21.999, 26.999, 24.999);
  for (const FieldKind kind : {FieldKind::paper, FieldKind::potential}) {
    const ForceField whole = whole_field(kind), part = part_of(whole, kPart);
    EXPECT_EQ(different_bits(whole, part, low, high), 0);
    EXPECT_FALSE(part.left_part());
    EXPECT_FALSE(whole.left_part());
    EXPECT_GT(whole.sample(whole.geometry().position_of({15, 15, 15})).g_per_m.norm(), 1.0);
  }
}

TEST(StoredField, SaysThatASampleReadBeyondIt) {
  const ForceField whole = whole_field(FieldKind::paper), part = part_of(whole, kPart);
  const Vec3 middle(15.5, 15.5, 15.5);
  for (int a = 0; a < 3; ++a)
    for (const double at : {kPart.begin[std::size_t(a)] + 1.99, kPart.end[std::size_t(a)] - 3.0}) {
      Vec3 index = middle;
      index[a] = at + (at > 15.0 ? 1e-9 : -1e-9);
      const Vec3 p = whole.geometry().position_of(index);
      part.sample(p);
      EXPECT_TRUE(part.left_part()) << index.transpose();
      EXPECT_FALSE(part.left_part());  // it was asked
      part.gradient_per_m(p);
      EXPECT_TRUE(part.left_part());
      part.sample(whole.geometry().position_of(middle));
      EXPECT_FALSE(part.left_part());
    }
  part.opacity(whole.geometry().position_of({5.5, 15.5, 15.5}));  // reads one voxel before
  EXPECT_TRUE(part.left_part());
}

TEST(StoredField, RepeatsTheEdgeOfTheVolumeWhereItHasThatEdge) {
  const Box corner{{0, 0, 20}, {20, 20, 43}};
  const ForceField whole = whole_field(FieldKind::paper), part = part_of(whole, corner);
  EXPECT_EQ(different_bits(whole, part, {-9, -9, 22}, {16.9, 16.9, 60}), 0);
  EXPECT_FALSE(part.left_part());
  part.sample(whole.geometry().position_of({-9, -9, 10}));
  EXPECT_TRUE(part.left_part());
}

TEST(StoredField, RefusesABoxThatIsNotInTheVolumeAndOtherNumbersOfOpacities) {
  const ForceField whole = whole_field(FieldKind::paper);
  StoredOpacity part = whole.stored(kPart);
  EXPECT_EQ(part.opacity.size(), 20u * 23u * 19u);
  part.opacity.pop_back();
  const auto fewer = ForceField::make(part, FieldKind::paper);
  ASSERT_FALSE(fewer);
  EXPECT_EQ(
      fewer.error().what,
      "force field: 8739 opacities of voxels (5, 7, 9) to (25, 30, 28) of a volume of 37 × 41 "
      "× 43");
  for (const Box& box :
       {Box{{-1, 0, 0}, {4, 4, 4}}, Box{{0, 0, 0}, {4, 4, 44}}, Box{{4, 4, 4}, {4, 8, 8}}}) {
    part = {whole.geometry(), box, {}};
    const auto made = ForceField::make(part, FieldKind::paper);
    ASSERT_FALSE(made);
    EXPECT_EQ(made.error().code, core::Errc::bad_input);
  }
}

}  // namespace
}  // namespace volume
}  // namespace tractus
