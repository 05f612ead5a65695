#include "station/loop/periodic_loop.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "station/loop/allocation_guard.hpp"
#include "station/loop/loop_test_support.hpp"
#include "station/loop/loop_thread.hpp"

namespace tractus {
namespace loop {
namespace {
constexpr double kRate_Hz = 4000.0;
constexpr core::Instant_ns kLoopPeriod = 250'000, kStart = 7'000'000'000;

struct PeriodicBench {
  StumblingClock clock;
  PeriodicLoop loop{clock, kRate_Hz};
  std::vector<PeriodicLoop::Tick> ticks;

  /// @param work_ns  how long each tick takes
  void ticks_until(std::size_t count, const std::vector<core::Instant_ns>& work_ns = {}) {
    loop.run(
        [&](const PeriodicLoop::Tick& tick) {
          ticks.push_back(tick);
          if (ticks.size() <= work_ns.size()) clock.advance(work_ns[ticks.size() - 1]);
          loop.count(tick.late ? trial::kLate : 0, true);
          if (ticks.size() == count) loop.stop();
        },
        [] { return true; });
  }
};

TEST(PeriodicLoop, KeepsDeadlinesThatAreMultiplesOfThePeriodFromTheStart) {
  PeriodicBench run;
  run.clock.late_ns = {10'000, 0, 60'000, 20'000};  // none by a quarter of 250 µs
  run.ticks_until(5, {0, 100'000, 0, 200'000});
  ASSERT_EQ(run.ticks.size(), 5u);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_EQ(run.ticks[k].deadline, kStart + core::Instant_ns(k) * kLoopPeriod);
    EXPECT_EQ(run.ticks[k].number, k);
    EXPECT_FALSE(run.ticks[k].late);
  }
  EXPECT_EQ(run.ticks[2].now, kStart + 2 * kLoopPeriod + 60'000);
  EXPECT_EQ(run.loop.started(), kStart);
  EXPECT_EQ(run.loop.counts().late, 0u);
  EXPECT_EQ(run.loop.counts().skipped, 0u);
}

TEST(PeriodicLoop, CallsATickLateThatWokeMoreThanAQuarterPeriodAfterItsDeadline) {
  PeriodicBench run;
  run.clock.late_ns = {0, 62'500, 62'501, 0};  // a quarter of 250 µs is 62.5
  run.ticks_until(4);
  EXPECT_FALSE(run.ticks[1].late);
  EXPECT_TRUE(run.ticks[2].late);
  EXPECT_FALSE(run.ticks[3].late);
  EXPECT_EQ(run.loop.counts().samples, 4u);
  EXPECT_EQ(run.loop.counts().late, 1u);
}

TEST(PeriodicLoop, MeasuresLatenessWhenItWokeAlsoAfterATickThatTookTooLong) {
  PeriodicBench run;
  run.ticks_until(3, {350'000});  // ends 100 µs after the second deadline
  EXPECT_TRUE(run.ticks[1].late);
  EXPECT_EQ(run.ticks[1].now, kStart + 350'000);
  EXPECT_EQ(run.ticks[2].deadline, kStart + 2 * kLoopPeriod);
  EXPECT_FALSE(run.ticks[2].late);
  EXPECT_EQ(run.loop.counts().skipped, 0u);
}

TEST(PeriodicLoop, SkipsDeadlinesThatPassedWholeAndNeverChasesThem) {
  PeriodicBench run;
  run.clock.late_ns = {0, 1'100'000};  // the second tick wakes 4.4 periods late
  run.ticks_until(4);
  EXPECT_EQ(run.ticks[1].number, 1u);
  EXPECT_EQ(run.ticks[2].number, 6u);  // 2 to 5 passed whole
  EXPECT_EQ(run.ticks[2].deadline, kStart + 6 * kLoopPeriod);
  EXPECT_EQ(run.ticks[2].now, run.ticks[2].deadline);
  EXPECT_EQ(run.ticks[3].number, 7u);
  EXPECT_EQ(run.loop.counts().skipped, 4u);
  EXPECT_DOUBLE_EQ(run.loop.passed_s(), 8.0 / kRate_Hz);  // four ticked, four skipped
}

TEST(PeriodicLoop, EndsWithTheTickInWhichItIsStopped) {
  PeriodicBench run;
  run.ticks_until(3);
  EXPECT_EQ(run.ticks.size(), 3u);
  run.ticks_until(9);  // stopped once is stopped
  EXPECT_EQ(run.ticks.size(), 3u);
}

TEST(PeriodicLoop, EndsWithoutASkipWhenItIsNotToGoOn) {
  PeriodicBench run;
  run.clock.late_ns = {0, 1'100'000};
  run.loop.run([&](const PeriodicLoop::Tick& tick) { run.ticks.push_back(tick); },
               [&] { return run.ticks.size() < 2; });
  EXPECT_EQ(run.ticks.size(), 2u);
  EXPECT_EQ(run.loop.counts().skipped, 0u);
}

TEST(PeriodicLoop, TimesTheTickAndNotWhatFollowsIt) {
  PeriodicBench run;
  run.loop.run([&](const PeriodicLoop::Tick&) { run.clock.advance(20'500); },
               [&] {
                 run.clock.advance(100'000);
                 return run.clock.now() < kStart + 100 * kLoopPeriod;
               });
  EXPECT_EQ(run.loop.work().quantile_us(0.99), 21.0);
  EXPECT_EQ(run.loop.wake().quantile_us(0.99), 1.0);
}

TEST(PeriodicLoop, CountsASampleThatWasNotKept) {
  core::ManualClock clock;
  PeriodicLoop loop(clock, kRate_Hz);
  loop.count(trial::kLimited | trial::kStale, true);
  loop.count(trial::kNotConverged, false);
  EXPECT_EQ(loop.counts().samples, 2u);
  EXPECT_EQ(loop.counts().limited, 1u);
  EXPECT_EQ(loop.counts().stale, 1u);
  EXPECT_EQ(loop.counts().not_converged, 1u);
  EXPECT_EQ(loop.lost(), 1u);
}

TEST(PeriodicLoop, AllocatesNothing) {
  core::ManualClock clock;
  PeriodicLoop loop(clock, kRate_Hz);
  const AllocationGuard guard;
  int left = 2000;
  loop.run([&](const PeriodicLoop::Tick& tick) { loop.count(tick.late ? 1 : 0, true); },
           [&] { return --left > 0; });
  EXPECT_EQ(guard.allocations(), 0u);
}

TEST(LoopThread, RunsAfterGoAndSaysWhenItHasEnded) {
  int ran = 0;
  LoopThread thread(Pace::as_fast_as_goes, [&] { ++ran; });
  EXPECT_FALSE(thread.ended_within(std::chrono::milliseconds(1)));
  thread.go();
  while (!thread.ended_within(std::chrono::milliseconds(10))) {
  }
  thread.join();
  EXPECT_EQ(ran, 1);
  EXPECT_FALSE(thread.grant().fifo);  // not asked for
  EXPECT_TRUE(thread.grant().warnings.empty());
}

TEST(LoopThread, WithoutGoNothingRuns) {
  int ran = 0;
  {
    const LoopThread thread(Pace::as_fast_as_goes, [&] { ++ran; });
  }
  EXPECT_EQ(ran, 0);
}

TEST(TimeHistogram, GivesTheUpperEdgeOfTheQuantilesBin) {
  TimeHistogram histogram;
  for (int i = 0; i < 100; ++i) histogram.add(i * 1000 + 500);
  EXPECT_EQ(histogram.quantile_us(0.5), 50.0);
  EXPECT_EQ(histogram.quantile_us(0.99), 99.0);
}

}  // namespace
}  // namespace loop
}  // namespace tractus
