/// The kiosk's states by hand: expected screens are those of the table in README.md.
#include "station/kiosk/machine.hpp"

#include <gtest/gtest.h>

#include "station/kiosk/desk.hpp"

namespace tractus::kiosk {
namespace {
using Kind = Command::Kind;
constexpr core::Instant_ns kSecond = 1'000'000'000;

Command command(Kind kind, std::string text = {}) {
  return {.kind = kind, .text = std::move(text)};
}

wire::AssignedWork work_of(trial::Rig rig) {
  wire::AssignedTrial trial{.slot = std::string(64, 'a'),
                            .rig = rig,
                            .name = "Case 1",
                            .assignment = "Week 1",
                            .number = 1,
                            .planned = 3,
                            .case_id = "",
                            .sealed = ""};
  return {.participant = "P01", .left = 3, .trial = trial};
}

class KioskMachine : public ::testing::Test {
 protected:
  void expect_taken(const Command& given) {
    const auto taken = machine_.take(given, now_);
    EXPECT_TRUE(taken) << taken.error().what;
  }
  void expect_refused(const Command& given) {
    const std::string before = machine_.to_json().dump();
    EXPECT_FALSE(machine_.take(given, now_));
    EXPECT_EQ(machine_.to_json().dump(), before) << "what is refused changes nothing";
  }
  void to_pin() { expect_taken(command(Kind::badge, "4711")); }
  void to_checking() {
    to_pin();
    expect_taken(command(Kind::pin, "2468"));
  }
  void to_work() {
    to_checking();
    EXPECT_TRUE(machine_.take_credentials());
    machine_.signed_in("Tom");
    machine_.offered(work_of(trial::Rig::palpation), now_);
  }
  void to_answer() {
    to_work();
    expect_taken(command(Kind::start));
    machine_.running({.t_s = 1.0});
    machine_.asked({trial::Rig::palpation, 0.05}, now_);
  }
  void wait_s(double s) {
    now_ += static_cast<core::Instant_ns>(s * 1e9);
    machine_.tick(now_);
  }
  Screen screen() const { return machine_.screen(); }

