#include "lab/identify/law_dependence.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tractus {
namespace lab {
namespace {

constexpr int kPointsInTime = 500, kRuns = 6;
constexpr double kErrorSd_N = 0.1;  // of each component

/// Two laws of one term each beside the model's own: a sine along x, and a cosine along y, in each trial of another phase.
ForceLaws sines(int run) {
  ForceLaws out{{{"own", {}}, {"sine", {}}, {"cosine", {}}}, {}};
  for (auto& law : out.laws) law.terms.push_back(Eigen::Matrix3Xd::Zero(3, kPointsInTime));
  for (int k = 0; k < kPointsInTime; ++k) {
    out.laws[0].terms[0](2, k) = 1.0;
    out.laws[1].terms[0](0, k) = std::sin(0.05 * k + run);
    out.laws[2].terms[0](1, k) = std::cos(0.07 * k - run);
  }
  out.error_sd_N.assign(kPointsInTime, std::sqrt(3.0) * kErrorSd_N);
  return out;
}

/// White noise, and size times the first law, of each run another sign if asked; beside a trend that is free in each run.
LawDependence found(double size, bool sign_of_run = false, double trend_N = 0.0) {
  std::mt19937_64 random(7);
  std::normal_distribution<> normal(0.0, kErrorSd_N);
  std::vector<Eigen::MatrixXd> products;
  for (int run = 0; run < kRuns; ++run) {
    const ForceLaws laws = sines(run);
    Residuals left{{}, std::vector<std::vector<double>>(4), {}};
    for (int k = 0; k < kPointsInTime; ++k) {
      left.t_s.push_back(0.01 * k);
      left.judgement.push_back(k % 5 == 0 ? Judgement::unknown_motion : Judgement::judged);
      for (int c = 0; c < 3; ++c) {
        const double sign = sign_of_run && run % 2 == 1 ? -1.0 : 1.0;
        const double huge = k % 5 == 0 ? 100.0 : 0.0;  // not judged
        left.channels[std::size_t(c) + 1].push_back(
            sign * size * laws.laws[1].terms[0](c, k) + normal(random) + huge +
            trend_N * (run - 2.0) * std::pow(0.002 * k, 3.0));
      }
    }
    products.push_back(law_products(left, laws, trend_N > 0.0));
  }
  return law_dependence(products, sines(0));
}

TEST(LawDependence, IsTheLawsShareOfTheJudgedSquares) {
  // A sine of 0.06 N in one component has a mean square of 0.0018 N²; three of noise, of 0.01 N², beside it.
  const LawDependence of_sine = found(0.06);
  EXPECT_NEAR(of_sine.share, 0.0018 / (0.0018 + 0.03), 0.012);
  EXPECT_EQ(of_sine.laws, std::vector<std::string>{"sine"});
}

TEST(LawDependence, NoiseFollowsNoLaw) {
  EXPECT_EQ(found(0.0).share, 0.0);
  EXPECT_TRUE(found(0.0).laws.empty());
}

TEST(LawDependence, ALawHoldsInEveryTrialWithTheSameNumbers) {
  EXPECT_EQ(found(0.06, true).share, 0.0);
}

TEST(LawDependence, IsTheSameBesideATrendThatIsFreeInEachTrial) {
  EXPECT_NEAR(found(0.06, false, 1.0).share, found(0.06).share, 0.006);
  EXPECT_EQ(found(0.06, false, 1.0).laws, std::vector<std::string>{"sine"});
}

}  // namespace
}  // namespace lab
}  // namespace tractus
