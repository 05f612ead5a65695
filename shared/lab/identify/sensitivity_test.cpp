#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lab/identify/diagnosis.hpp"
#include "lab/rigs/probing/problem.hpp"

namespace tractus {
namespace lab {
namespace {

/// Six trials of 8 s at 500 Hz in one layer, 4000 N/m and 2000 N·s/m about 6 mm, noise of 0.05 N, with a dry friction of
/// `friction_N`; written down here.
trial::ProbingSet recorded_with_friction(double friction_N) {
  trial::ProbingSet set;
  set.folder = "set";
  std::mt19937_64 random(11);
  std::normal_distribution<double> noise;
  for (int k = 0; k < 6; ++k) {
    trial::ProbingMeasurement t;
    t.id = t.file = std::string("t") + char('1' + k);
    for (int i = 0; i < 4000; ++i) {
      const double s = 0.002 * i, w = 1.1 + 0.3 * k;
      const double x = 0.012 + 0.007 * std::sin(w * s) + 0.002 * std::sin(4.3 * s + k);
      const double v = 0.007 * w * std::cos(w * s) + 0.0086 * std::cos(4.3 * s + k);
      t.t_s.push_back(s);
      t.x_m.push_back(x + 2e-7 * noise(random));
      t.fz_N.push_back(4000.0 * (x - 0.006) + 2000.0 * v + (v > 0.0 ? friction_N : -friction_N) +
                       0.05 * noise(random));
    }
    set.trials.push_back(std::move(t));
  }
  return set;
}

Diagnosis diagnosed_with(double friction_N) {
  models::ProbingModel model;
  model.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.006}};
  const auto problem =
      make_probing_problem(model, recorded_with_friction(friction_N), {.threads = 2});
  EXPECT_TRUE(problem) << problem.error().what;
  const auto found = diagnose(**problem, {.threads = 2});
  EXPECT_TRUE(found) << found.error().what;
  return *found;
}

/// The limit that a set without friction states for it.
double friction_limit_N() {
  const Diagnosis nothing = diagnosed_with(0.0);
  EXPECT_EQ(nothing.verdict, Verdict::complete);
  for (const Ranked& ranked : nothing.ranking)
    for (const DetectionLimit& limit : ranked.detection_limits)
      if (ranked.id == "coulomb_friction" && limit.parameter == "friction_N" && limit.value)
        return *limit.value;
  ADD_FAILURE() << "no limit stated";
  return 0.0;
}

TEST(DetectionLimit, FrictionIsNamedAboveItAndNotBelow) {
  const double limit_N = friction_limit_N();
  EXPECT_GT(limit_N, 0.0);
  EXPECT_LT(limit_N, 0.05);  // the noise of one of 24 000 samples
  const auto names_friction = [](const Diagnosis& d) {
    return d.effects.size() == 1 && d.effects.front().id == "coulomb_friction";
  };
  EXPECT_TRUE(names_friction(diagnosed_with(1.3 * limit_N)));
  EXPECT_FALSE(names_friction(diagnosed_with(0.7 * limit_N)));
}

}  // namespace
}  // namespace lab
}  // namespace tractus
