/// Scenarios and models out of seeds against the local clamp: some here, a million by
/// `safety_fuzz`.
#include <gtest/gtest.h>

#include "tests/fuzz/safety_scenarios.hpp"

namespace tractus {
namespace fuzz {
namespace {

TEST(Safety, NoFuzzedScenarioOrHandOnTheRigExceedsTheClamp) {
  int made = 0, moved = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    const Outcome out = run_probing(seed);
    ASSERT_EQ(out.broken, "") << "seed " << seed;
    made += out.made;
    moved += out.moved;
  }
  EXPECT_GT(made, 1450);  // the draw finds valid ones
  EXPECT_GT(moved, 500);  // and they are felt
}

TEST(Safety, NoFuzzedPalpationModelExceedsTheClampOrTheSlew) {
  const Palpation palpation;
  int made = 0, moved = 0, at_the_limit = 0;
  for (std::uint64_t seed = 1; seed <= 1500; ++seed) {
    const Outcome out = palpation.run(seed);
    ASSERT_EQ(out.broken, "") << "seed " << seed;
    made += out.made;
    moved += out.moved;
    at_the_limit += out.highest > 0.999;
  }
  EXPECT_GT(made, 1400);
  EXPECT_GT(moved, 700);
  EXPECT_GT(at_the_limit, 50);  // the clamp was needed
}

}  // namespace
}  // namespace fuzz
}  // namespace tractus
