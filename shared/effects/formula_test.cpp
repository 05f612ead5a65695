#include "effects/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tractus {
namespace effects {
namespace {

using testing::HasSubstr;

Dimension unit(std::string_view text) {
  const auto found = Dimension::parse(text);
  EXPECT_TRUE(found) << text;
  return *found;
}

std::vector<Quantity> quantities() {
  return {{"x_m", unit("m")}, {"v_m_s", unit("m/s")}, {"c", unit("N*s^2/m^2")}, {"k", unit("N/m")},
          {"n", unit("1")},   {"w", unit("rad/s")},   {"t_s", unit("s")}};
}

core::Result<FormulaFacts> checked(std::string_view formula) {
  return check_formula(formula, quantities(), unit("N"));
}
std::string refusal(std::string_view formula) {
  const auto facts = checked(formula);
  return facts ? "taken" : facts.error().what;
}

double value(const std::string& formula, double x_m, double v_m_s) {
  auto program = FormulaProgram::make(formula, quantities());
  EXPECT_TRUE(program) << program.error().what;
  const auto in = program->inputs();
  in[0] = x_m, in[1] = v_m_s, in[2] = 3.0, in[3] = 200.0, in[4] = 2.0, in[5] = 4.0, in[6] = 0.5;
  return program->value();
}

TEST(Dimension, ReadsAndWritesUnits) {
  EXPECT_EQ(unit("N*s^2/m^2"), unit("kg/m"));
  EXPECT_EQ(unit("N·m"), unit("J"));
  EXPECT_EQ(unit("Pa*m^2"), unit("N"));
  EXPECT_EQ(unit("rad/s"), unit("1/s"));
  EXPECT_EQ(unit("N*s/m").text(), "N*s/m");
  EXPECT_EQ(unit("m/s^2").text(), "m/s^2");
  EXPECT_EQ(unit("kg").text(), "kg");
  EXPECT_EQ(unit("1/m/s").text(), "1/m/s");
  EXPECT_EQ(unit("rad").text(), "1");
  for (const char* wrong : {"mm", "", "N*", "N^x", "N^99", "m s", "*"})
    EXPECT_FALSE(Dimension::parse(wrong)) << wrong;
}

TEST(AFormula, IsTakenWhenItsUnitsFit) {
  for (const char* formula :
       {"c * v_m_s * abs(v_m_s)", "k*x_m", "-k * (x_m - max(x_m, 0))", "k * sqrt(x_m^2 + 0)",
        "c*v_m_s^2 * sgn(v_m_s)", "k*x_m*exp(-n*w*t_s)", "x_m > 0 ? k*x_m : 0", "k*x_m*(1 + n^2.5)",
        "x_m > 0 && v_m_s > 0 || n == 2 ? k*x_m : k*x_m/2", "0", "c*v_m_s^(4/2)",
        "2*k*x_m^1.5*x_m^-0.5", "k*x_m*sin(pi*w*t_s + n)"})
    EXPECT_EQ(refusal(formula), "taken") << formula;
}

TEST(AFormula, IsRefusedByTheExpressionWhoseUnitsDoNotFit) {
  EXPECT_EQ(refusal("k * (x_m + v_m_s)"), "`x_m + v_m_s`: m and m/s");
  EXPECT_EQ(refusal("k * (x_m - 0.01)"),
            "`x_m - 0.01`: m and 1 (a number has no unit: make it a parameter)");
  EXPECT_EQ(refusal("c * v_m_s"), "`c * v_m_s`: N*s/m where N is expected");
  EXPECT_EQ(refusal("k*x_m*sin(x_m)"), "`x_m`: sin takes a number without unit, not m");
  EXPECT_EQ(refusal("k*x_m^n"),
            "`x_m`: m to the power `n`, which is not a plain number such as 2 or 0.5");
  EXPECT_EQ(refusal("x_m ? k*x_m : 0"), "`x_m`: a condition takes a number without unit, not m");
  EXPECT_EQ(refusal("x_m > v_m_s ? k*x_m : 0"), "`x_m > v_m_s`: m and m/s");
  EXPECT_EQ(refusal("n > 1 ? k*x_m : v_m_s"), "`k*x_m : v_m_s`: N and m/s");
}

TEST(AFormula, IsRefusedWhereItsGrammarFails) {
  EXPECT_THAT(refusal("k*y_m"), HasSubstr("`y_m` is neither a parameter nor one of x_m, v_m_s"));
  EXPECT_THAT(refusal("system(x_m)"), HasSubstr("`system` is not a function; abs, sqrt"));
  EXPECT_THAT(refusal("log(n)*k*x_m"), HasSubstr("`log` is not a function"));
  EXPECT_THAT(refusal("k*x_m)"), HasSubstr("`)`: an operator or the end is expected"));
  EXPECT_THAT(refusal("(k*x_m"), HasSubstr("`(k*x_m`: ')' is missing"));
  EXPECT_THAT(refusal("k*"), HasSubstr("ends where a number or a name is expected"));
  EXPECT_THAT(refusal(""), HasSubstr("ends where"));
  EXPECT_THAT(refusal("k*x_m*2x"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("k*x_m*1.2.3"), HasSubstr("not a number"));
  EXPECT_THAT(refusal("k*x_m = 2"), HasSubstr("`= 2`: an operator"));
  EXPECT_THAT(refusal("k*x_m, 2"), HasSubstr("`, 2`: an operator"));
  EXPECT_THAT(refusal("k*x_m ? 2"), HasSubstr("condition"));
  EXPECT_THAT(refusal(std::string(400, '(') + "k*x_m" + std::string(400, ')')),
              HasSubstr("nested too deeply"));
  EXPECT_THAT(refusal(std::string(400, '-') + "k*x_m"), HasSubstr("nested too deeply"));
  EXPECT_THAT(refusal(std::string(2000, 'k')), HasSubstr("2000 characters"));
}

TEST(AFormula, KnowsWhichQuantitiesMakeItVanish) {
  const auto vanishing = [](std::string_view formula) {
    std::string out;
    const auto facts = checked(formula);
    EXPECT_TRUE(facts) << facts.error().what;
    for (std::size_t i = 0; i < quantities().size(); ++i)
      if (facts->vanishes[i]) out += quantities()[i].name + " ";
    return out;
  };
  EXPECT_EQ(vanishing("c * v_m_s * abs(v_m_s)"), "v_m_s c ");
  EXPECT_EQ(vanishing("k * x_m * exp(n)"), "x_m k ");
  EXPECT_EQ(vanishing("k * x_m + c * v_m_s^2"), "");
  EXPECT_EQ(vanishing("k * x_m / (1 + n)"), "x_m k ");
  EXPECT_EQ(vanishing("k * x_m * x_m / x_m"), "k ");
  EXPECT_EQ(vanishing("x_m > 0 ? k * x_m : 0"), "x_m k ");
}

TEST(AFormulaProgram, EvaluatesWithTheUsualPrecedence) {
  // c = 3, k = 200, n = 2, w = 4, t = 0.5; worked out by hand.
  EXPECT_DOUBLE_EQ(value("c * v_m_s * abs(v_m_s)", 0.0, -0.02), -3.0 * 4e-4);
  EXPECT_DOUBLE_EQ(value("-n^2", 0.0, 0.0), -4.0);
  EXPECT_DOUBLE_EQ(value("n^-1", 0.0, 0.0), 0.5);
  EXPECT_DOUBLE_EQ(value("n^n^n", 0.0, 0.0), 16.0);
  EXPECT_DOUBLE_EQ(value("2*-n + 8/4/2", 0.0, 0.0), -3.0);
  EXPECT_DOUBLE_EQ(value("x_m > 0 ? k*x_m : 0", 0.01, 0.0), 2.0);
  EXPECT_DOUBLE_EQ(value("x_m > 0 ? k*x_m : 0", -0.01, 0.0), 0.0);
  EXPECT_DOUBLE_EQ(value("x_m < 1 && v_m_s >= 0 || n != 2 ? 5 : 6", 0.0, 0.0), 5.0);
  EXPECT_DOUBLE_EQ(value("sgn(v_m_s) + sign(v_m_s)", 0.0, -3.0), -2.0);
  EXPECT_DOUBLE_EQ(value("max(1, n, 3) - min(4, n)", 0.0, 0.0), 1.0);
  EXPECT_NEAR(value("ln(exp(n)) + cos(pi) + atan(tan(0.5))", 0.0, 0.0), 1.5, 1e-12);
  EXPECT_NEAR(value("sin(w*t_s)", 0.0, 0.0), std::sin(2.0), 1e-15);
}

TEST(AFormulaProgram, IsZeroWhereItsValueIsNotFinite) {
  EXPECT_EQ(value("1/x_m", 0.0, 0.0), 0.0);
  EXPECT_EQ(value("sqrt(x_m)", -1.0, 0.0), 0.0);
}

}  // namespace
}  // namespace effects
}  // namespace tractus
