#include "cases/observer.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>

#include "cases/certificate.hpp"
#include "core/file.hpp"
#include "volume/carve.hpp"

namespace tractus {
namespace cases {
namespace {

using volume::Vec3;
using volume::Wall;

constexpr double kBone_m = 0.006;  // radius of the bone about the tract

/// Bone about the z axis up to 6 mm from it and to z = 36 mm; `marrow` within `kBone_m` less
/// `shell_m`.
volume::Volume bone_rod(double marrow, double shell_m) {
  volume::Volume v{.geometry = {{86, 86, 140},
                                Vec3::Constant(0.00035),
                                Vec3(-0.0149, -0.0149, -0.006),
                                volume::Mat3::Identity()},
                   .slope = 1,
                   .intercept = -1024,
                   .counts = {}};
  for (int k = 0; k < 140; ++k)
    for (int j = 0; j < 86; ++j)
      for (int i = 0; i < 86; ++i) {
        const Vec3 p = v.geometry.position_of(Vec3(i, j, k));
        const double inside_m = std::min(kBone_m - std::hypot(p.x(), p.y()), 0.036 - p.z());
        const double bone = std::clamp(0.5 + inside_m / 0.00035, 0.0, 1.0),
                     inner = std::clamp(0.5 + (inside_m - shell_m) / 0.00035, 0.0, 1.0);
        v.counts.push_back(v.count_of(bone * (900 + inner * (marrow - 900))));
      }
  return v;
}

const volume::Tract kTract{.entry_m = Vec3::Zero(),
                           .axis = Vec3::UnitZ(),
                           .length_m = 0.034,
                           .radius_m = 0.0015,
                           .medial = Vec3::UnitX(),
                           .superior = Vec3::UnitY()};

volume::Breach hole(Wall wall, double at_m) {
  if (wall == Wall::anterior)
    return {.wall = {.wall = wall, .at_m = kTract.length_m, .inner_m = 0.0, .outer_m = 0.002},
            .depth_m = 0.003,
            .from_m = kTract.end_m(),
            .tip_m = kTract.end_m() + Vec3(0, 0, 0.005),
            .centre_m = kTract.end_m() + Vec3(0, 0, 0.001)};
  const Vec3 out = wall == Wall::medial ? kTract.medial : Vec3(-kTract.superior);
  const Vec3 from = kTract.entry_m + at_m * kTract.axis;
  return {.wall = {.wall = wall, .at_m = at_m, .inner_m = 0.0015, .outer_m = kBone_m},
          .depth_m = 0.003,
          .from_m = from,
          .tip_m = from + (kBone_m + 0.003) * out,
          .centre_m = from + 0.004 * out};
}

Detectability told(const volume::Volume& bone, Wall wall, double at_m,
                   const Perception& perception = {}) {
  models::PalpationModel model;
  const Observer observer(model, kTract, 0.010);
  volume::Volume whole = bone, breached = bone;
  volume::drill(whole, kTract, 0.008, std::nullopt, 0.0);
  const auto box = volume::drill(breached, kTract, 0.008, hole(wall, at_m), 0.0);
  auto made = volume::ForceField::make(whole, model.transfer, model.field);
  auto& field = *made;
  const auto palpated = observer.palpate(field);
  field.update(breached, box);
  const auto near = observer.palpate_near(field, *palpated, wall, at_m);
  EXPECT_TRUE(palpated && near);
  return observer.detect(observer.felt(*palpated, perception), observer.felt(*near, perception),
                         wall, at_m, perception);
}

// An implementation of its own (a study before this code, own method, solid bone and a shell of 1
// mm): solid bone K 4.0 … 4.4, B 3.6 … 4.4, FA 0.8; shell K 1.4 … 2.6, B 1.1, FA 2.3 … 3.5.
TEST(AnIdealObserver, TellsAHoleInSolidBone) {
  for (const Wall wall : {Wall::medial, Wall::inferior}) {
    const auto found = told(bone_rod(900, 0.001), wall, 0.020);
    EXPECT_GT(*found.k, 3.0) << name(wall);
    EXPECT_GT(*found.b, 2.5) << name(wall);
    EXPECT_LT(*found.fa, 1.6) << name(wall);
  }
}

TEST(AnIdealObserver, CannotTellOneInAShellAboutMarrowThatIsNotFelt) {
  const auto found = told(bone_rod(80, 0.001), Wall::medial, 0.020);
  EXPECT_LT(std::min(*found.k, *found.b), 2.5);
}

TEST(AnIdealObserver, TellsAnEndThatIsNotThere) {
  EXPECT_GT(*told(bone_rod(900, 0.001), Wall::anterior, 0.034).k, 2.0);
}

TEST(AnIdealObserver, TellsNothingOfABreachThatIsNone) {
  models::PalpationModel model;
  const Observer observer(model, kTract, 0.010);
  volume::Volume whole = bone_rod(900, 0.001);
  volume::drill(whole, kTract, 0.008, std::nullopt, 0.0);
  const auto made = volume::ForceField::make(whole, model.transfer, model.field);
  auto& field = *made;
  const auto palpated = observer.palpate(field);
  const auto felt = observer.felt(*palpated, {}), again = observer.felt(*palpated, {});
  EXPECT_EQ(observer.detect(felt, again, Wall::medial, 0.020, {}).k, 0.0);
  EXPECT_EQ(observer.detect(felt, again, Wall::anterior, 0.034, {}).k, 0.0);
  EXPECT_FALSE(observer.detect(felt, felt, Wall::medial, 0.020, {}).k);  // no twin, no K
}

/// Of a hand whose tip bears.
double foretold(const volume::Volume& bone, Wall wall, double at_m, bool breached,
                const Perception& perception = {}) {
  models::PalpationModel model;
  const Observer observer(model, kTract, 0.010);
  volume::Volume whole = bone, holed = bone;
  volume::drill(whole, kTract, 0.008, std::nullopt, 0.0);
  const auto box = volume::drill(holed, kTract, 0.008, hole(wall, at_m), 0.0);
  auto made = volume::ForceField::make(whole, model.transfer, model.field);
  auto& field = *made;
  const auto palpated = observer.palpate(field);
  if (breached) field.update(holed, box);
  const auto near = observer.palpate_near(field, *palpated, wall, at_m);
  EXPECT_TRUE(palpated && near);
  return observer.foretold(observer.felt(*palpated, perception), observer.felt(*near, perception),
                           wall, at_m, perception);
}

TEST(AForetoldHand, IsRightInSolidBoneAndLessSoWithACoarserSense) {
  const auto bone = bone_rod(900, 0.001);
  EXPECT_GT(foretold(bone, Wall::medial, 0.020, true), WallCertificate::kLeastForetold);
  EXPECT_LT(foretold(bone, Wall::medial, 0.020, true, {.force_threshold_N = 0.6}), 0.75);
}

TEST(AForetoldHand, GuessesOneOfSixWhereThereIsNothing) {
  // An end that is as before, and holds: six answers of equal evidence, one of six right.
  EXPECT_NEAR(foretold(bone_rod(900, 0.001), Wall::anterior, 0.034, false), 1.0 / 6.0, 1e-3);
}

TEST(AForetoldHand, TakesAPersonsOwnThresholds) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("tractus-observer-" + std::to_string(::getpid()) + ".json");
  const auto with = [&](const core::Json& perception) {
    core::Json file = {{"format", "tractus-observer/1"}, {"perception", perception}};
    EXPECT_TRUE(core::write_json(path, file));
    return read_perception(path);
  };
  const auto read = with({{"force_threshold_N", 0.025}, {"force_weber", 0.12}});
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->force_threshold_N, 0.025);
  EXPECT_EQ(read->force_weber, 0.12);
  EXPECT_EQ(read->wander_m, Perception{}.wander_m);
  const auto wrong = with({{"force_threshold_N", -1.0}, {"force_weber", 0.12}});
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().what.find("force_threshold_N"), std::string::npos);
  EXPECT_FALSE(with({{"force_threshold_N", 0.03}}));
  std::filesystem::remove(path);
}

TEST(AnIdealObserver, TellsLessWithACoarserSense) {
  const auto bone = bone_rod(900, 0.001);
  const double usual = *told(bone, Wall::medial, 0.020).k;
  EXPECT_LT(*told(bone, Wall::medial, 0.020, {.force_weber = 0.2}).k, usual);
  EXPECT_LT(*told(bone, Wall::medial, 0.020, {.force_threshold_N = 0.06}).k, usual);
  EXPECT_LT(*told(bone, Wall::medial, 0.020, {.wander_m = 0.0008}).k, usual);
}

}  // namespace
}  // namespace cases
}  // namespace tractus
