#include "lab/discover/evidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>
#include <random>

namespace tractus {
namespace lab {
namespace {

std::vector<Eigen::VectorXd> noise(int trials, int rows, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> one;
  std::vector<Eigen::VectorXd> out(static_cast<std::size_t>(trials), Eigen::VectorXd::Zero(rows));
  for (auto& trial : out)
    for (double& v : trial) v = one(random);
  return out;
}

TEST(LeaveOneOut, IsTheDensityOfATrialGivenTheOthers) {
  // One column of ones, written out with dense matrices: r_t ~ N(−Z m, s² I + Z V Zᵀ).
  const auto r = noise(3, 40, 7);
  const Eigen::VectorXd z = Eigen::VectorXd::Ones(40);
  std::vector<TrialGram> trials;
  for (const auto& one : r) {
    const Eigen::VectorXd shifted = one.array() + 2.0;
    trials.push_back({z.transpose() * z, z.transpose() * shifted, shifted.squaredNorm(), 40.0});
  }
  const LinearPrior prior{Eigen::MatrixXd::Constant(1, 1, 0.25), Eigen::VectorXd::Zero(1)};
  const Evidence found = leave_one_out(trials, prior, 1.0);
  double variance = 0.0;  // of all trials about their fit
  for (int round = 0; round < 2; ++round) {
    double squares = 0.0;
    const double weight =
        round == 0 ? 120.0 / (trials[0].rr + trials[1].rr + trials[2].rr) : 1.0 / variance;
    const double m =
        -weight * (trials[0].b(0) + trials[1].b(0) + trials[2].b(0)) / (0.25 + weight * 120.0);
    for (const auto& one : r) squares += (one.array() + 2.0 + m).square().sum();
    variance = squares / 120.0;
  }
  const double known = 0.25 + 80.0 / variance;
  const double mean = -(trials[1].b(0) + trials[2].b(0)) / variance / known;
  double own = 0.0;
  for (const int k : {1, 2}) own += (r[std::size_t(k)].array() + 2.0 + mean).square().sum() / 80.0;
  const Eigen::MatrixXd covariance =
      own * Eigen::MatrixXd::Identity(40, 40) + z * z.transpose() / known;
  const Eigen::VectorXd off = r[0].array() + 2.0 + mean;
  const double density =
      -0.5 * (40.0 * std::log(2.0 * std::numbers::pi) + std::log(covariance.determinant()) +
              off.dot(covariance.inverse() * off));
  EXPECT_NEAR(found.log_score(0), density, 1e-6);
  EXPECT_NEAR(found.change(0), -2.0, 0.3);
}

TEST(LeaveOneOut, PrefersNoColumnToOneOfNoise) {
  const auto r = noise(8, 200, 3), z = noise(8, 200, 4);
  std::vector<TrialGram> none, with;
  for (std::size_t t = 0; t < r.size(); ++t) {
    none.push_back({Eigen::MatrixXd(0, 0), Eigen::VectorXd(0), r[t].squaredNorm(), 200.0});
    with.push_back({z[t].transpose() * z[t], z[t].transpose() * r[t], r[t].squaredNorm(), 200.0});
  }
  const double without =
      leave_one_out(none, {Eigen::MatrixXd(0, 0), Eigen::VectorXd(0)}, 1.0).total;
  const LinearPrior weak{Eigen::MatrixXd::Constant(1, 1, 1e-3), Eigen::VectorXd::Zero(1)};
  EXPECT_LT(leave_one_out(with, weak, 1.0).total, without + 1.0);
}

TEST(Correlation, IsThatOfAnAutoregression) {
  // x_k = 0.8 x_(k−1) + e: 1 + 2 Σ 0.8^k = (1 + 0.8)/(1 − 0.8) = 9.
  auto trials = noise(20, 4000, 5);
  for (auto& trial : trials)
    for (Eigen::Index k = 1; k < trial.size(); ++k) trial(k) += 0.8 * trial(k - 1);
  EXPECT_NEAR(correlation_of(trials), 9.0, 1.0);
  EXPECT_NEAR(correlation_of(noise(20, 4000, 6)), 1.0, 0.1);
}

TEST(StackedProbabilities, SumToOneAndGoToTheBest) {
  const Eigen::VectorXd low = Eigen::VectorXd::Constant(10, -3.0),
                        high = Eigen::VectorXd::Constant(10, -1.0);
  const auto p = stacked_probabilities({low, high, high}, {0.0, 0.0, 0.0});
  EXPECT_NEAR(p[0] + p[1] + p[2], 1.0, 1e-12);
  EXPECT_NEAR(p[1], 0.5, 1e-6);
  EXPECT_LT(p[0], 1e-6);
  EXPECT_NEAR(share_of_best({low, high}, {0.0, 0.0})[1], 1.0, 1e-9);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
