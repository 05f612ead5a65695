/// Distribution functions against 50-digit anchors.
#include "statistics/distributions/distributions.hpp"

#include "statistics/golden_test.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;

struct Anchors : testing::Test {
  core::Json want = golden::expected("distributions");
};

TEST_F(Anchors, TailsKeepTwelveDigits) {
  for (const auto& a : want["student_t"])
    expect_near(student_t_two_sided(a["t"], a["df"]), a["p_two_sided"], 1e-12, a.dump());
  for (const auto& a : want["F_upper"])
    expect_near(f_upper(a["F"], a["d1"], a["d2"]), a["p"], 1e-12, a.dump());
  for (const auto& a : want["chi2_upper"])
    expect_near(chi_squared_upper(a["x"], a["df"]), a["p"], 1e-12, a.dump());
  for (const auto& a : want["normal"])
    expect_near(normal_upper(a["z"]), a["upper"], 1e-12, a.dump());
}

TEST_F(Anchors, QuantilesKeepTwelveDigits) {
  for (const auto& a : want["t_quantile_975"])
    expect_near(student_t_quantile(0.975, a["df"]), a["q"], 1e-12, a.dump());
  for (const auto& a : want["normal_quantile"])
    expect_near(normal_quantile(a["p"]), a["z"], 1e-12, a.dump());
}

TEST_F(Anchors, NoncentralOnesServePowerToTwelveDigits) {
  for (const auto& a : want["noncentral_F_power"])
    expect_near(noncentral_f_upper(a["F_crit"], a["d1"], a["d2"], a["lambda"]), a["power"], 1e-12,
                a.dump());
  for (const auto& a : want["noncentral_t_cdf"])
    expect_near(noncentral_t_cdf(a["t"], a["df"], a["ncp"]), a["cdf"], 1e-12, a.dump());
}

TEST_F(Anchors, StudentizedRangeAgreesWithAnIndependentQuadrature) {
  for (const auto& a : want["studentized_range_upper_scipy_1e-10"])
    EXPECT_NEAR(studentized_range_upper(a["q"], a["k"], a["df"]), a["p"].get<double>(), 1e-9)
        << a.dump();
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
