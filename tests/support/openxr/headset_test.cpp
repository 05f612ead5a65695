/// The station's headset against the test runtime: its life, its faults. The runtime holds every
/// call against the specification; what it finds fails the test.
#include "station/headset/headset_thread.hpp"
#include "tests/support/openxr/headset_fixture.hpp"

namespace tractus {
namespace headset {
namespace {

TEST_F(WithRuntime, LivesFromReadyToExitingInGoodOrder) {
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  EXPECT_EQ(headset->seen(), DisplayState::waiting);
  ASSERT_TRUE(step_to(*headset, *control_, 60));
  EXPECT_EQ(headset->seen(), DisplayState::shown);
  const Figures figures = headset->figures();
  EXPECT_EQ(figures.frames, control_->shown);
  EXPECT_GE(figures.frames, 57u);  // the first are before anybody sees them
  EXPECT_EQ(figures.dropped, 0u);
  EXPECT_EQ(figures.untracked, 0u);
  EXPECT_NEAR(figures.rate_Hz, 90.0, 1e-3);
  EXPECT_TRUE(figures.simulated);
  EXPECT_TRUE(figures.aligned);
  EXPECT_EQ(figures.runtime, "Tractus test runtime, SIMULATED");
  EXPECT_EQ(control_->binding, on_x_ ? 1 : 2);
  EXPECT_EQ(control_->swapchains, 2u);
  EXPECT_TRUE(left(*headset));
  EXPECT_EQ(headset->seen(), DisplayState::over);
  headset.reset();
  EXPECT_EQ(control_->sessions_ended, 1u);
}

TEST_F(WithRuntime, SaysThatTrackingIsLostAndGoesOnWhenItIsBack) {
  control_->untracked_from = 20;
  control_->untracked_to = 30;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 25));
  EXPECT_EQ(headset->seen(), DisplayState::tracking_lost);
  ASSERT_TRUE(step_to(*headset, *control_, 40));
  EXPECT_EQ(headset->seen(), DisplayState::shown);
  EXPECT_EQ(headset->figures().untracked, 11u);
  EXPECT_EQ(control_->in_head, 11u);  // words that hang before the head
  EXPECT_TRUE(left(*headset));
}

TEST_F(WithRuntime, ALostSessionEndsTheView) {
  control_->lose_session_at = 15;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  EXPECT_FALSE(step_to(*headset, *control_, 40));
  EXPECT_EQ(headset->seen(), DisplayState::over);
  EXPECT_EQ(headset->why(), "the runtime lost the session");
  headset.reset();
  EXPECT_EQ(control_->sessions_ended, 1u);
  // A later trial finds a headset again.
  control_->lose_session_at = 0;
  headset = made(shown());
  ASSERT_TRUE(headset);
  EXPECT_TRUE(step_to(*headset, *control_, 60));
  EXPECT_TRUE(left(*headset));
}

TEST_F(WithRuntime, ACallThatAnswersSessionLostEndsTheView) {
  control_->call_fails_at = 15;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  EXPECT_FALSE(step_to(*headset, *control_, 40));
  EXPECT_NE(headset->why().find("XR_ERROR_SESSION_LOST"), std::string::npos) << headset->why();
}

TEST_F(WithRuntime, ARuntimeThatEndsEndsTheView) {
  control_->lose_instance_at = 15;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  EXPECT_FALSE(step_to(*headset, *control_, 40));
  EXPECT_EQ(headset->why(), "the runtime itself is ending");
}

TEST_F(WithRuntime, FramesThatWereDueAndNotMadeAreCounted) {
  control_->late_at = 20;
  control_->late_by = 5;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 40));
  EXPECT_EQ(headset->figures().dropped, 5u);
  EXPECT_TRUE(left(*headset));
}

TEST_F(WithRuntime, TakenOffItWaitsAndPutOnAgainItShows) {
  control_->take_off_at = 20;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  bool waited = false;
  for (int i = 0; i < 200 && control_->frames < 60; ++i) {
    ASSERT_TRUE(headset->step());
    waited |= control_->frames >= 20 && headset->seen() == DisplayState::waiting;
  }
  EXPECT_TRUE(waited);
  EXPECT_EQ(headset->seen(), DisplayState::shown);
  EXPECT_EQ(headset->figures().dropped, 0u);
  EXPECT_TRUE(left(*headset));
}

TEST_F(WithRuntime, APersonMayEndItAtTheHeadset) {
  control_->quit_at = 20;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  EXPECT_FALSE(step_to(*headset, *control_, 60));
  EXPECT_EQ(headset->why(), "ended at the headset");
}

TEST_F(WithRuntime, EveryWayToHaveNoHeadsetHasItsOwnLine) {
  control_->no_system = 1;
  EXPECT_NE(why_not().find("sees no headset"), std::string::npos) << why_not();
  control_->no_system = 0;
  control_->refuse_graphics = 1;
  EXPECT_NE(why_not().find("XR_ERROR_GRAPHICS_DEVICE_INVALID"), std::string::npos) << why_not();
  control_->refuse_graphics = 0;
  control_->offer_opengl = 0;
  EXPECT_NE(why_not().find("takes no OpenGL"), std::string::npos) << why_not();
  forget_runtime();
  ::setenv("XR_RUNTIME_JSON", "/nowhere/runtime.json", 1);
  EXPECT_NE(why_not().find("no OpenXR runtime answers"), std::string::npos) << why_not();
  EXPECT_EQ(why_not().find('\n'), std::string::npos);
}

TEST_F(WithRuntime, OpenGlOnXAloneAsksForADisplay) {
  if (on_x_) GTEST_SKIP() << "there is a display";
  control_->offer_egl = 0;
  EXPECT_NE(why_not().find("set DISPLAY"), std::string::npos) << why_not();
}

TEST_F(WithRuntime, AnAlignmentIsOfTheStageAndNotUsedWithoutIt) {
  control_->offer_stage = 0;
  auto headset = made(shown());
  ASSERT_TRUE(headset);
  ASSERT_TRUE(step_to(*headset, *control_, 10));
  EXPECT_FALSE(headset->figures().aligned);
  EXPECT_EQ(headset->seen(), DisplayState::shown);
  EXPECT_TRUE(left(*headset));
}

TEST_F(WithRuntime, InAThreadOfItsOwnItShowsAndEndsInGoodOrder) {
  auto thread = HeadsetThread::start(shown());
  ASSERT_TRUE(thread) << thread.error().what;
  EXPECT_TRUE((*thread)->wait_until_seen(std::chrono::seconds(30)));
  const Figures& figures = (*thread)->end();
  EXPECT_GT(figures.frames, 0u);
  EXPECT_EQ(figures.ended, "");
  EXPECT_EQ((*thread)->end().frames, figures.frames);
  thread->reset();
  EXPECT_EQ(control_->sessions_ended, 1u);
}

TEST_F(WithRuntime, InAThreadOfItsOwnItSaysWhyItEndedBefore) {
  control_->lose_session_at = 6;
  auto thread = HeadsetThread::start(shown());
  ASSERT_TRUE(thread);
  while ((*thread)->seen() != DisplayState::over) std::this_thread::yield();
  EXPECT_EQ((*thread)->end().ended, "the runtime lost the session");
}

}  // namespace
}  // namespace headset
}  // namespace tractus
