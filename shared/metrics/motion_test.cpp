/// Motion measures against the reference (numpy, scipy; the authors' own doctest for SPARC).
#include "metrics/motion.hpp"

#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cmath>
#include <fstream>
#include <sstream>

#include "core/json.hpp"

namespace tractus {
namespace metrics {
namespace {

const std::string kMotionGolden = std::string(checkout::kSource) + "/tests/golden/statistics/";

core::Json motion_reference() {
  return core::read_json(kMotionGolden + "motion_metrics.json").value();
}

void expect_near(double got, const core::Json& want, double relative) {
  const double value = want.get<double>();
  EXPECT_NEAR(got, value, relative * std::abs(value));
}

/// Columns of a CSV with one line of names.
std::vector<std::vector<double>> columns(const std::string& name) {
  std::ifstream file(kMotionGolden + name);
  std::string line;
  std::getline(file, line);
  std::vector<std::vector<double>> out;
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::size_t j = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++j) {
      if (out.size() <= j) out.emplace_back();
      out[j].push_back(std::stod(cell));
    }
  }
  return out;
}

std::vector<math::Vec3> trajectory_mm() {
  const auto c = columns("sim_trajectory_200Hz_mm.csv");
  std::vector<math::Vec3> out;
  for (std::size_t i = 0; i < c[0].size(); ++i) out.emplace_back(c[1][i], c[2][i], c[3][i]);
  return out;
}

TEST(Smoothness, AgreesWithTheAuthorsOwnExample) {
  const auto want = motion_reference()["gaussian_speed_repo_doctest"];
  std::vector<double> speed;
  for (int i = 0; i < 200; ++i) speed.push_back(std::exp(-5.0 * std::pow(-1.0 + 0.01 * i, 2)));
  expect_near(*spectral_arc_length(speed, 100.0), want["sparc"], 1e-9);
  expect_near(*log_dimensionless_jerk(speed, 100.0), want["ldlj"], 1e-9);
  EXPECT_FALSE(spectral_arc_length(std::vector<double>(100, 0.0), 100.0));
  EXPECT_FALSE(log_dimensionless_jerk(std::vector<double>{1.0, 2.0}, 100.0));
}

TEST(Smoothness, OfAMinimumJerkMovementIsNearItsContinuousValue) {
  const auto want = motion_reference()["minimum_jerk"]["sampled_speed"];
  std::vector<double> speed;  // D = 0.1 m, T = 1 s, 101 samples
  for (int i = 0; i <= 100; ++i) {
    const double s = i / 100.0;
    speed.push_back(0.1 * (30.0 * s * s - 60.0 * s * s * s + 30.0 * s * s * s * s));
  }
  expect_near(*spectral_arc_length(speed, 100.0), want["sparc"], 1e-9);
  expect_near(*log_dimensionless_jerk(speed, 100.0), want["ldlj_repo_T=N*dt"], 1e-9);
}

TEST(Kinematics, AgreesWithTheReferenceTrajectory) {
  const auto want = motion_reference()["trajectory"];
  // In millimetres throughout: every measure is free of units or linear in them.
  const auto k = kinematics(trajectory_mm(), 1.0 / 200.0);
  ASSERT_TRUE(k);
  const auto& jerk = want["jerk_by_savgol(41,5,interp)"];
  expect_near(k->jerk2_m2_s5, jerk["int_jerk2"], 1e-6);
  expect_near(k->path_m,
              want["velocity_by_savgol(21,3,interp)"]["path_length_by_trapezoid_of_speed"], 1e-9);
  // The reference divides by the raw polyline's length, ours by the smoothed path's.
  expect_near(
      k->motion_smoothness() * k->path_m / want["path_length_mm_raw_polyline"].get<double>(),
      jerk["motion_smoothness_sqrt(0.5*int_j2*T^5/PL^2)"], 1e-6);
  expect_near(k->straight_m, want["straight_line_mm"], 1e-12);
  expect_near(*spectral_arc_length(k->speed_m_s, 200.0), want["sparc_of_savgol_speed"], 1e-9);
  expect_near(*log_dimensionless_jerk(k->speed_m_s, 200.0), want["ldlj_repo_of_savgol_speed"],
              1e-9);
  EXPECT_EQ(speed_peaks(k->speed_m_s, 5.0), want["speed_peaks"]["count"].get<int>());
  EXPECT_FALSE(kinematics(std::vector<math::Vec3>(40, math::Vec3::Zero()), 0.005));
}

TEST(Tremor, BandPowerAgreesWithWelchOfTheReference) {
  const auto want = motion_reference()["trajectory"]["tremor"];
  std::vector<double> x;
  for (const auto& p : trajectory_mm()) x.push_back(p.x());
  const auto power = band_power(x, 200.0, 8.0, 12.0);
  ASSERT_TRUE(power);
  expect_near(*power, want["band_8_12Hz_x_position_mm2_rectangle"], 1e-9);
  expect_near(std::sqrt(*power), want["rms_tremor_amplitude_mm"], 1e-9);
  EXPECT_FALSE(band_power(std::vector<double>(255, 1.0), 200.0, 8.0, 12.0));
}

TEST(Force, ImpulseAndWorkAgreeWithTheReferenceTrial) {
  const auto want = motion_reference()["breach_trial"];
  const auto c = columns("sim_breach_trial_1kHz.csv");  // t_s, depth_mm, velocity_mm_s, force_N, …
  expect_near(integral(c[0], c[3]), want["force_integral_Ns_trapezoid"], 1e-9);
  expect_near(integral(c[1], c[3]), want["work_N_mm_trapezoid_over_depth"], 1e-9);
}

}  // namespace
}  // namespace metrics
}  // namespace tractus
