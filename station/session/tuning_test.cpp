#include "station/session/tuning.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tractus {
namespace session {
namespace {
using scenarios::Kind;

Tuning tuning() { return Tuning(*scenarios::tuned(Kind::lateral_breach)); }

TEST(Tuning, NudgesEachOfTheEightByFivePerCentOrItsLeastStep) {
  const auto& all = Tuning::parameters();
  for (std::size_t k = 0; k < all.size(); ++k) {
    Tuning t = tuning();
    const double before = t.value(k);
    const auto down = t.nudge(k, -1);
    ASSERT_TRUE(down) << all[k].field << ": " << down.error().what;
    EXPECT_NEAR(before - t.value(k), std::max(0.05 * std::abs(before), all[k].least_step), 1e-12)
        << all[k].field;
    const core::Json json = t.now().to_json();
    EXPECT_EQ(json.at(core::Json::json_pointer(std::string("/") + all[k].field)), t.value(k));
  }
}

TEST(Tuning, RefusesByNameWhatNoScenarioMayBeAndStaysAsItWas) {
  Tuning t = tuning();
  core::Result<void> last;
  int steps = 0;
  while (last && steps++ < 200) last = t.nudge(2, +1);  // x0 may not lie behind a layer's start
  ASSERT_FALSE(last);
  EXPECT_THAT(last.error().what, testing::HasSubstr("/bone/equilibrium_m"));
  EXPECT_LE(t.value(2), 0.0);
  EXPECT_TRUE(t.now().check());
}

TEST(Tuning, TakesNudgesBackOneByOne) {
  Tuning t = tuning();
  const double first = t.value(0);
  ASSERT_TRUE(t.nudge(0, +1));
  const double second = t.value(0);
  ASSERT_TRUE(t.nudge(0, +1));
  EXPECT_TRUE(t.undo());
  EXPECT_EQ(t.value(0), second);
  EXPECT_TRUE(t.undo());
  EXPECT_EQ(t.value(0), first);
  EXPECT_FALSE(t.undo());
}

TEST(Tuning, SavesANewVersionWithWhoWhenAndTheParent) {
  Tuning t = tuning();
  const std::string parent = t.now().id();
  EXPECT_FALSE(t.save("Dr. A", 1'772'366'400'000'000));  // nothing changed
  ASSERT_TRUE(t.nudge(1, +1));
  EXPECT_FALSE(t.save("", 1'772'366'400'000'000));
  const auto saved = t.save("Dr. A", 1'772'366'400'000'000);
  ASSERT_TRUE(saved) << saved.error().what;
  EXPECT_EQ(saved->origin.who, "Dr. A");
  EXPECT_EQ(saved->origin.when, "2026-03-01T12:00:00.000000Z");
  EXPECT_EQ(saved->origin.parent, parent);
  EXPECT_NE(saved->id(), parent);
  ASSERT_TRUE(t.nudge(1, +1));
  EXPECT_EQ(t.save("Dr. A", 1'772'366'401'000'000)->origin.parent, saved->id());
}

}  // namespace
}  // namespace session
}  // namespace tractus
