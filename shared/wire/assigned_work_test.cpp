#include "wire/assigned_work.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace wire {
namespace {

AssignedTrial palpation() {
  AssignedTrial out;
  out.slot = std::string(64, 'a');
  out.rig = trial::Rig::palpation;
  out.name = "Case A";
  out.assignment = "Week 2";
  out.number = 1;
  out.planned = 2;
  out.case_id = std::string(64, 'c');
  return out;
}
core::Result<AssignedTrial> read(const core::Json& json) {
  return AssignedTrial::from_json(json, "trial");
}

TEST(AssignedTrial, AnOrdinaryOneSaysNothingOfDrilling) {
  const core::Json json = palpation().to_json();
  EXPECT_FALSE(json.contains("tool") || json.contains("drilled"));
  EXPECT_FALSE(read(json)->drills);
  EXPECT_EQ(read(json)->drilled, "");
}

TEST(AssignedTrial, IsReadAsItWasWritten) {
  AssignedTrial drills = palpation(), feels = palpation();
  drills.drills = true;
  feels.drilled = std::string(32, '1');
  EXPECT_TRUE(read(drills.to_json())->drills);
  EXPECT_EQ(read(feels.to_json())->drilled, std::string(32, '1'));
}

TEST(AssignedTrial, RefusesADrillingThatCannotBe) {
  core::Json probing = palpation().to_json();
  probing.update({{"rig", "probing"}, {"case_id", ""}, {"tool", "burr"}});
  core::Json both = palpation().to_json();
  both.update({{"tool", "burr"}, {"drilled", std::string(32, '1')}});
  core::Json spoon = palpation().to_json(), nameless = spoon;
  spoon["tool"] = "spoon";
  nameless["drilled"] = "../../etc";
  for (const auto& [json, field] : std::vector<std::pair<core::Json, std::string>>{
           {probing, "rig"}, {both, "drilled"}, {spoon, "tool"}, {nameless, "drilled"}}) {
    const auto refused = read(json);
    ASSERT_FALSE(refused) << json;
    EXPECT_NE(refused.error().what.find("/" + field), std::string::npos) << refused.error().what;
  }
}

}  // namespace
}  // namespace wire
}  // namespace tractus
