#include "lab/discover/grammar.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lab/discover/formula_effect.hpp"

namespace tractus {
namespace lab {
namespace {

SignalScales scales() {
  return {.least_depth_m = 0.0,
          .most_depth_m = 0.02,
          .slow_m_s = 1e-3,
          .fast_m_s = 0.03,
          .longest_s = 8.0,
          .work_J = 0.5,
          .turning_rad_s = 2.0};
}

TEST(Grammar, StatesTheUnitThatEachFactorHas) {
  for (const Factor& factor : factors_of(scales())) {
    const auto facts = effects::check_formula(factor.text, quantities_of(factor), std::nullopt);
    ASSERT_TRUE(facts) << factor.text << ": " << facts.error().what;
    EXPECT_EQ(facts->dimension, factor.unit) << factor.text;
    for (const FactorNumber& number : factor.numbers)
      EXPECT_TRUE(number.low < number.value && number.value < number.high) << number.name;
  }
}

TEST(Grammar, MakesEffectsOfItsTerms) {
  const auto factors = factors_of(scales());
  const auto terms = terms_of(factors);
  std::set<std::string> seen;
  for (const Term& term : terms)
    if (seen.insert(term.family).second) {
      const FormulaEffect effect = formula_effect("expression:one", term, factors, 2.5);
      EXPECT_EQ(effect.facts.params.size(), 1 + effect.numbers.size());
      EXPECT_EQ(effect.facts.params[0].off, 0.0) << term.family;  // it can be off
    }
  EXPECT_GT(seen.size(), 100u);
  // Of the oscillators and of others' hidden physics.
  for (const char* family :
       {"bouc_wen(x_m, yield_m, g)", "abs(base_N) * sgn(v_m_s)", "abs(v_m_s)", "(x_m - centre_m)^3",
        "resonator(x_m, frequency_Hz, damping_ratio)",
        "sgn(v_m_s) * since_reversal(x_m)/(since_reversal(x_m) + way_m)",
        "base_N * (1 - exp(-work(base_N, x_m)/work_J))", "sgn(v_m_s)*abs(v_m_s)^0.4",
        "exp(-((x_m - centre_m)/width_m)^2) * sgn(v_m_s)"})
    EXPECT_TRUE(seen.contains(family)) << family;
}

TEST(Grammar, HasNoTurningWhereNothingTurned) {
  SignalScales still = scales();
  still.turning_rad_s = 0.0;
  for (const Factor& factor : factors_of(still))
    EXPECT_EQ(factor.text.find("omega"), std::string::npos) << factor.text;
}

TEST(Grammar, SaysInPhysicsWhatATermIs) {
  const auto factors = factors_of(scales());
  const auto terms = terms_of(factors);
  const auto words = [&](const std::string& family) {
    return words_of(*std::ranges::find(terms, family, &Term::family), factors);
  };
  EXPECT_EQ(words("abs(base_N) * sgn(v_m_s)"),
            "dry friction (Coulomb) in proportion to the load (Amontons)");
  EXPECT_EQ(words("bouc_wen(x_m, yield_m, g)"), "hysteresis (Bouc–Wen)");
}

}  // namespace
}  // namespace lab
}  // namespace tractus