  Machine machine_{true};
  core::Instant_ns now_ = 5 * kSecond;
};

TEST_F(KioskMachine, ABadgeAndAPinGoToTheServerOnce) {
  EXPECT_EQ(screen(), Screen::badge);
  to_checking();
  EXPECT_EQ(screen(), Screen::checking);
  const auto given = machine_.take_credentials();
  ASSERT_TRUE(given);
  EXPECT_EQ(given->badge, "4711");
  EXPECT_EQ(given->pin, "2468");
  EXPECT_FALSE(machine_.take_credentials());
}

TEST_F(KioskMachine, ThePinIsNeverShown) {
  to_checking();
  EXPECT_EQ(machine_.to_json().dump().find("2468"), std::string::npos);
  const auto refused = Command::from_json({{"command", "pin"}, {"pin", "1357913579135791357"}});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().what.find("1357"), std::string::npos) << refused.error().what;
}

TEST_F(KioskMachine, AWrongPinAsksAgainAndALockedBadgeHasItsScreen) {
  for (int i = 0; i < 3; ++i) {
    if (i == 0) to_pin();
    expect_taken(command(Kind::pin, "1111"));
    machine_.sign_in_refused("Badge or PIN is wrong.", now_);
    EXPECT_EQ(screen(), Screen::pin);
    EXPECT_EQ(machine_.to_json()["notice"], "Badge or PIN is wrong.");
  }
  expect_taken(command(Kind::pin, "1111"));
  machine_.sign_in_failed(FaultKind::locked, "the server answers 429", now_);
  EXPECT_EQ(machine_.fault(), FaultKind::locked);
  expect_refused(command(Kind::retry));
  expect_taken(command(Kind::back));
  EXPECT_EQ(screen(), Screen::badge);
}

TEST_F(KioskMachine, SpeaksThePersonsLanguageUntilThePersonLeaves) {
  to_checking();
  machine_.signed_in("Tom", "de");
  machine_.offered(work_of(trial::Rig::palpation), now_);
  EXPECT_EQ(machine_.to_json()["language"], "de");
  expect_taken(command(Kind::sign_out));
  machine_.signed_out(now_);
  EXPECT_FALSE(machine_.to_json().contains("language"));
}

TEST_F(KioskMachine, ASecondStartIsRefused) {
  to_work();
  expect_taken(command(Kind::start));
  EXPECT_EQ(screen(), Screen::preparing);
  expect_refused(command(Kind::start));
  machine_.running({.t_s = 0.1});
  expect_refused(command(Kind::start));
  expect_refused(command(Kind::sign_out));
}

TEST_F(KioskMachine, ATrialFromStartToResult) {
  to_answer();
  EXPECT_EQ(machine_.to_json()["question"]["length_m"], 0.05);
  Command answer = command(Kind::answer);
  answer.answer = trial::Answer{.breach = true, .wall = "medial", .confidence = 0.75};
  expect_taken(answer);
  EXPECT_EQ(screen(), Screen::saving);
  EXPECT_EQ(machine_.answer()->wall, "medial");
  machine_.done({machine_.answer(), false, true}, now_);
  EXPECT_EQ(machine_.to_json()["outcome"]["sent"], true);
  expect_taken(command(Kind::next));
  EXPECT_EQ(screen(), Screen::preparing);
  machine_.offered(work_of(trial::Rig::palpation), now_);
  EXPECT_FALSE(machine_.answer()) << "the answer was of the trial before";
}

TEST_F(KioskMachine, AParticipantOfAStudyHasAPseudonymAndNoPin) {
  machine_.of_study();
  EXPECT_EQ(machine_.to_json()["study"], true);
  expect_taken(command(Kind::badge, "P01"));
  EXPECT_EQ(machine_.screen(), Screen::checking);
  EXPECT_EQ(machine_.take_credentials()->badge, "P01");
  machine_.sign_in_refused("No participant", now_);
  EXPECT_EQ(machine_.screen(), Screen::badge);
  EXPECT_EQ(machine_.to_json()["notice"], "No participant");
  EXPECT_EQ(machine_.to_json()["refused_badge"], "P01") << "the page says which number it was";
  expect_refused(command(Kind::pin, "2468"));
}

TEST_F(KioskMachine, ABlindTrialShowsNoDepth) {
  to_work();
  expect_taken(command(Kind::start));
  machine_.running({.t_s = 2.5});
  EXPECT_TRUE(machine_.to_json()["live"]["depth_m"].is_null());
  machine_.running({.t_s = 2.6, .depth_m = 0.012, .progress = 0.1});
  EXPECT_EQ(machine_.to_json()["live"]["depth_m"], 0.012);
}

TEST_F(KioskMachine, ATrialEndsWhenAPersonSaysSo) {
  to_work();
  expect_refused(command(Kind::end_trial));
  expect_taken(command(Kind::start));
  machine_.running({.t_s = 1.0});
  EXPECT_FALSE(machine_.ends_trial());
  expect_taken(command(Kind::end_trial));
  EXPECT_TRUE(machine_.ends_trial());
}

TEST_F(KioskMachine, EachFaultIsShownWithWhatMayBeDone) {
  using enum FaultKind;
  for (const FaultKind kind : {network, device, emergency_stop, stopped, work}) {
    SCOPED_TRACE(name(kind));
    to_work();
    expect_taken(command(Kind::start));
    machine_.failed(kind, "why", now_);
    EXPECT_EQ(machine_.to_json()["fault"]["kind"], name(kind));
    EXPECT_EQ(machine_.to_json()["fault"]["signed_in"], true);
    expect_refused(command(Kind::start));
    expect_refused(command(Kind::badge, "4712"));
    expect_taken(command(Kind::retry));
    EXPECT_EQ(screen(), Screen::preparing);
    machine_.failed(kind, "why", now_);
    expect_taken(command(Kind::sign_out));
    EXPECT_TRUE(machine_.leaves());
    machine_.signed_out(now_);
    EXPECT_EQ(screen(), Screen::badge);
  }
}

TEST_F(KioskMachine, AnInterruptedTrialIsSaidUntilSomebodyComes) {
  machine_.interrupted("1 trials, 4000 samples", now_);
  wait_s(3600.0);
  EXPECT_EQ(machine_.fault(), FaultKind::interrupted);
  to_pin();
  EXPECT_EQ(screen(), Screen::pin);
}

TEST_F(KioskMachine, WhoTouchesNothingIsSignedOutAndToldSo) {
  to_work();
  wait_s(119.0);
  EXPECT_FALSE(machine_.leaves());
  wait_s(2.0);
  EXPECT_TRUE(machine_.leaves());
  machine_.signed_out(now_);
  EXPECT_EQ(machine_.fault(), FaultKind::timed_out);
  EXPECT_EQ(machine_.to_json()["name"], "");
  wait_s(31.0);
  EXPECT_EQ(screen(), Screen::badge);
}

TEST_F(KioskMachine, APauseIsLongerAndComesBackToItsScreen) {
  to_work();
  expect_taken(command(Kind::pause));
  wait_s(600.0);
  EXPECT_FALSE(machine_.leaves());
  expect_refused(command(Kind::start));
  expect_taken(command(Kind::resume));
  EXPECT_EQ(screen(), Screen::work);
  expect_taken(command(Kind::pause));
  wait_s(901.0);
  EXPECT_TRUE(machine_.leaves());
}

TEST_F(KioskMachine, ATrialIsPausedAndGoesOnOrEnds) {
  to_work();
  expect_taken(command(Kind::start));
  machine_.running({.t_s = 1.0});
  EXPECT_FALSE(machine_.pauses_trial());
  expect_taken(command(Kind::pause));
  EXPECT_TRUE(machine_.pauses_trial());
  machine_.running({.t_s = 1.0});  // the session goes on telling
  EXPECT_EQ(screen(), Screen::paused);
  EXPECT_EQ(machine_.to_json()["in_trial"], true);
  expect_refused(command(Kind::sign_out));
  expect_refused(command(Kind::start));
  expect_taken(command(Kind::resume));
  EXPECT_EQ(screen(), Screen::running);
  EXPECT_FALSE(machine_.pauses_trial());
  expect_taken(command(Kind::pause));
  expect_taken(command(Kind::end_trial));
  EXPECT_TRUE(machine_.ends_trial());
  EXPECT_FALSE(machine_.pauses_trial());
}

TEST_F(KioskMachine, APauseOfATrialThatNobodyEndsEndsTheTrial) {
  to_work();
  expect_taken(command(Kind::start));
  machine_.running({.t_s = 1.0});
  expect_taken(command(Kind::pause));
  wait_s(899.0);
  EXPECT_FALSE(machine_.ends_trial());
  wait_s(2.0);
  EXPECT_TRUE(machine_.ends_trial());
  machine_.asked({trial::Rig::palpation, 0.05}, now_);
  wait_s(601.0);
  EXPECT_EQ(screen(), Screen::saving) << "kept without an answer";
  machine_.done({}, now_);
  EXPECT_TRUE(machine_.leaves());
}

TEST_F(KioskMachine, AResultComesToItsScreen) {
  to_answer();
  machine_.done({.answer = {}, .drilled = false, .sent = true}, now_);
  EXPECT_TRUE(machine_.to_json()["outcome"]["result"].is_null());
  machine_.result({.state = wire::ResultState::assessed,
                   .correct = true,
                   .scores = {{"Operation time", "s", "number", 12.5}}});
  const auto result = machine_.to_json()["outcome"]["result"];
  EXPECT_EQ(result["state"], "assessed");
  EXPECT_EQ(result["scores"][0]["value"], 12.5);
}

TEST_F(KioskMachine, AnUnansweredTrialIsKeptWithoutAnAnswer) {
  to_answer();
  wait_s(601.0);
  EXPECT_EQ(screen(), Screen::saving);
  EXPECT_FALSE(machine_.answer());
  machine_.done({std::nullopt, false, true}, now_);
  EXPECT_TRUE(machine_.leaves());
}

TEST_F(KioskMachine, TheTechniciansMenuIsBehindItsPin) {
  expect_refused(command(Kind::technician));  // no PIN was set: there is no menu
  machine_.technician_pin("8642");
  expect_taken(command(Kind::technician));
  expect_refused(command(Kind::self_test));
  expect_taken(command(Kind::pin, "8642"));
  EXPECT_EQ(screen(), Screen::technician);
  EXPECT_EQ(machine_.to_json().dump().find("8642"), std::string::npos);
  expect_taken(command(Kind::self_test));
  EXPECT_EQ(screen(), Screen::testing);
  expect_refused(command(Kind::back));
  expect_refused(command(Kind::badge, "1"));
  machine_.tested({{{"name", "disk"}, {"passed", true}}}, "", now_);
  EXPECT_EQ(machine_.to_json()["findings"][0]["name"], "disk");
  expect_taken(command(Kind::back));
  EXPECT_EQ(screen(), Screen::badge);
}

TEST_F(KioskMachine, ASelfTestWaitsForTheTechnicianAndIsStoppedByOne) {
  machine_.technician_pin("8642");
  expect_taken(command(Kind::technician));
  expect_taken(command(Kind::pin, "8642"));
  expect_refused(command(Kind::stop_test));
  expect_taken(command(Kind::self_test));
  expect_refused(command(Kind::confirm));  // nothing was asked
  machine_.instruct("Keep clear.", true);
  EXPECT_EQ(machine_.to_json()["test"], (core::Json{{"text", "Keep clear."}, {"waits", true}}));
  EXPECT_TRUE(machine_.waits_for_confirmation());
  expect_taken(command(Kind::confirm));
  EXPECT_FALSE(machine_.waits_for_confirmation());
  expect_taken(command(Kind::stop_test));
  EXPECT_TRUE(machine_.stops_test());
  machine_.tested(core::Json::array(), "stopped", now_);
  expect_taken(command(Kind::self_test));
  EXPECT_FALSE(machine_.stops_test()) << "the next test begins anew";
}

TEST_F(KioskMachine, ShowsTheTechnicianTheNewestLinesOfTheLog) {
  machine_.technician_pin("8642");
  for (int i = 1; i <= 10; ++i) machine_.log("line " + std::to_string(i));
  EXPECT_FALSE(machine_.to_json().contains("log")) << "not before the PIN";
  expect_taken(command(Kind::technician));
  expect_taken(command(Kind::pin, "8642"));
  const auto log = machine_.to_json()["log"];
  ASSERT_EQ(log.size(), Machine::kMostLines);
  EXPECT_EQ(log[0], "line 10");
}

TEST_F(KioskMachine, FiveWrongTechniciansPinsLockTheMenuForThreeMinutes) {
  machine_.technician_pin("8642");
  expect_taken(command(Kind::technician));
  for (int i = 0; i < 5; ++i) expect_taken(command(Kind::pin, "1111"));
  EXPECT_EQ(machine_.fault(), FaultKind::locked);
  expect_taken(command(Kind::back));
  wait_s(179.0);
  expect_taken(command(Kind::technician));
  EXPECT_EQ(machine_.fault(), FaultKind::locked);
  expect_taken(command(Kind::back));
  wait_s(2.0);
  expect_taken(command(Kind::technician));
  expect_taken(command(Kind::pin, "8642"));
  EXPECT_EQ(screen(), Screen::technician);
}

TEST_F(KioskMachine, ARunningTrialHasNoTimeOut) {
  to_work();
  expect_taken(command(Kind::start));
  machine_.running({.t_s = 1.0});
  wait_s(36'000.0);
  EXPECT_EQ(screen(), Screen::running);
  EXPECT_FALSE(machine_.leaves());
}

TEST_F(KioskMachine, APinThatIsNotTypedGoesBackToTheBadge) {
  to_pin();
  wait_s(46.0);
  EXPECT_EQ(screen(), Screen::badge);
  expect_refused(command(Kind::pin, "2468"));
}

TEST(KioskCommand, IsReadStrictly) {
  const auto read = [](const char* text) {
    return Command::from_json(*core::parse_json(text, "command"));
  };
  EXPECT_TRUE(read(R"({"command":"start"})"));
  EXPECT_FALSE(read(R"({"command":"begin"})"));
  EXPECT_FALSE(read(R"({"command":"start","more":1})"));
  EXPECT_FALSE(read(R"({"command":"badge"})"));
  EXPECT_TRUE(read(R"({"command":"answer","answer":{"breach":true,"wall":"medial"}})"));
  EXPECT_FALSE(read(R"({"command":"answer","answer":{"breach":true,"wall":"roof"}})"));
  EXPECT_FALSE(read(R"({"command":"answer","answer":{"breach":false,"wall":"medial"}})"));
}

TEST(KioskDesk, WakesTheSessionAndTellsThePage) {
  core::ManualClock clock;
  Desk desk(clock, Machine(true));
  std::string shown;
  desk.listen([&](const std::string& text) { shown = text; });
  EXPECT_NE(shown.find(R"("screen":"badge")"), std::string::npos);
  std::thread page([&] { ASSERT_TRUE(desk.take(command(Kind::badge, "1"))); });
  const bool came =
      desk.wait([](const Machine& m) { return m.screen() == Screen::pin; }, [] { return false; });
  page.join();
  EXPECT_TRUE(came);
  EXPECT_NE(shown.find(R"("screen":"pin")"), std::string::npos);
  EXPECT_FALSE(desk.wait([](const Machine&) { return false; }, [] { return true; }));
}

}  // namespace
}  // namespace tractus::kiosk
