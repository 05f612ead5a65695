#include "assessment/pictures.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "assessment/method.hpp"
#include "core/bytes.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/mixed/lmm_tests.hpp"
#include "statistics/regression/ols.hpp"

namespace tractus {
namespace assessment {
namespace {

using statistics::Vector;
using testing::ElementsAre;

Table table_of_text(const std::string& text) {
  const auto bytes = core::bytes_of(text);
  auto table = Table::parse({bytes.begin(), bytes.end()}, "t.csv", {}, Missing::keep);
  EXPECT_TRUE(table) << table.error().what;
  return *table;
}

core::Json panel_of(const std::string& method, const std::string& csv, const std::string& formula) {
  const auto found = run(*method_named(method), table_of_text(csv), formula, {}, Missing::drop);
  EXPECT_TRUE(found) << found.error().what;
  return figure_json(found->figures[0])["panels"][0];
}

/// Speed in mph and stopping distance in ft of 50 cars (Ezekiel 1930), R's data set `cars`.
const std::vector<double> kSpeed{4,  4,  7,  7,  8,  9,  10, 10, 10, 11, 11, 12, 12, 12, 12, 13, 13,
                                 13, 13, 14, 14, 14, 14, 15, 15, 15, 16, 16, 17, 17, 17, 18, 18, 18,
                                 18, 19, 19, 19, 20, 20, 20, 20, 20, 22, 23, 24, 24, 24, 24, 25};
const std::vector<double> kDistance{2,  10, 4,  22, 16, 10, 18, 26, 34, 17,  28, 14, 20,
                                    24, 28, 26, 34, 34, 46, 26, 36, 60, 80,  20, 26, 54,
                                    32, 40, 32, 40, 50, 42, 56, 76, 84, 36,  46, 68, 32,
                                    48, 52, 56, 64, 66, 54, 70, 92, 93, 120, 85};

TEST(Band, OfLeastSquaresIsThatOfPredict) {
  const Vector x = Eigen::Map<const Vector>(kSpeed.data(), 50),
               y = Eigen::Map<const Vector>(kDistance.data(), 50);
  const auto fit = statistics::ols(statistics::with_intercept(x, {"speed"}), y);
  ASSERT_TRUE(fit) << fit.error().what;
  const auto reach = band_of(fit->sigma * fit->sigma * fit->unscaled_covariance, fit->df_residual);
  // R: predict(lm(dist ~ speed, cars), data.frame(speed = c(12, 19, 24)), interval = "confidence"):
  //   29.60981 24.39514 34.82448;  57.13667 51.82913 62.44421;  76.79872 68.38765 85.20978
  EXPECT_NEAR(reach(12.0), (34.82448 - 24.39514) / 2.0, 1e-5);
  EXPECT_NEAR(reach(19.0), (62.44421 - 51.82913) / 2.0, 1e-5);
  EXPECT_NEAR(reach(24.0), (85.20978 - 68.38765) / 2.0, 1e-5);
}

TEST(Figure, OfARegressionHoldsPointsLineAndBand) {
  std::string csv = "speed,dist\n";
  for (std::size_t i = 0; i < kSpeed.size(); ++i)
    csv += std::to_string(kSpeed[i]) + "," + std::to_string(kDistance[i]) + "\n";
  const auto panel = panel_of("ols", csv, "dist ~ speed");
  EXPECT_EQ(panel["x_label"], "speed");
  EXPECT_EQ(panel["lines"][0]["points"], true);
  EXPECT_EQ(panel["lines"][0]["x"].size(), 50u);
  EXPECT_EQ(panel["lines"][1]["points"], false);
  // R: coef(lm(dist ~ speed, cars)) is -17.579095, 3.932409; at 25: 80.73113.
  EXPECT_NEAR(panel["lines"][1]["y"][1].get<double>(), 80.73113, 1e-4);
  const auto& band = panel["ribbons"][0];
  EXPECT_EQ(band["x"].front(), 4.0);
  EXPECT_EQ(band["x"].back(), 25.0);
  EXPECT_LT(band["low"].back(), panel["lines"][1]["y"][1]);
}

TEST(Figure, OfAMixedModelHasTheInterceptsIntervalWherePredictorIsZero) {
  std::string csv = "y,x,who\n";
  const double y[] = {1.0, 2.1, 3.3, 3.9, 2.2, 2.8, 4.1, 5.2, 0.4, 1.7, 2.2, 3.5};
  for (int i = 0; i < 12; ++i)
    csv += std::to_string(y[i]) + "," + std::to_string(i % 4) + ",p" + std::to_string(i / 4) + "\n";
  const auto found =
      run(*method_named("lmm"), table_of_text(csv), "y ~ x + (1|who)", {}, Missing::drop);
  ASSERT_TRUE(found) << found.error().what;
  // Estimate, standard error and degrees of freedom are held against R elsewhere.
  const auto& intercept = found->report["coefficients"][0];
  const double reach = intercept["standard_error"].get<double>() *
                       statistics::student_t_quantile(0.975, intercept["df"].get<double>());
  const auto band = figure_json(found->figures[0])["panels"][0]["ribbons"][0];
  EXPECT_EQ(band["x"][0], 0.0);
  EXPECT_NEAR(band["high"][0].get<double>(), intercept["estimate"].get<double>() + reach, 1e-4);
  EXPECT_NEAR(band["low"][0].get<double>(), intercept["estimate"].get<double>() - reach, 1e-4);
}

TEST(Figure, OfGroupsHasAPointPerPersonWhereRowsRepeat) {
  const auto panel =
      panel_of("lmm", "y,g,who\n1,a,p\n3,a,p\n2,a,q\n5,b,r\n7,b,r\n4,b,s\n2.5,a,t\n5.5,b,u\n",
               "y ~ g + (1|who)");
  EXPECT_EQ(panel["y_label"], "y, mean of each who");
  EXPECT_THAT(panel["group_names"], ElementsAre("a", "b"));
  EXPECT_THAT(panel["lines"][0]["y"], ElementsAre(2.0, 2.0, 2.5, 6.0, 4.0, 5.5));
}

/// Intercept and slope of the model with x moved by c are lᵀβ with l = (1, c), whose degrees of
/// freedom are held against R elsewhere.
TEST(Band, OfAMixedModelHasTheDegreesOfFreedomOfTheMovedIntercept) {
  const std::vector<double> values{1.0, 2.1, 3.3, 3.9, 2.2, 2.8, 4.1, 5.2, 0.4, 1.7, 2.2, 3.5};
  const Vector y = Eigen::Map<const Vector>(values.data(), 12);
  Vector x(12);
  std::vector<std::string> who;
  for (int i = 0; i < 12; ++i) {
    x[i] = i % 4;
    who.push_back("p" + std::to_string(i / 4));
  }
  const auto fit = statistics::lmm(statistics::with_intercept(x, {"x"}), y, who);
  const Vector moved_x = x.array() - 3.0;
  const auto moved = statistics::lmm(statistics::with_intercept(moved_x, {"x"}), y, who);
  ASSERT_TRUE(fit && moved);
  const Vector contrast = Eigen::Vector2d(1.0, 3.0);
  EXPECT_NEAR(statistics::satterthwaite_df(*fit, contrast), moved->df[0], 1e-5 * moved->df[0]);
  EXPECT_NEAR(std::sqrt(contrast.dot(fit->covariance * contrast)), moved->standard_errors[0], 1e-7);
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
