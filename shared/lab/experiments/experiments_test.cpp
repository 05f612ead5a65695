#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lab/experiments/preposterior.hpp"
#include "lab/experiments/probing_programs.hpp"
#include "lab/rigs/probing/problem.hpp"

namespace tractus {
namespace lab {
namespace {

/// Strokes in one layer, 4000 N/m about 6 mm and 2000 N·s/m, all at one speed: a drag of that speed and a dry friction look
/// alike. The hidden force is the friction. Written down here.
trial::ProbingSet strokes_at_one_speed() {
  trial::ProbingSet set;
  set.folder = "set";
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise;
  for (int k = 0; k < 4; ++k) {
    trial::ProbingMeasurement t;
    t.id = t.file = std::string("t") + char('1' + k);
    for (int i = 0; i < 4000; ++i) {
      const double s = 0.002 * i, phase = s - 2.0 * std::floor(s / 2.0);
      const double v = phase < 1.0 ? 0.008 : -0.008;
      const double x = 0.004 + 0.008 * (phase < 1.0 ? phase : 2.0 - phase) + 0.0005 * k;
      t.t_s.push_back(s);
      t.x_m.push_back(x + 2e-7 * noise(random));
      t.fz_N.push_back(4000.0 * (x - 0.006) + 2000.0 * v + (v > 0.0 ? 0.8 : -0.8) +
                       0.05 * noise(random));
    }
    set.trials.push_back(std::move(t));
  }
  return set;
}

TEST(ProbingPrograms, StayWithinWhatWasReached) {
  for (const trial::MotionProgram& program : probing_programs({0.002, 0.03, 0.08, true})) {
    EXPECT_GT(program.seconds(), 5.0) << program.name;
    EXPECT_LT(program.seconds(), 60.0) << program.name;
    const auto motion = program.motion(1e-3);
    for (std::size_t i = 0; i < motion.size(); ++i) {
      EXPECT_GE(motion.x_m[i], 0.002 - 1e-9) << program.name;
      EXPECT_LE(motion.x_m[i], 0.03 + 1e-9) << program.name;
      EXPECT_LE(std::abs(motion.v_m_s[i]), 0.08 + 1e-9) << program.name;
    }
    EXPECT_TRUE(trial::MotionProgram::from_json(program.to_json(), "")) << program.name;
  }
}

TEST(Preposterior, StrokesOfSeveralSpeedsTellFrictionFromDrag) {
  models::ProbingModel model;
  model.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.006}};
  const auto set = strokes_at_one_speed();
  const auto problem = make_probing_problem(model, set, {.threads = 2});
  ASSERT_TRUE(problem) << problem.error().what;
  // The two readings that such strokes leave open, with equal chances.
  Diagnosis undecided;
  undecided.final_fit.noise_floor = 0.05;
  const auto values_of = [&](const Structure& structure) {
    const auto fitted = fit(**problem, structure, {.threads = 2});
    EXPECT_TRUE(fitted) << fitted.error().what;
    return fitted->values;
  };
  for (const Structure& structure : {Structure{{"coulomb_friction"}}, Structure{{}}})
    undecided.hypotheses.push_back({structure, 0.5, 0.5, values_of(structure)});
  const auto programs =
      weigh_programs(**problem, undecided, model, set, {.threads = 2, .draws = 1, .shortlist = 2});
  ASSERT_TRUE(programs) << programs.error().what;
  ASSERT_EQ(programs->size(), 2u);
  EXPECT_GT(programs->front().expected_gain, 0.3);
  EXPECT_LE(programs->front().expected_gain, 0.5);  // from one half no probability rises by more
  EXPECT_GE(programs->front().gain_per_minute, programs->back().gain_per_minute);
}

TEST(Preposterior, OneStructureLeftNeedsNoRecording) {
  models::ProbingModel model;
  model.layers = {{0.0, 0.05, 4000.0, 2000.0, 0.006}};
  const auto set = strokes_at_one_speed();
  const auto problem = make_probing_problem(model, set, {.threads = 2});
  ASSERT_TRUE(problem);
  Diagnosis decided;
  decided.hypotheses.push_back({{{"coulomb_friction"}}, 0.99, 0.99, {}});
  const auto programs = weigh_programs(**problem, decided, model, set);
  ASSERT_TRUE(programs);
  EXPECT_TRUE(programs->empty());
}

}  // namespace
}  // namespace lab
}  // namespace tractus
