#include "lab/rigs/palpation/force_laws.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace lab {
namespace {

using math::Vec3;

/// A handle that is turned by 90 degrees about z, so that the room's x is its −y.
struct Pressed {
  std::vector<double> t_s, depth_m;
  std::vector<effects::HandleMotion> handle;
  std::vector<Vec3> force_V_N, tip_v_m_s;

  /// From t = 1 s on the force acts.
  explicit Pressed(const Vec3& from_1_s_V_N) {
    for (int k = 0; k <= 400; ++k) {
      t_s.push_back(0.01 * k);
      depth_m.push_back(0.03);
      effects::HandleMotion& h = handle.emplace_back();
      h.X_VH.q = math::Quat(Eigen::AngleAxisd(M_PI / 2.0, Vec3::UnitZ()));
      force_V_N.push_back(k >= 100 ? from_1_s_V_N : Vec3(Vec3::Zero()));
      tip_v_m_s.push_back(Vec3(0.0, 0.02, 0.0));
    }
  }
  std::vector<ForceLaws::Law> laws() const {
    return force_laws_of({t_s, handle, force_V_N, tip_v_m_s, depth_m});
  }
};

Vec3 term(const std::vector<ForceLaws::Law>& laws, std::string_view name, std::size_t number,
          int sample) {
  for (const ForceLaws::Law& law : laws)
    if (law.name == name) return law.terms.at(number).col(sample);
  ADD_FAILURE() << "no law " << name;
  return Vec3::Zero();
}

TEST(ForceLaws, AMemoryFadesWithItsTimeConstantInTheHandlesFrame) {
  // τ q' = F − q: after a step of 2 N at 1 s, q − F = −2 exp(−(t − 1 s)/τ) N; τ = 0.8 s is the second.
  const auto laws = Pressed(Vec3(2.0, 0.0, 0.0)).laws();
  for (const int sample : {150, 200, 350}) {
    const double since_s = 0.01 * (sample - 100);
    EXPECT_NEAR(term(laws, "the contact force of before", 1, sample).y(),
                2.0 * std::exp(-since_s / 0.8), 0.03);
  }
}

TEST(ForceLaws, FrictionPointsAlongTheMotionAcrossTheForceAndIsAShareOfIt) {
  // 20 mm/s along y, 2 N along x: friction of 2 N times v/(v + 1 mm/s) along y, which is the handle's x. It acts from 1 s
  // on, and what it was before is less by 2 N exp(−(t − 1 s)/τ).
  const auto laws = Pressed(Vec3(2.0, 0.0, 0.0)).laws();
  EXPECT_NEAR(term(laws, "the friction of before", 1, 200).x(),
              -2.0 * 20.0 / 21.0 * std::exp(-1.0 / 0.8), 0.03);
  // Along the force there is none.
  const auto along = Pressed(Vec3(0.0, 2.0, 0.0)).laws();
  EXPECT_LT(term(along, "the friction of before", 1, 200).norm(), 1e-12);
}

TEST(ForceLaws, BoneThatIsStifferOneWayIsSymmetricAndFixedToTheRoom) {
  // The first number is the room's xx: of a force along x all, of one along y nothing.
  const auto x = Pressed(Vec3(2.0, 0.0, 0.0)).laws(), y = Pressed(Vec3(0.0, 2.0, 0.0)).laws();
  EXPECT_LT((term(x, "bone that is stiffer one way", 0, 300) - Vec3(0.0, -2.0, 0.0)).norm(), 1e-12);
  EXPECT_LT(term(y, "bone that is stiffer one way", 0, 300).norm(), 1e-12);
  // The second its xy: a force along x makes one along y, and the other way round.
  EXPECT_LT((term(x, "bone that is stiffer one way", 1, 300) - Vec3(2.0, 0.0, 0.0)).norm(), 1e-12);
  EXPECT_LT((term(y, "bone that is stiffer one way", 1, 300) - Vec3(0.0, -2.0, 0.0)).norm(), 1e-12);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
