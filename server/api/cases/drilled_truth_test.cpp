/// What is true of a channel that a trainee drilled: not the case's word, the burr's.
#include "core/try.hpp"
#include "db/store/trials/trials.hpp"
#include "db/store/trials/uploads.hpp"
#include "server/api/api_test_support.hpp"
#include "server/jobs/case_facts.hpp"
#include "server/jobs/publish.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace api {
namespace {
using testing::ApiTest;

/// The case of world.hpp, whose own truth is a medial breach.
class DrilledTruth : public ApiTest {
 protected:
  DrilledTruth() {
    world::make_case(folder_.path() / "case");
    auto published = jobs::publish_bundle(store_, objects_, folder_.path() / "case");
    EXPECT_TRUE(published) << published.error().what;
    case_ = *published;
  }
  /// A drilling arrives that says so of its channel.
  void drilled(const std::string& of, const core::Json& beyond_m) {
    store::TrialRecord trial;
    trial.summary.id = kDrilling;
    trial.summary.case_id = of;
    trial.station_id = "s1";
    trial.sha256 = std::string(64, 'a');
    trial.header = "{}";
    trial.events = core::Json::array({{{"t_s", 0.0}, {"kind", "start"}, {"detail", nullptr}},
                                      {{"t_s", 9.0},
                                       {"kind", "drilled"},
                                       {"detail", {{"channel", {{"beyond_m", beyond_m}}}}}}})
                       .dump();
    const auto done = store_.write([&](store::Writing& tx) -> core::Result<void> {
      TRY(store::add_upload(
          tx, {kDrilling, "s1", of, 1, trial.sha256, store::UploadPhase::receiving}, 1));
      TRY(store::add_object(tx, trial.sha256, 1, 1));
      return store::add_trial(tx, trial, 1);
    });
    EXPECT_TRUE(done) << done.error().what;
  }
  std::optional<cases::Truth> truth(const core::Json& extra) {
    trial::Header header;
    header.extra = extra;
    auto facts = jobs::facts_of_trial(store_, objects_, case_, header);
    EXPECT_TRUE(facts) << facts.error().what;
    return facts->truth;
  }

  const std::string kDrilling = std::string(32, '1');
  std::string case_;
};

TEST_F(DrilledTruth, IsTheCasesWhereNothingWasDrilled) {
  EXPECT_EQ(truth(core::Json::object())->breached, volume::Wall::medial);
}

TEST_F(DrilledTruth, IsTheWallThatTheChannelWentFarthestBeyond) {
  drilled(case_,
          {{"medial", -0.002}, {"lateral", 0.001}, {"superior", 0.004}, {"inferior", nullptr}});
  const auto known = truth({{"drilled", kDrilling}});
  ASSERT_TRUE(known);
  EXPECT_EQ(known->breached, volume::Wall::superior);
  EXPECT_EQ(known->breach_depth_m, 0.004);
}

TEST_F(DrilledTruth, IsNoBreachWhereTheChannelStayedWithin) {
  drilled(case_, {{"medial", -0.002}, {"lateral", -0.001}});
  const auto known = truth({{"drilled", kDrilling}});
  ASSERT_TRUE(known);
  EXPECT_FALSE(known->breached);
}

TEST_F(DrilledTruth, IsNotKnownWithoutAWallADrillingOrOneOfThisCase) {
  EXPECT_FALSE(truth({{"drilled", kDrilling}})) << "it is not here";
  EXPECT_FALSE(truth({{"drilled", 7}}));
  drilled(testing::kCase, {{"medial", 0.002}});
  EXPECT_FALSE(truth({{"drilled", kDrilling}})) << "it was of another case";
}

TEST_F(DrilledTruth, IsNotKnownWhereTheStationFoundNoWall) {
  drilled(case_, {{"medial", nullptr}, {"lateral", nullptr}});
  EXPECT_FALSE(truth({{"drilled", kDrilling}}));
}

}  // namespace
}  // namespace api
}  // namespace tractus
