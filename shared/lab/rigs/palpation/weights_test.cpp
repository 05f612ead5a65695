#include "lab/rigs/palpation/weights.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "lab/rigs/palpation/noise.hpp"

namespace tractus {
namespace lab {
namespace {

using math::Vec3;

/// A ridge of bone 4 mm wide along x and z, voxels of 1 mm, V centred.
volume::Volume ridge() {
  volume::Volume v;
  v.geometry = {
      {40, 40, 40}, Vec3::Constant(1e-3), Vec3::Constant(-0.0195), volume::Mat3::Identity()};
  v.counts.assign(v.geometry.voxel_count(), 0);
  for (int k = 0; k < 40; ++k)
    for (int j = 18; j < 22; ++j)
      for (int i = 0; i < 40; ++i) v.counts[v.offset(i, j, k)] = 1000;
  return v;
}

const models::PalpationRuntime& runtime() {
  static const auto made = models::PalpationRuntime::make(models::PalpationModel{}, ridge());
  EXPECT_TRUE(made);
  return *made;
}

/// The handle over the ridge from y = −6 mm to 6 mm; what was measured is what
/// the law says, from the start on or from the end, with a sensor's noise of 0.01 N.
trial::PalpationMeasurement over_the_ridge(bool from_the_end, double rate_Hz = 200.0) {
  trial::PalpationMeasurement out;
  out.id = "t";
  const int samples = int(1.2 * rate_Hz) + 1;
  for (int k = 0; k < samples; ++k) {
    const double t_s = k / rate_Hz;
    out.t_s.push_back(t_s);
    out.X_VH.push_back({{0.0, -0.006 + 0.01 * t_s, 0.13}, math::Quat(0, 1, 0, 0)});
  }
  const auto motion = models::PalpationMotion::through(out.t_s, out.X_VH);
  EXPECT_TRUE(motion);
  models::PalpationAnswer answer;
  runtime().predict(*motion, answer, from_the_end);
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < out.t_s.size(); ++k) {
    math::Wrench w = answer.wrench_H[k];
    for (int c = 0; c < 3; ++c) w.force_N[c] += 0.01 * normal(random);
    for (int c = 0; c < 3; ++c) w.torque_Nm[c] += 5e-4 * normal(random);
    out.wrench_H.push_back(w);
    out.X_VH[k].p += 5e-6 * Vec3(normal(random), normal(random), normal(random));
  }
  return out;
}

PalpationRecording ready(trial::PalpationMeasurement trial, std::size_t most = 1'000'000) {
  auto out = prepare(std::move(trial), -Vec3::UnitZ(), "t.csv", most);
  EXPECT_TRUE(out) << out.error().what;
  return std::move(*out);
}

TEST(PalpationWeights, FollowTheRestThatTheWrenchTellsOf) {
  for (const bool from_the_end : {false, true}) {
    auto r = ready(over_the_ridge(from_the_end));
    weigh(runtime(), r);
    const double y_m = runtime().tip_m(r.motion.handle[120].X_VH, r.deflection_m[120]).y();
    EXPECT_GT(from_the_end ? y_m : -y_m, 1e-3);
  }
}

TEST(PalpationWeights, LeaveVarianceOneWhereNoiseIsAll) {
  auto r = ready(over_the_ridge(false));
  weigh(runtime(), r);
  models::PalpationAnswer at;
  runtime().predict_at(r.motion, r.instants, r.deflection_m, at);
  double sum = 0.0;
  for (std::size_t j = 0; j < r.instants.size(); ++j) {
    const Vec6 error = r.measured[r.instants[j]] - stacked(at.wrench_H[j]);
    sum += (r.whitener[j] * error).squaredNorm() / (6.0 * double(r.instants.size()));
  }
  EXPECT_NEAR(sum / r.usual_square, 1.0, 0.25);  // the pose's standard errors are cautious
  EXPECT_LE(r.usual_square, 1.0);
}

TEST(PalpationRecording, KeepsAFastRecordingAsItWasMeasuredAtNoMoreThan250PerSecond) {
  const auto fast = over_the_ridge(false, 1000.0);
  const auto r = ready(fast);
  ASSERT_EQ(r.size(), (fast.t_s.size() + 3) / 4);
  EXPECT_EQ(r.measured[7], stacked(fast.wrench_H[28]));
  EXPECT_EQ(r.motion.t_s[7], fast.t_s[28]);
  EXPECT_NEAR(r.noise_sd[1], 0.01, 0.001);  // of a sample at the full rate
}

/// Noise of a sensor of 0.03 N a component and of a motion whose squares are five times what is stated, which is less than
/// the sensor's everywhere; contact in half of the samples.
TEST(PalpationNoise, OfTheMotionIsToldThoughTheSensorsIsMore) {
  constexpr double kSensor_N2 = 3 * 9e-4, kStated_N2 = 0.4 * kSensor_N2, kTimes = 5.0;
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  std::vector<NoiseSample> samples;
  double sum = 0.0;
  for (int k = 0; k < 8000; ++k) {
    const double motion = k % 2 == 0 ? kStated_N2 : 0.0;
    const double sd = std::sqrt((kSensor_N2 + kTimes * motion) / 3.0);
    double error = 0.0;
    for (int c = 0; c < 3; ++c) error += std::pow(sd * normal(random), 2);
    samples.push_back({error, kSensor_N2, motion, true});
    sum += error;
  }
  EXPECT_NEAR(judged_noise(samples) / std::sqrt(sum / 8000.0), 1.0, 0.03);
}

TEST(PalpationRecording, CountsCoarseRoundingAsNoise) {
  auto trial = over_the_ridge(false);
  for (auto& w : trial.wrench_H) w.torque_Nm = (w.torque_Nm / 0.004).array().round() * 0.004;
  const auto r = ready(std::move(trial));
  EXPECT_NEAR(r.noise_sd[3], 0.004 / std::sqrt(12.0), 2.5e-4);
}

TEST(PalpationRecording, ComparesNoChannelThatNeverChangesAndSaysSo) {
  auto trial = over_the_ridge(false);
  for (auto& w : trial.wrench_H) w.torque_Nm.x() = 0.0;
  auto r = ready(std::move(trial));
  EXPECT_THAT(r.note, testing::HasSubstr("t: tx_Nm never changes"));
  weigh(runtime(), r);
  EXPECT_EQ(r.missed(120, math::Wrench{Vec3::Ones(), Vec3::Ones()})[3], 0.0);
  EXPECT_LT(r.floor.head<3>().norm(), 0.1);
  EXPECT_LT(std::abs(r.whitener[60].col(3).norm()), 1e-3);
}

TEST(PalpationRecording, TakesOfAVeryLongTrialWhereTheForceChangesMostAndSaysSo) {
  auto trial = over_the_ridge(false);
  const std::size_t half = trial.t_s.size() / 2;
  for (std::size_t k = 0; k < half; ++k) trial.wrench_H[k].force_N = Vec3(0.3, 0, 0);
  const auto r = ready(std::move(trial), 100);
  EXPECT_EQ(r.size(), 100u);
  EXPECT_GT(r.motion.t_s.front(), 0.3);
  EXPECT_THAT(r.note, testing::HasSubstr("241 samples"));
}

}  // namespace
}  // namespace lab
}  // namespace tractus
