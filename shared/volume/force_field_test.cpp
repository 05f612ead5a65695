#include "volume/force_field.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <random>

namespace tractus {
namespace volume {
namespace {

// The oracle: the equations of design ("The palpation law, made precise") written straight, in
// double precision, one voxel at a time. It shares no code with what it judges but the transfer
// function and the geometry.
class Naive {
 public:
  Naive(const Volume& volume, const TransferFunction& transfer)
      : g_(volume.geometry), b_(volume.counts.size()) {
    std::vector<double> alpha(b_.size());
    for (std::size_t v = 0; v < alpha.size(); ++v)
      alpha[v] = transfer.opacity(volume.intercept + volume.slope * volume.counts[v]);
    double norm = 0.0;
    for (int k = -7; k <= 7; ++k) norm += std::exp(-0.5 * k * k);
    for (int axis = 0; axis < 3; ++axis) {
      for (int k = 0; k < g_.dims[2]; ++k)
        for (int j = 0; j < g_.dims[1]; ++j)
          for (int i = 0; i < g_.dims[0]; ++i) {
            double sum = 0.0;
            for (int m = -7; m <= 7; ++m)
              sum += std::exp(-0.5 * m * m) / norm *
                     alpha[index(i + (axis == 0) * m, j + (axis == 1) * m, k + (axis == 2) * m)];
            b_[index(i, j, k)] = sum;
          }
      alpha = b_;
    }
  }

  double opacity(const Vec3& p) const {
    return weighed(p, [&](int i, int j, int k) { return b(i, j, k); });
  }

  /// −∇ by central differences at the voxels, per metre, then Catmull–Rom.
  Vec3 paper(const Vec3& p) const {
    Vec3 out;
    for (int a = 0; a < 3; ++a)
      out[a] = weighed(p, [&](int i, int j, int k) {
        const int x = a == 0, y = a == 1, z = a == 2;
        return -(b(i + x, j + y, k + z) - b(i - x, j - y, k - z)) / (2.0 * g_.spacing_m[a]);
      });
    return g_.directions * out;
  }

  /// −∇ of the interpolant, by differences of it that are exact to 1e-9: it is a cubic along each
  /// axis within a cell, and a fourth-order difference of a cubic is exact. `p` must lie 0.01 voxel
  /// or more from a cell's face.
  Vec3 potential(const Vec3& p) const {
    Vec3 out;
    for (int a = 0; a < 3; ++a) {
      const double h = 2e-3 * g_.spacing_m[a];
      const Vec3 e = g_.directions.col(a) * h;
      out[a] =
          -(8 * (opacity(p + e) - opacity(p - e)) - (opacity(p + 2 * e) - opacity(p - 2 * e))) /
          (12 * h);
    }
    return g_.directions * out;
  }

