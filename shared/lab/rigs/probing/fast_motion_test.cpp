/// An oscillation that is fast against the length of a recording: what is missing must be seen to follow its velocity.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "lab/identify/fit_report.hpp"
#include "lab/identify/residual_dependence.hpp"
#include "lab/rigs/probing/problem.hpp"

namespace tractus {
namespace lab {
namespace {

TEST(ResidualDependence, OfAFastOscillationFollowsItsVelocity) {
  // 70 Hz at 3 kHz for 8 s: 10 ms of it, a 800th of the recording, are most of a period.
  constexpr double kRate_Hz = 3000.0, kSpeed_m_s = 0.044, kSize_N = 1.0;
  std::mt19937_64 random(7);
  std::normal_distribution<> normal;
  trial::ProbingSet set;
  for (int k = 0; k < 4; ++k) {
    trial::ProbingMeasurement m;
    m.id = std::to_string(k);
    m.file = m.id + ".csv";
    const double w = 2.0 * std::numbers::pi * (70.0 + 3.0 * k);
    for (int i = 0; i < int(8.0 * kRate_Hz); ++i) {
      const double t = i / kRate_Hz, x = kSpeed_m_s / w * std::sin(w * t),
                   v = kSpeed_m_s * std::cos(w * t);
      m.t_s.push_back(t);
      m.x_m.push_back(0.02 + x + 1e-9 * normal(random));
      m.fz_N.push_back(3000.0 * (0.02 + x) + 50.0 * v + kSize_N * std::pow(v / kSpeed_m_s, 3) +
                       0.05 * normal(random));
    }
    set.trials.push_back(std::move(m));
  }
  models::ProbingModel model;
  model.name = "one layer";
  model.layers = {{0.0, 0.04, 3100.0, 45.0, 0.0}};
  const auto problem = make_probing_problem(model, std::move(set));
  ASSERT_TRUE(problem) << problem.error().what;
  const Residual residual(**problem, 1);
  const ResidualDependence found = residual_dependence(residual, fit_base(residual));
  EXPECT_TRUE(found.words.starts_with("velocity")) << found.words;
  // cos³ = ¾ cos + ¼ cos 3: a quarter is no damping's, 0.031 N² beside 0.0025 N² of noise. The mean over three samples, 1.3 rad
  // of the third harmonic, has sin(0.66)/0.66 = 0.93 of it.
  EXPECT_NEAR(found.predictable, 0.93 * 0.93 * 0.031 / (0.031 + 0.0025), 0.05);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
