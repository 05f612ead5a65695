#include "wire/live.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace wire {
namespace {

core::Json told() {
  return core::Json::parse(R"({"kind":"state","state":"trial","version":"1.2","device":"rig",
    "simulated":false,"trial":{"trial_id":"0123456789abcdef0123456789abcdef","rig":"probing",
    "case_id":"0123456789abcdef0123456789abcdef0123456789abcdef0123456789abcdef","t_s":1.5,
    "samples":1500,"force_N":null,"depth_m":0.01,"late_ticks":2},"clock_offset_s":-0.25,
    "clock_error_s":0.001,"free_disk_bytes":1000,"late_share":0.5,"waiting_trials":3,
    "calibration_due_utc_us":4,"self_test":{"at_utc_us":5,"passed":false,"failed":["a"]}})");
}

TEST(StationStatus, ComesBackAsItWasSaid) {
  const auto read = StationStatus::from_json(told(), "state");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_EQ(read->to_json(), told());
  EXPECT_FALSE(read->trial->force_N);
}

TEST(StationStatus, OfAStationThatKnowsLittleIsShort) {
  const auto read = StationStatus::from_json({{"kind", "state"}, {"state", "idle"}}, "state");
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_FALSE(read->simulated || read->trial || read->free_disk_bytes);
}

TEST(StationStatus, RefusesWhatIsNoStateAndNamesTheField) {
  const auto why = [](const char* pointer, const core::Json& value) {
    core::Json json = told();
    json[core::Json::json_pointer(pointer)] = value;
    const auto read = StationStatus::from_json(json, "state");
    return read ? std::string("taken") : read.error().what;
  };
  EXPECT_NE(why("/state", "away").find("state"), std::string::npos) << "only the server says that";
  EXPECT_NE(why("/state", "dancing").find("state"), std::string::npos);
  EXPECT_NE(why("/late_share", 1.5).find("late_share"), std::string::npos);
  EXPECT_NE(why("/free_disk_bytes", -1).find("free_disk_bytes"), std::string::npos);
  EXPECT_NE(why("/trial/force_N", 1e9).find("force_N"), std::string::npos);
  EXPECT_NE(why("/trial/force_N", "1").find("force_N"), std::string::npos);
  EXPECT_NE(why("/trial/trial_id", "x").find("trial_id"), std::string::npos);
  EXPECT_NE(why("/trial/breach", "medial").find("breach"), std::string::npos);
  EXPECT_NE(why("/device", std::string(1000, 'x')).find("device"), std::string::npos);
  EXPECT_NE(why("/self_test/failed", core::Json::array({1})).find("failed"), std::string::npos);
}

TEST(StationCommand, IsAStopOrALowerLimitAndNothingElse) {
  const auto stop = StationCommand::from_json({{"kind", "stop"}, {"reason", "look"}}, "command");
  ASSERT_TRUE(stop);
  EXPECT_EQ(stop->reason, "look");
  const auto limits = StationCommand::from_json({{"kind", "limits"}, {"force_N", 2.5}}, "command");
  ASSERT_TRUE(limits);
  EXPECT_EQ(limits->force_N, 2.5);
  EXPECT_FALSE(StationCommand::from_json({{"kind", "raise"}, {"force_N", 1}}, "command"));
  EXPECT_FALSE(StationCommand::from_json({{"kind", "limits"}, {"force_N", -1}}, "command"));
  EXPECT_FALSE(StationCommand::from_json({{"kind", "limits"}}, "command"));
}

}  // namespace
}  // namespace wire
}  // namespace tractus
