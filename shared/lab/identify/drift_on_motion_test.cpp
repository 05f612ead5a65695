/// What a palpation's drift is held against: a toy whose drift is written down here.
#include "lab/identify/drift_on_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <cmath>
#include <functional>
#include <random>

#include "lab/identify/effect_screen.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr int kDriftRows = 600, kDriftTrials = 6, kDriftPowers = 6;
constexpr double kDriftStep_s = 0.05;
constexpr const char* kDriftId = "drift";

/// Bone's force along an axis at a row, N: presses of 3 to 9 s.
double bone_N(int trial, int axis, int row) {
  const double t_s = kDriftStep_s * row;
  return std::sin((0.7 + 0.11 * trial + 0.3 * axis) * t_s + axis) + 0.5 * axis;
}

/// What a polynomial of the fifth order in time leaves of values is taken off them.
Eigen::VectorXd slow_part(const Eigen::VectorXd& values) {
  Eigen::MatrixXd powers(kDriftRows, kDriftPowers);
  for (int r = 0; r < kDriftRows; ++r)
    for (int p = 0; p < kDriftPowers; ++p)
      powers(r, p) = std::pow(2.0 * r / (kDriftRows - 1.0) - 1.0, p);
  return powers * powers.colPivHouseholderQr().solve(values);
}

/// (trial, axis) → the trend that the drift takes out.
using TrendOf = std::function<Eigen::VectorXd(int, int)>;

class Drifting final : public Problem {
 public:
  explicit Drifting(TrendOf trend) : trend_(std::move(trend)) {}
  const SelectionThresholds& selection_thresholds() const override {
    return kSettings.palpation_thresholds;
  }
  std::string_view rig() const override { return "toy"; }
  int trials() const override { return kDriftTrials; }
  std::string trial_id(int k) const override { return std::to_string(k); }
  double seconds(int) const override { return kDriftStep_s * (kDriftRows - 1); }
  const std::vector<Channel>& channels() const override { return channels_; }
  const std::vector<Candidate>& candidates() const override { return none_; }
  std::vector<Parameter> parameters(const Structure&) const override { return {}; }
  Eigen::Index residual_size(int) const override { return 1; }
  void residuals(const Structure&, std::span<const double>, int,
                 Eigen::Ref<Eigen::VectorXd> out) const override {
    out.setZero();
  }
  int free_per_trial(const Structure& structure) const override {
    return contains(structure, kDriftId) ? 3 * kDriftPowers : 0;
  }
  double noise_floor(const Structure&, std::span<const double>) const override { return 0.0; }
  Residuals full_rate(const Structure& structure, std::span<const double>, int k) const override {
    Residuals out{
        {}, std::vector<std::vector<double>>(4, std::vector<double>(kDriftRows, 0.0)), {}};
    out.judgement.assign(kDriftRows, Judgement::judged);
    for (int r = 0; r < kDriftRows; ++r) out.t_s.push_back(kDriftStep_s * r);
    if (contains(structure, kDriftId)) return out;  // it takes all of the trend
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd trend = trend_(k, axis);
      out.channels[std::size_t(axis) + 1].assign(trend.begin(), trend.end());
    }
    return out;
  }
  States states(int k) const override {
    States out{{"force_x_N", "force_y_N", "force_z_N"}, std::vector<std::vector<double>>(3)};
    for (int axis = 0; axis < 3; ++axis)
      for (int r = 0; r < kDriftRows; ++r)
        out.values[std::size_t(axis)].push_back(bone_N(k, axis, r));
    return out;
  }
  std::vector<Derived> derived(const Structure&, std::span<const double>,
                               std::string_view) const override {
    return {};
  }
  const std::vector<std::string>& notes() const override { return notes_; }
  core::Json model(const Structure&, std::span<const double>) const override { return {}; }

 private:
  TrendOf trend_;
  std::vector<Channel> channels_{{"force_N", 0.1, 3}, {"fx_N", 0.1}, {"fy_N", 0.1}, {"fz_N", 0.1}};
  std::vector<Candidate> none_;
  std::vector<std::string> notes_;
};

double r2_of(TrendOf trend) {
  const Drifting problem(std::move(trend));
  const Residual residual(problem, 1);
  Solution at;
  at.structure.effects = {kDriftId};
  return drift_r2_on_motion(residual, at, kDriftId);
}

TEST(DriftOnMotion, BoneThatCreepsIsNoDrift) {
  // 0.3 of the mean of the force over the 3 s before, by Euler steps: a time constant that is none of the lab's.
  EXPECT_GT(r2_of([](int trial, int axis) {
              Eigen::VectorXd crept(kDriftRows);
              double state = 0.0;
              for (int r = 0; r < kDriftRows; ++r)
                crept(r) = -0.3 * (state += kDriftStep_s / 3.0 * (bone_N(trial, axis, r) - state));
              return slow_part(crept);
            }),
            0.9);
}

TEST(DriftOnMotion, BoneOfAnotherStiffnessInEachTrialIsNoDrift) {
  EXPECT_GT(r2_of([](int trial, int axis) {
              Eigen::VectorXd stiffer(kDriftRows);
              for (int r = 0; r < kDriftRows; ++r)
                stiffer(r) = 0.1 * (trial - 2.5) * bone_N(trial, axis, r);
              return slow_part(stiffer);
            }),
            0.95);
}

TEST(DriftOnMotion, ASensorThatWandersIsOne) {
  std::mt19937_64 random(3);
  std::normal_distribution<> normal;
  std::vector<Eigen::VectorXd> courses;
  for (int k = 0; k < 3 * kDriftTrials; ++k) {
    Eigen::VectorXd course(kDriftRows);
    const double a = normal(random), b = normal(random), c = normal(random);
    for (int r = 0; r < kDriftRows; ++r) {
      const double u = double(r) / (kDriftRows - 1);
      course(r) = a * (std::cos(M_PI * u) - 1.0) + b * (std::cos(2.0 * M_PI * u) - 1.0) / 2.0 +
                  c * (std::cos(3.0 * M_PI * u) - 1.0) / 4.0;
    }
    courses.push_back(slow_part(course));
  }
  // Neither other trials nor other axes tell anything of it.
  EXPECT_LT(r2_of([&](int trial, int axis) { return courses[std::size_t(3 * trial + axis)]; }),
            0.3);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
