#include "cases/making.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace tractus {
namespace cases {
namespace {

using testing::HasSubstr;
using volume::Vec3;
using volume::Wall;

/// A pedicle of 6 mm about y from −20 to 20 mm that runs into a body, a ball of 16 mm: 1.2 mm of
/// cortex about marrow that measures as the soft tissue outside.
double pedicle_and_body(const Vec3& p_mm) {
  const auto within = [&](double thinner_mm) {
    const bool pedicle =
        std::hypot(p_mm.x(), p_mm.z()) < 6.0 - thinner_mm && p_mm.y() > -30 && p_mm.y() < 20;
    return pedicle || (p_mm - Vec3(0, -30, 0)).norm() < 16.0 - thinner_mm;
  };
  if (within(1.2)) return 60.0;
  return within(0.0) ? 700.0 : 50.0;
}

const volume::Volume& made_ct() {
  static const volume::Volume kCt = [] {
    volume::Volume v{.geometry = {{60, 90, 60},
                                  Vec3::Constant(0.001),
                                  Vec3(-0.030, -0.055, -0.030),
                                  volume::Mat3::Identity()},
                     .slope = 1,
                     .intercept = -1024,
                     .counts = {}};
    for (int k = 0; k < 60; ++k)
      for (int j = 0; j < 90; ++j)
        for (int i = 0; i < 60; ++i) {
          double sum = 0.0;
          for (int part = 0; part < 27; ++part)
            sum += pedicle_and_body(
                1e3 *
                v.geometry.position_of(Vec3(i, j, k) +
                                       Vec3(part % 3 - 1, part / 3 % 3 - 1, part / 9 - 1) / 3.0));
          v.counts.push_back(v.count_of(sum / 27.0));
        }
    return v;
  }();
  return kCt;
}

CarvingPlan made_plan() {
  CarvingPlan plan;
  plan.entry_m = Vec3(0, 0.018, 0);
  plan.target_m = Vec3(0, -0.040, 0);
  plan.midline_x_m = -0.020;
  plan.preparation = volume::Preparation::filled;
  return plan;
}

TEST(MakeFive, MakesABreachOfEachWallUnderOneCertificate) {
  const auto five = make_five(made_ct(), {}, made_plan());
  ASSERT_TRUE(five) << five.error().what;
  ASSERT_EQ(five->size(), 5u);
  std::set<Wall> walls;
  double least = 1e300, most = 0.0;
  for (const Made& made : *five) {
    ASSERT_TRUE(made.breach);
    const Wall wall = made.breach->wall.wall;
    walls.insert(wall);
    EXPECT_EQ(made.certificate->to_json(), five->front().certificate->to_json());
    EXPECT_TRUE(made.certificate->passes());
    const auto& told = made.certificate->walls[std::size_t(wall)];
    EXPECT_EQ(told.at_m, made.breach->wall.at_m) << "the certificate is of the breach that is made";
    if (wall == Wall::anterior) continue;
    least = std::min(least, *told.d_prime()), most = std::max(most, *told.d_prime());
  }
  EXPECT_EQ(walls.size(), 5u);
  EXPECT_LT(most - least, 0.25) << "side walls of a round pedicle can be made equally hard";
}

TEST(Certify, TriesOnePlaceOfEachWallFirst) {
  const auto first = certify(made_ct(), {}, made_plan(), Effort::first);
  ASSERT_TRUE(first) << first.error().what;
  for (const auto& wall : first->walls)
    EXPECT_EQ(wall.places.size(), wall.wall == Wall::anterior ? 0u : 1u);
  EXPECT_TRUE(first->sensitivities.empty());
}

TEST(Certify, StopsWhenItIsCalledOff) {
  int asked = 0;
  const auto stopped = certify(made_ct(), {}, made_plan(), Effort::whole, [&](double share) {
    ++asked;
    return share < 0.2;
  });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Errc::cancelled);
  EXPECT_GT(asked, 1);
}

TEST(CertifyDrilled, SaysWhatTheDrilledBoneAloneTells) {
  auto plan = made_plan();
  plan.breach = volume::BreachPlan{.wall = Wall::medial};
  const auto made = make(made_ct(), {}, plan);
  ASSERT_TRUE(made) << made.error().what;
  Case definition;
  definition.tract = made->tract;
  const auto late = certify_drilled(made->volume, definition, made->truth());
  ASSERT_TRUE(late) << late.error().what;
  ASSERT_EQ(late->walls.size(), 1u);
  EXPECT_FALSE(late->walls[0].told.k) << "its whole twin is not known";
  EXPECT_NEAR(*late->walls[0].told.b, *made->certificate->walls[0].told.b, 1.0);
  const auto whole = certify_drilled(made->volume, definition, {});
  ASSERT_FALSE(whole);
  EXPECT_THAT(whole.error().what, HasSubstr("make the case anew"));
  const auto json = made->certificate->to_json();
  EXPECT_EQ(d_prime_of(json, Wall::medial), made->certificate->walls[0].d_prime());
  EXPECT_FALSE(d_prime_of(core::Json::object(), Wall::medial));
}

}  // namespace
}  // namespace cases
}  // namespace tractus
