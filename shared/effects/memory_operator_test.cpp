#include "effects/memory_operator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "effects/expression.hpp"
#include "effects/formula.hpp"

namespace tractus {
namespace effects {
namespace {

using Signal = std::function<double(double t_s)>;
using testing::HasSubstr;

/// An operator over n steps from 0 to the end; the value there.
double value_after(MemoryOperator which, const std::vector<Signal>& arguments, double end_s, int n,
                   double rest_m_s = 0.0) {
  std::array<double, kStatesOfMemory> states{};
  MemoryArguments of{};
  const auto at = [&](double t) {
    for (std::size_t i = 0; i < arguments.size(); ++i) of[i] = arguments[i](t);
  };
  at(0.0);
  double out = begin(which, of, MemoryStates(states));
  for (int k = 1; k <= n; ++k) {
    at(end_s * k / n);
    out = advance(which, of, {end_s / n, rest_m_s}, MemoryStates(states));
  }
  return out;
}
Signal number(double value) {
  return [value](double) { return value; };
}
double straight(double t) { return t; }

TEST(Lag, FollowsARampLateByItsTimeConstantAtAnyRate) {
  // u = t: z = t − τ (1 − e^(−t/τ)); τ = 0.5 s, t = 0.8 s: 0.8 − 0.5 (1 − e^(−1.6)) = 0.400948259.
  for (const int n : {1, 8, 1000})
    EXPECT_NEAR(value_after(MemoryOperator::lag, {straight, number(0.5)}, 0.8, n), 0.400948259,
                1e-9);
}

TEST(Play, StaysWithinItsGapAndIsDrawnAlong) {
  // To 1 mm through a gap of 0.4 mm: 0.8 mm; back to 0.7 mm: still 0.8; back to 0.3 mm: 0.5 mm.
  const auto path = [](double t) { return t < 1.0 ? 1e-3 * t : 1e-3 * (2.0 - t); };
  const auto at = [&](double t) {
    return value_after(MemoryOperator::play, {path, number(4e-4)}, t, int(std::lround(100 * t)));
  };
  EXPECT_NEAR(at(1.0), 8e-4, 1e-12);
  EXPECT_NEAR(at(1.3), 8e-4, 1e-12);
  EXPECT_NEAR(at(1.7), 5e-4, 1e-12);
}

TEST(Dahl, ComesToItsYieldWhateverTheRate) {
  // Over 0.2 mm with δ = 0.1 mm: δ (1 − e⁻²) = 0.08646647168 mm; back by 0.1 mm:
  // −δ + (z + δ)/e = −0.0314028186 mm.
  const auto path = [](double t) { return t < 2.0 ? 1e-4 * t : 1e-4 * (4.0 - t); };
  for (const int n : {3, 3000})
    EXPECT_NEAR(value_after(MemoryOperator::dahl, {path, number(1e-4)}, 3.0, n), -3.14028186e-5,
                1e-13);
}

/// dz = du − (|du| z + g du |z|)/δ by Euler's rule in very small steps.
double bouc_wen_by_hand(const Signal& u, double end_s, double yield, double g) {
  double z = 0.0, before = u(0.0);
  constexpr int kSteps = 2'000'000;
  for (int k = 1; k <= kSteps; ++k) {
    const double now = u(end_s * k / kSteps), du = now - before;
    z += du - (std::abs(du) * z + g * du * std::abs(z)) / yield;
    before = now;
  }
  return z;
}

TEST(BoucWen, AgreesWithAnIntegrationByHand) {
  const auto u = [](double t) { return 3e-3 * std::sin(2.0 * t) + 1e-3 * std::sin(7.0 * t); };
  // g of the published oscillator: −1.1/0.8, δ = 1/(1000 · 0.8) m [Noel2016]
  for (const double g : {-1.375, 0.0, 0.4})
    EXPECT_NEAR(value_after(MemoryOperator::bouc_wen, {u, number(1.25e-3), number(g)}, 4.0, 40000),
                bouc_wen_by_hand(u, 4.0, 1.25e-3, g), 1e-7)
        << g;
}

TEST(BoucWen, LoadsAndUnloadsInClosedForm) {
  // δ = 1, g = 0.5, u to 1: z = (1 − e^(−1.5))/1.5 = 0.517913227; back, |z| falls as
  // d|z|/dw = −1 − 0.5 |z|: after 0.2, (z + 2) e^(−0.1) − 2 = 0.278302103.
  const auto u = [](double t) { return t < 1.0 ? t : 2.0 - t; };
  const auto at = [&](double t, int n) {
    return value_after(MemoryOperator::bouc_wen, {u, number(1.0), number(0.5)}, t, n);
  };
  for (const int k : {1, 100}) {
    EXPECT_NEAR(at(1.0, 5 * k), 0.517913227, 1e-9);
    EXPECT_NEAR(at(1.2, 6 * k), 0.278302103, 1e-8);
  }
}

TEST(Work, CountsWhatIsDoneAgainstAForceAlone) {
  // f = 2x, x to 3 and back to 0: ∫ 2x dx = 9 on the way in, nothing on the way out.
  const auto x = [](double t) { return t < 1.0 ? 3.0 * t : 3.0 * (2.0 - t); };
  const auto f = [&](double t) { return 2.0 * x(t); };
  // The force of the first step counts as that of its end.
  EXPECT_NEAR(value_after(MemoryOperator::work, {f, x}, 2.0, 4000), 9.0, 1e-5);
}

TEST(SinceReversal, IsTheWaySinceTheMotionTurned) {
  // To 5 mm, back to 2 mm, at rest with 1 µm of jitter: 3 mm.
  const auto x = [](double t) {
    return t < 5.0   ? 1e-3 * t
           : t < 8.0 ? 1e-3 * (10.0 - t)
                     : 2e-3 + (int(std::lround(t * 10)) % 2 ? 1e-6 : 0.0);
  };
  EXPECT_NEAR(value_after(MemoryOperator::since_reversal, {x}, 4.0, 40, 2e-5), 4e-3, 1e-12);
  EXPECT_NEAR(value_after(MemoryOperator::since_reversal, {x}, 7.9, 79, 2e-5), 2.9e-3, 1e-12);
  EXPECT_NEAR(value_after(MemoryOperator::since_reversal, {x}, 9.0, 90, 2e-5), 3e-3, 1.1e-6);
}

TEST(SinceStop, CountsFromTheEndOfRest) {
  const auto v = [](double t) { return t < 1.05 ? 1e-6 : 0.01; };
  EXPECT_EQ(value_after(MemoryOperator::since_stop, {v}, 1.0, 10, 1e-5), 0.0);
  EXPECT_NEAR(value_after(MemoryOperator::since_stop, {v}, 1.5, 15, 1e-5), 0.5, 1e-12);
}

TEST(Age, GrowsAtRestAndComesToItsWayOverTheSpeed) {
  EXPECT_NEAR(value_after(MemoryOperator::age, {number(0.1), number(1e-4)}, 2.0, 7), 2.0, 1e-12);
  // At 1 mm/s with D = 0.1 mm: D/v = 0.1 s (1 − e^(−v t/D)).
  const auto x = [](double t) { return 1e-3 * t; };
  for (const int n : {1, 100})
    EXPECT_NEAR(value_after(MemoryOperator::age, {x, number(1e-4)}, 0.2, n),
                0.1 * (1.0 - std::exp(-2.0)), 1e-12);
}

TEST(Resonator, SwingsFreelyBehindASteadyMotion) {
  // Without damping, x = v t: y'' = ω v sin ωt. ω = 10 rad/s, v = 0.1 m/s, t = 0.3 s: sin 3.
  const auto x = [](double t) { return 0.1 * t; };
  const Signal f = number(10.0 / (2.0 * std::numbers::pi));
  for (const int n : {1, 300})
    EXPECT_NEAR(value_after(MemoryOperator::resonator, {x, f, number(0.0)}, 0.3, n), std::sin(3.0),
                1e-9);
}

TEST(Resonator, AnswersASineAsItsTransferFunctionSays) {
  // x = sin Ωt, long after the start: |y''| = Ω² |H|, H = (ω² + 2iζωΩ)/(ω² − Ω² + 2iζωΩ). ω = 20,
  // Ω = 15 rad/s, ζ = 0.2: |400 + 120i|/|175 + 120i| · 225 = 417.612/212.191 · 225 = 442.82.
  double most = 0.0;
  for (int k = 0; k < 42; ++k)
    most =
        std::max(most, std::abs(value_after(MemoryOperator::resonator,
                                            {[](double t) { return std::sin(15.0 * t); },
                                             number(20.0 / (2.0 * std::numbers::pi)), number(0.2)},
                                            10.0 + 0.01 * k, 10000 + 10 * k)));
  EXPECT_NEAR(most, 442.82, 1.5);
}

// ---- in a formula

std::vector<Quantity> signals() {
  std::vector<Quantity> out;
  for (const auto& [name, unit] : {std::pair{"x_m", "m"},
                                   {"v_m_s", "m/s"},
                                   {"base_N", "N"},
                                   {"k", "N/m"},
                                   {"tau", "s"},
                                   {"d", "m"},
                                   {"w", "J"},
                                   {"n", "1"}})
    out.push_back({name, *Dimension::parse(unit)});
  return out;
}
std::string answer(std::string_view formula) {
  const auto facts = check_formula(formula, signals(), *Dimension::parse("N"));
  return facts ? "taken" : facts.error().what;
}

TEST(AFormulaThatRemembers, IsTakenWhenItsUnitsFit) {
  for (const char* formula :
       {"k*lag(x_m, tau)", "k*play(x_m, d)", "k*dahl(x_m, d)", "k*bouc_wen(x_m, d, -1.375)",
        "base_N*exp(-work(base_N, x_m)/w)", "k*since_reversal(x_m)*sgn(v_m_s)",
        "base_N*exp(-since_stop(v_m_s)/tau)", "base_N*ln(1 + age(x_m, d)/tau)",
        "k*resonator(x_m, 1/tau, 0.1)*tau^2", "lag( k*lag(x_m, tau) , tau )/n",
        "k*lag(x_m, tau) + lag(base_N, tau)"})
    EXPECT_EQ(answer(formula), "taken") << formula;
}

TEST(AFormulaThatRemembers, IsRefusedByTheArgumentWhoseUnitDoesNotFit) {
  EXPECT_EQ(answer("k*lag(x_m, d)"), "`d`: m where lag(u, time_s) takes s");
  EXPECT_EQ(answer("k*dahl(x_m, tau)"), "`tau`: s where dahl(u, yield) takes m");
  EXPECT_EQ(answer("k*bouc_wen(x_m, d, d)"), "`d`: m where bouc_wen(u, yield, g) takes 1");
  EXPECT_THAT(answer("k*lag(x_m)"), HasSubstr("lag(u, time_s) is expected"));
  EXPECT_EQ(answer("k*since_stop(x_m)"), "`x_m`: m where since_stop(v) takes m/s");
  EXPECT_EQ(answer("since_reversal(x_m)"), "`since_reversal(x_m)`: m where N is expected");
  EXPECT_THAT(answer("k*(lag(x_m,tau)+lag(x_m,tau)+lag(x_m,tau)+lag(x_m,tau)+lag(x_m,tau)"
                     "+lag(x_m,tau)+lag(x_m,tau))"),
              HasSubstr("at most 6"));
}

TEST(AFormulaThatRemembers, EvaluatesInnerOperatorsFirst) {
  // lag(play(x, d) + 1·x, τ) of a jump from 0 to 1 over one step of τ: u = (1 − d/2) + 1, straight
  // over the step: z = u − u (1 − 1/e) = u/e; d = 0.2: 1.9/e.
  auto names = signals();
  const std::string formula = "lag( play(x_m,d)+n*x_m,tau)";
  const auto facts = check_formula(formula, names, *Dimension::parse("m"));
  ASSERT_TRUE(facts) << facts.error().what;
  auto program = FormulaProgram::make(formula, names, facts->memories);
  ASSERT_TRUE(program) << program.error().what;
  FormulaMemory memory;
  const auto in = program->inputs();
  in[4] = 0.3, in[5] = 0.2, in[7] = 1.0;
  EXPECT_EQ(program->value({}, memory), 0.0);
  in[0] = 1.0;
  EXPECT_NEAR(program->value({.dt_s = 0.3}, memory), 1.9 / std::numbers::e, 1e-12);
}

TEST(AFormula, NamesTheSignalThatWasLikelyMeant) {
  EXPECT_THAT(answer("k*v*tau"), HasSubstr("did you mean v_m_s?"));
  EXPECT_THAT(answer("k*X_m"), HasSubstr("did you mean x_m?"));
  EXPECT_THAT(answer("k*v_ms*tau"), HasSubstr("did you mean v_m_s?"));
  EXPECT_THAT(answer("base*n"), HasSubstr("did you mean base_N?"));
  EXPECT_THAT(answer("k*pressure"), testing::Not(HasSubstr("did you mean")));
}

}  // namespace
}  // namespace effects
}  // namespace tractus
