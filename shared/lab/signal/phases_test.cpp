#include "lab/signal/phases.hpp"

#include <gtest/gtest.h>

namespace tractus {
namespace lab {
namespace {

std::string phase(const Courses& c, std::size_t k) {
  return kProbingPhases[std::size_t(c.phase[k])];
}

/// 1 s in at 10 mm/s, 1 s at rest, 1 s out, at 100 Hz.
struct Motion {
  std::vector<double> t_s, v_m_s;
  Motion() {
    for (int k = 0; k < 300; ++k) {
      t_s.push_back(0.01 * k);
      v_m_s.push_back(k < 100 ? 0.01 : k < 200 ? 0.0 : -0.01);
    }
  }
};

TEST(Phases, NameWhatTheHandDoes) {
  const Motion motion;
  const Courses out = courses(motion.t_s, motion.v_m_s, {});
  EXPECT_EQ(phase(out, 50), "advance");
  EXPECT_EQ(phase(out, 150), "hold");
  EXPECT_EQ(phase(out, 205), "reversal");  // 50 ms after the direction changed
  EXPECT_EQ(phase(out, 250), "retract");
  EXPECT_EQ(kDirections[std::size_t(out.direction[150])], "still");
  EXPECT_NEAR(out.since_reversal_s[250], 0.5, 1e-6);
}

TEST(Phases, ABorderBeingPassedComesFirst) {
  const Motion motion;
  std::vector<double> crossing(300, 0.0);
  crossing[205] = 1.0;
  EXPECT_EQ(phase(courses(motion.t_s, motion.v_m_s, crossing), 205), "layer crossing");
}

// Going on in the same direction after a rest is no reversal.
TEST(Phases, ARestIsNoReversal) {
  Motion motion;
  for (std::size_t k = 200; k < 300; ++k) motion.v_m_s[k] = 0.01;
  const Courses out = courses(motion.t_s, motion.v_m_s, {});
  EXPECT_EQ(phase(out, 205), "advance");
}

TEST(Phases, NameWhatAPalpatingHandDoes) {
  const std::vector<double> force{0.01, 1.0, 1.0, 1.0}, speed{0.02, 0.001, 0.02, 0.02},
      along{0.0, 0.0, 0.002, -0.019};
  const auto out = palpation_phases(force, speed, along, 0.01);
  const std::vector<std::string> expected{"free", "contact", "sliding", "pressing"};
  for (std::size_t k = 0; k < out.size(); ++k)
    EXPECT_EQ(kPalpationPhases[std::size_t(out[k])], expected[k]);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