 private:
  double b(int i, int j, int k) const { return b_[index(i, j, k)]; }
  std::size_t index(int i, int j, int k) const {
    i = std::clamp(i, 0, g_.dims[0] - 1);
    j = std::clamp(j, 0, g_.dims[1] - 1);
    k = std::clamp(k, 0, g_.dims[2] - 1);
    return (std::size_t(k) * std::size_t(g_.dims[1]) + std::size_t(j)) * std::size_t(g_.dims[0]) +
           std::size_t(i);
  }
  /// The Catmull–Rom kernel at distance x (Keys' cubic convolution with a = −½).
  static double kernel(double x) {
    x = std::abs(x);
    if (x < 1) return 1.5 * x * x * x - 2.5 * x * x + 1;
    if (x < 2) return -0.5 * x * x * x + 2.5 * x * x - 4 * x + 2;
    return 0.0;
  }
  template <class At>
  double weighed(const Vec3& p, At at) const {
    const Vec3 u = (g_.directions.transpose() * (p - g_.origin_m)).cwiseQuotient(g_.spacing_m);
    const int x = int(std::floor(u[0])), y = int(std::floor(u[1])), z = int(std::floor(u[2]));
    double sum = 0.0;
    for (int k = z - 1; k <= z + 2; ++k)
      for (int j = y - 1; j <= y + 2; ++j)
        for (int i = x - 1; i <= x + 2; ++i)
          sum += kernel(u[0] - i) * kernel(u[1] - j) * kernel(u[2] - k) * at(i, j, k);
    return sum;
  }
  Geometry g_;
  std::vector<double> b_;
};

/// A random walk through grey values: rough in places, flat in others. Uneven spacing, a turned and
/// left-handed frame.
Volume rough(const std::array<int, 3>& dims, unsigned seed) {
  Volume v;
  v.geometry.dims = dims;
  v.geometry.spacing_m = {0.0003, 0.0005, 0.0009};
  v.geometry.origin_m = {0.05, -0.12, 0.3};
  Mat3 turned = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  turned.col(2) *= -1.0;
  v.geometry.directions = turned;
  v.slope = 0.5;
  v.intercept = -1024.0;
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> count(1800, 4000);
  v.counts.resize(v.geometry.voxel_count());
  for (std::size_t k = 0; k < v.counts.size(); ++k)
    v.counts[k] = k % 7 == 0 || k == 0 ? std::uint16_t(count(random)) : v.counts[k - 1];
  return v;
}

const TransferFunction& transfer() {
  static const TransferFunction t =
      *TransferFunction::make({{-100, 0.05}, {150, 0.0}, {400, 0.8}, {700, 1.0}});
  return t;
}

/// A point `margin` voxels or more inside the box of the voxel centres; negative: beyond it too.
Vec3 random_point(const Geometry& g, double margin, std::mt19937& random) {
  Vec3 u;
  for (int a = 0; a < 3; ++a)
    u[a] =
        std::uniform_real_distribution<double>(margin, g.dims[std::size_t(a)] - 1 - margin)(random);
  for (int a = 0; a < 3; ++a)
    u[a] = std::floor(u[a]) + std::clamp(u[a] - std::floor(u[a]), 0.01, 0.99);
  return g.position_of(u);
}

// A float's rounding, 6e-8, through three passes and a difference over the smallest spacing: 2e-7 /
// 0.3 mm.
constexpr double kGradientTolerance_per_m = 1.0e-3;

class FieldOfKind : public testing::TestWithParam<FieldKind> {};

TEST_P(FieldOfKind, EqualsTheEquationsWrittenStraightInsideAtTheEdgesAndBeyond) {
  const Volume v = rough({37, 21, 24}, 1);
  const Naive naive(v, transfer());
  const auto field = ForceField::make(v, transfer(), GetParam());
  ASSERT_TRUE(field);
  std::mt19937 random(2);
  double largest = 0.0;
  for (int n = 0; n < 600; ++n) {
    const Vec3 p = random_point(v.geometry, n % 2 ? 3.0 : -3.0, random);
    const Vec3 expected = GetParam() == FieldKind::paper ? naive.paper(p) : naive.potential(p);
    EXPECT_LE((field->gradient_per_m(p) - expected).norm(), kGradientTolerance_per_m)
        << v.geometry.index_of(p).transpose();
    EXPECT_NEAR(field->opacity(p), naive.opacity(p), 1e-6);
    largest = std::max(largest, expected.norm());
  }
  EXPECT_GT(largest, 100.0) << "the points must meet a field, else nothing was compared";
}

TEST_P(FieldOfKind, JacobianIsTheDerivativeOfTheField) {
  const Volume v = rough({30, 30, 30}, 3);
  const auto field = ForceField::make(v, transfer(), GetParam());
  ASSERT_TRUE(field);
  std::mt19937 random(4);
  for (int n = 0; n < 200; ++n) {
    const Vec3 p = random_point(v.geometry, 3.0, random);
    const FieldSample at = field->sample(p);
    EXPECT_EQ(at.g_per_m, field->gradient_per_m(p)) << "both ways to ask must answer the same";
    const double h =
        2e-6;  // 1/150 of the smallest voxel: float rounding and the cubic's curvature balance
    for (int b = 0; b < 3; ++b) {
      const Vec3 e = Vec3::Unit(b) * h;
      const Vec3 slope = (field->gradient_per_m(p + e) - field->gradient_per_m(p - e)) / (2 * h);
      EXPECT_LE((at.jacobian_per_m2.col(b) - slope).norm(),
                2e-4 * at.jacobian_per_m2.norm() + 2000.0);
    }
  }
}

TEST_P(FieldOfKind, AfterRemovalsEqualsAFullRecompute) {
  Volume v = rough({150, 80, 40}, 5);  // more than one tile wide and high
  auto field = ForceField::make(v, transfer(), GetParam());
  ASSERT_TRUE(field);
  std::mt19937 random(6);
  const auto& n = v.geometry.dims;
  for (int removal = 0; removal < 60; ++removal) {
    Box box;
    for (std::size_t a = 0; a < 3; ++a) {
      const int size = std::uniform_int_distribution<int>(1, 9)(random);
      // A third of the boxes each lie at the low edge, at the high edge, and anywhere.
      const int low = removal % 3 == 0 ? 0
                      : removal % 3 == 1
                          ? n[a] - size
                          : std::uniform_int_distribution<int>(0, n[a] - size)(random);
      box.begin[a] = low;
      box.end[a] = low + size;
    }
    for (int k = box.begin[2]; k < box.end[2]; ++k)
      for (int j = box.begin[1]; j < box.end[1]; ++j)
        for (int i = box.begin[0]; i < box.end[0]; ++i)
          v.counts[v.offset(i, j, k)] = std::uint16_t(random() % 3000);
    field->update(v, box);
  }
  const auto whole = ForceField::make(v, transfer(), GetParam());
  ASSERT_TRUE(whole);
  double worst = 0.0;
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) {
        const Vec3 p = v.geometry.position_of({double(i), double(j), double(k)});
        worst = std::max(worst, std::abs(field->opacity(p) - whole->opacity(p)));
      }
  EXPECT_LE(worst, 1e-5);
}

// The field of `update` is the expected one, to the last bit: what a loop is given in patches must
// be what a replay makes with updates. Boxes at both edges, and patches whose memory was used
// before.
TEST_P(FieldOfKind, ComputedAsideAndPutInPlaceIsTheUpdatedFieldToTheLastBit) {
  Volume v = rough({61, 43, 35}, 11);
  auto updated = ForceField::make(v, transfer(), GetParam());
  auto patched = ForceField::make(v, transfer(), GetParam());
  ASSERT_TRUE(updated && patched);
  FieldPatch patch(40 * 40 * 40);
  std::mt19937 random(12);
  const auto& n = v.geometry.dims;
  for (int removal = 0; removal < 30; ++removal) {
    Box box;
    for (std::size_t a = 0; a < 3; ++a) {
      const int size = std::uniform_int_distribution<int>(1, 9)(random);
      box.begin[a] = removal % 3 == 0   ? 0
                     : removal % 3 == 1 ? n[a] - size
                                        : int(random() % unsigned(n[a] - size));
      box.end[a] = box.begin[a] + size;
    }
    for (int k = box.begin[2]; k < box.end[2]; ++k)
      for (int j = box.begin[1]; j < box.end[1]; ++j)
        for (int i = box.begin[0]; i < box.end[0]; ++i)
          v.counts[v.offset(i, j, k)] = std::uint16_t(random() % 3000);
    updated->update(v, box);
    patched->compute(v, box, patch);
    patched->apply(patch);
  }
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3 index(double(random() % 6600) / 100.0 - 2.0, double(random() % 4700) / 100.0 - 2.0,
                     double(random() % 3900) / 100.0 - 2.0);
    const Vec3 p = v.geometry.position_of(index);
    ASSERT_EQ(updated->opacity(p), patched->opacity(p));
    ASSERT_EQ(updated->gradient_per_m(p), patched->gradient_per_m(p));
  }
}

TEST(FieldPatch, OfAChangeOutsideTheVolumeHoldsNothing) {
  const Volume v = rough({20, 20, 20}, 13);
  auto field = ForceField::make(v, transfer(), FieldKind::paper);
  ASSERT_TRUE(field);
  const Box outside{{25, 0, 0}, {30, 5, 5}};
  EXPECT_EQ(FieldPatch::floats_for(outside, v.geometry.dims), 0u);
  // 4 … 9 reaches 0 … 16 along i, in rows of eight, and 0 … 16 along j and k.
  EXPECT_EQ(FieldPatch::floats_for({{4, 4, 4}, {9, 9, 9}}, v.geometry.dims), 16u * 16u * 16u);
  FieldPatch patch(16);
  field->compute(v, outside, patch);
  const double before = field->opacity(v.geometry.position_of({10.5, 10, 10}));
  field->apply(patch);
  EXPECT_EQ(field->opacity(v.geometry.position_of({10.5, 10, 10})), before);
}

TEST_P(FieldOfKind, IsZeroFarOutsideAlongTheNormalAndAtNoNumber) {
  const Volume v = rough({20, 20, 20}, 7);
  const auto field = ForceField::make(v, transfer(), GetParam());
  ASSERT_TRUE(field);
  for (int a = 0; a < 3; ++a)
    for (const double side : {-50.0, 1e9, -1e300}) {
      Vec3 u(9.3, 9.3, 9.3);
      u[a] = side;
      const Vec3 g = field->gradient_per_m(v.geometry.position_of(u));
      EXPECT_NEAR(g.dot(v.geometry.directions.col(a)), 0.0, kGradientTolerance_per_m)
          << "repeated voxels have no slope";
    }
  const double nan = std::nan("");
  EXPECT_TRUE(field->gradient_per_m({nan, nan, nan}).allFinite());
  EXPECT_TRUE(field->sample({nan, 0.0, 0.0}).jacobian_per_m2.allFinite());
}

TEST_P(FieldOfKind, OfAVolumeOneVoxelThickIsFlatThatWay) {
  const Volume v = rough({25, 1, 13}, 8);
  const auto field = ForceField::make(v, transfer(), GetParam());
  ASSERT_TRUE(field);
  const Vec3 g = field->gradient_per_m(v.geometry.position_of({11.4, 0.2, 6.7}));
  EXPECT_GT(g.norm(), 1.0);
  EXPECT_NEAR(g.dot(v.geometry.directions.col(1)), 0.0, kGradientTolerance_per_m);
}

INSTANTIATE_TEST_SUITE_P(Kinds, FieldOfKind,
                         testing::Values(FieldKind::paper, FieldKind::potential),
                         [](const auto& test) {
                           return test.param == FieldKind::paper ? "Paper" : "Potential";
                         });

TEST(ForceField, OfARampIsItsSlope) {
  // α rises by 1 over 550 counts, the counts by 11 a voxel: 0.02 a voxel, 0.02 / 0.5 mm = 40 per
  // metre, away from the edges.
  Volume v;
  v.geometry.dims = {60, 12, 12};
  v.geometry.spacing_m = Vec3::Constant(0.0005);
  v.intercept = 0.0;
  for (int k = 0; k < 12; ++k)
    for (int j = 0; j < 12; ++j)
      for (int i = 0; i < 60; ++i) v.counts.push_back(std::uint16_t(100 + 11 * i));
  for (const FieldKind kind : {FieldKind::paper, FieldKind::potential}) {
    const auto field = ForceField::make(v, TransferFunction::bone(), kind);
    ASSERT_TRUE(field);
    const Vec3 g = field->gradient_per_m(v.geometry.position_of({30.3, 6.1, 5.8}));
    EXPECT_NEAR(g.x(), -40.0, kGradientTolerance_per_m);
    EXPECT_NEAR(g.y(), 0.0, kGradientTolerance_per_m);
    EXPECT_NEAR(g.z(), 0.0, kGradientTolerance_per_m);
  }
}

TEST(ForceField, OfPotentialKindDoesNoNetWorkRoundALoop) {
  // A circle through the voxel walls; the published field does about 1 % of the way's work
  // (design), this one none.
  const Volume v = rough({40, 40, 40}, 9);
  const auto paper = ForceField::make(v, transfer(), FieldKind::paper);
  const auto potential = ForceField::make(v, transfer(), FieldKind::potential);
  ASSERT_TRUE(paper && potential);
  const auto net_share = [&](const ForceField& field) {
    constexpr int kSteps = 20000;
    double net = 0.0, all = 0.0;
    for (int n = 0; n < kSteps; ++n) {
      const auto at = [&](double step) {
        const double angle = 2 * M_PI * step / kSteps;
        return v.geometry.position_of(
            {19.2 + 2 * std::cos(angle), 20.1 + 2 * std::sin(angle), 18.7 + std::sin(angle)});
      };
      const double work = field.gradient_per_m(at(n + 0.5)).dot(at(n + 1) - at(n));
      net += work;
      all += std::abs(work);
    }
    return std::abs(net) / all;
  };
  EXPECT_LT(net_share(*potential), 1e-5);
  EXPECT_GT(net_share(*paper), 1e-4);
}

TEST(ForceField, IsTheSameInAnyPatientFrame) {
  Volume v = rough({30, 30, 30}, 10);
  Volume plain = v;
  plain.geometry.directions = Mat3::Identity();
  plain.geometry.origin_m = Vec3::Zero();
  const auto turned_field = ForceField::make(v, transfer(), FieldKind::paper);
  const auto plain_field = ForceField::make(plain, transfer(), FieldKind::paper);
  ASSERT_TRUE(turned_field && plain_field);
  std::mt19937 random(11);
  for (int n = 0; n < 50; ++n) {
    const Vec3 p = random_point(plain.geometry, 3.0, random);
    const Vec3 q = v.geometry.origin_m + v.geometry.directions * p;
    EXPECT_LE(
        (turned_field->gradient_per_m(q) - v.geometry.directions * plain_field->gradient_per_m(p))
            .norm(),
        kGradientTolerance_per_m);
  }
}

TEST(ForceField, StopsWhenAsked) {
  const auto field = ForceField::make(rough({40, 40, 40}, 12), transfer(), FieldKind::paper,
                                      [](double) { return false; });
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, core::Errc::cancelled);
}

TEST(ForceField, TellsHowFarItHasComeUpToAllOfIt) {
  double last = 0.0;
  const auto field =
      ForceField::make(rough({40, 140, 40}, 13), transfer(), FieldKind::paper, [&](double share) {
        EXPECT_GT(share, last);
        last = share;
        return true;
      });
  ASSERT_TRUE(field);
  EXPECT_EQ(last, 1.0);
}

}  // namespace
}  // namespace volume
}  // namespace tractus
