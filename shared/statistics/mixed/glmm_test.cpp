/// The logistic mixed model against maximum likelihood with 100 nodes and an exact gradient.
#include "statistics/mixed/glmm.hpp"

#include "statistics/golden_test.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;

TEST(LogisticMixed, ReachesTheExactMaximumToEightDigits) {
  const auto reference = golden::expected("glmm_random_intercept");
  int compared = 0;
  for (const auto& [name, fit_of] : reference["fits"].items()) {
    const auto& want = fit_of["exact_ML"];
    const golden::Csv csv(fit_of["data"]);
    const Vector y = csv.numbers("y");
    const bool counted = name != "glmm_sim_correct";  // its rows are single answers
    Design design{csv.numeric_from(counted ? 3 : 2), {}, true};
    for (const auto& column : fit_of["columns"]) design.names.push_back(column);
    const auto fit =
        logistic_mixed(design, {y, counted ? csv.numbers("m") : Vector(Vector::Ones(y.size()))},
                       csv.texts("group"));
    ASSERT_TRUE(fit) << name << ": " << fit.error().what;
    ++compared;
    expect_near(fit->coefficients, want["fixef"], 1e-8, name + " fixef");
    expect_near(fit->sigma_u, want["sigma_u"], 1e-8, name + " sigma");
    expect_near(fit->log_likelihood, want["logLik"], 1e-8, name + " logLik");
    expect_near(fit->standard_errors, want["se_fixef"], 1e-8, name + " se");
    expect_near(fit->sigma_u_se, want["se_sigma_u"], 1e-8, name + " se sigma");
  }
  EXPECT_EQ(compared, 4);
}

TEST(LogisticMixed, IsPlainLogisticWhereGroupsAgree) {
  // Four groups with the very same answers: nothing to put between them.
  Vector x(8), y(8);
  x << 0, 1, 0, 1, 0, 1, 0, 1;
  y << 3, 5, 3, 5, 3, 5, 3, 5;
  const Design design = with_intercept(x, {"x"});
  const Counts counts{y, Vector::Constant(8, 8.0)};
  const auto fit = logistic_mixed(design, counts, {"a", "a", "b", "b", "c", "c", "d", "d"});
  ASSERT_TRUE(fit) << fit.error().what;
  EXPECT_EQ(fit->sigma_u, 0.0);
  EXPECT_NEAR(fit->coefficients[0], std::log(3.0 / 5.0), 1e-10);  // logit of 3 of 8
  EXPECT_FALSE(logistic_mixed(design, counts, std::vector<std::string>(8, "a")));
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
