#include "server/api/trials/trial_views.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace tractus {
namespace api {
namespace {

/// 100 samples: 5200 bytes.
core::Result<trial::Signals> hundred() {
  trial::Signals signals(trial::Header{}, std::nullopt);
  signals.add({std::vector<trial::Sample>(100), {}});
  return signals;
}

TEST(TrialViews, KeepWithinTheirLimitTheMostRecent) {
  TrialViews views(2 * 5200);
  int decoded = 0;
  const auto decode = [&] { return ++decoded, hundred(); };
  for (const char* id : {"a", "b", "a", "c", "a", "b"}) ASSERT_TRUE(views.of(id, decode));
  EXPECT_EQ(decoded, 4);  // a, b, c, and b again: it was the oldest when c came
  EXPECT_EQ(views.bytes(), 2u * 5200);
}

TEST(TrialViews, OneThatFailsIsNotKept) {
  TrialViews views;
  ASSERT_FALSE(views.of("a", [] {
    return core::Result<trial::Signals>(core::Error{core::Errc::io, "broken"});
  }));
  EXPECT_TRUE(views.of("a", hundred));
}

TEST(TrialViews, ManyAtOnceDecodeOnce) {
  TrialViews views;
  std::atomic<int> decoded = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 8; ++i)
    threads.emplace_back([&] { EXPECT_TRUE(views.of("a", [&] { return ++decoded, hundred(); })); });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(decoded, 1);
}

}  // namespace
}  // namespace api
}  // namespace tractus
