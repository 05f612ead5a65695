/// The engine on a problem that a person can see through: y = a + b u(t) and effects of known
/// shape, with white noise of variance 1 in the whitened residuals.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "lab/identify/diagnosis.hpp"
#include "lab/identify/fit.hpp"
#include "lab/identify/least_squares.hpp"
#include "lab/identify/residual_dependence.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr int kSamples = 400;
constexpr double kNoise = 0.05;

double u_of(int trial, int k) { return std::sin(0.031 * k * (1.0 + 0.1 * trial) + trial); }
double w_of(int trial, int k) { return std::cos(0.011 * k * (1.0 + 0.07 * trial) - 0.3 * trial); }

effects::EffectFacts facts(const std::string& id, bool shaped,
                           std::vector<std::string> parents = {}) {
  effects::EffectFacts f;
  f.id = id;
  f.params = {{.name = "size_N", .meaning = "", .initial = 1.0, .low = 0.0, .high = 100.0}};
  if (shaped)
    f.params.push_back({.name = "rate",
                        .meaning = "",
                        .initial = 1.0,
                        .low = 0.05,
                        .high = 20.0,
                        .off = std::numeric_limits<double>::quiet_NaN(),
                        .logarithmic = true});
  f.parents = std::move(parents);
  return f;
}

/// What is hidden: a function of trial and sample, N.
using Hidden = std::function<double(int, int)>;

class Toy final : public Problem {
 public:
  explicit Toy(const Hidden& hidden, int trials = 8) : trials_(trials) {
    std::mt19937_64 random(11);
    std::normal_distribution<> normal;
    for (int t = 0; t < trials; ++t) {
      measured_.emplace_back();
      for (int k = 0; k < kSamples; ++k)
        measured_.back().push_back(2.0 + 3.0 * u_of(t, k) + hidden(t, k) + kNoise * normal(random));
    }
    candidates_ = {{facts("cube", false), true, ""},
                   {facts("sign", false), true, ""},
                   {facts("soft_sign", true, {"sign"}), true, ""},
                   {facts("wave", false), true, ""},
                   {facts("silent", false), true, ""},
                   {facts("deaf", false), false, "its channel was not recorded"}};
  }
  void mean(std::string_view id, bool (*admissible)(std::span<const double>)) {
    for (auto& c : candidates_)
      if (c.facts.id == id) c.facts.admissible = admissible;
  }
  const SelectionThresholds& selection_thresholds() const override {
    return kSettings.probing_thresholds;
  }
  std::string_view rig() const override { return "toy"; }
  int trials() const override { return trials_; }
  std::string trial_id(int k) const override { return std::to_string(k); }
  double seconds(int) const override { return kSamples * 0.01; }
  const std::vector<Channel>& channels() const override { return channels_; }
  const std::vector<Candidate>& candidates() const override { return candidates_; }
  std::vector<Parameter> parameters(const Structure& structure) const override {
    std::vector<Parameter> out{
        {.pointer = "/base/a", .start = 1.0, .low = -10, .high = 10, .step = 0.01},
        {.pointer = "/base/b", .start = 2.0, .low = -10, .high = 10, .step = 0.01}};
    for (const auto& id : structure.effects)
      for (const auto& c : candidates_)
        if (c.facts.id == id)
          for (auto& p : parameters_of(c.facts)) out.push_back(p);
    return out;
  }
  Eigen::Index residual_size(int) const override { return kSamples; }
  void residuals(const Structure& structure, std::span<const double> v, int t,
                 Eigen::Ref<Eigen::VectorXd> out) const override {
    for (int k = 0; k < kSamples; ++k)
      out(k) = (measured_[std::size_t(t)][std::size_t(k)] - predicted(structure, v, t, k)) / kNoise;
  }
  int free_per_trial(const Structure&) const override { return 0; }
  double noise_floor(const Structure&, std::span<const double>) const override {
    return channels().front().noise_floor;
  }
  Residuals full_rate(const Structure& structure, std::span<const double> v, int t) const override {
    Residuals out{{}, {{}}, {}};
    for (int k = 0; k < kSamples; ++k) {
      out.t_s.push_back(0.01 * k);
      out.channels[0].push_back(measured_[std::size_t(t)][std::size_t(k)] -
                                predicted(structure, v, t, k));
      out.judgement.push_back(Judgement::judged);
    }
    return out;
  }
  States states(int t) const override {
    States out{{"u_m", "w_m"}, {{}, {}}};
    for (int k = 0; k < kSamples; ++k) {
      out.values[0].push_back(u_of(t, k));
      out.values[1].push_back(w_of(t, k));
    }
    return out;
  }
  std::vector<Derived> derived(const Structure&, std::span<const double>,
                               std::string_view) const override {
    return {};
  }
  const std::vector<std::string>& notes() const override { return notes_; }
  core::Json model(const Structure&, std::span<const double>) const override { return {}; }

 private:
  static double predicted(const Structure& structure, std::span<const double> v, int t, int k) {
    const double u = u_of(t, k), w = w_of(t, k);
    double out = v[0] + v[1] * u;
    std::size_t at = 2;
    for (const auto& id : structure.effects) {
      const double size = v[at++];
      if (id == "cube") out += size * u * u * u;
      if (id == "sign") out += size * (w > 0 ? 1.0 : -1.0);
      if (id == "wave") out += size * w * w;
      if (id == "soft_sign") out += size * std::tanh(w * 20.0 / v[at++]);
    }
    return out;
  }
  int trials_;
  std::vector<std::vector<double>> measured_;
  std::vector<Candidate> candidates_;
  std::vector<Channel> channels_{{"y_N", kNoise}};
  std::vector<std::string> notes_;
};

std::vector<std::string> ids(const Diagnosis& d) {
  std::vector<std::string> out;
  for (const auto& e : d.effects) out.push_back(e.id);
  std::ranges::sort(out);
  return out;
}
using Ids = std::vector<std::string>;

TEST(Diagnose, NothingHiddenIsCompleteAndNothingIsAdded) {
  const Toy toy([](int, int) { return 0.0; });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::complete);
  EXPECT_TRUE(d->effects.empty());
  EXPECT_NEAR(d->base.rmse, kNoise, 0.03 * kNoise);
  EXPECT_GT(d->probability, 0.8);
}

TEST(Diagnose, OneEffectIsNamedWithItsSizeAndTheErrorFallsToTheFloor) {
  const Toy toy([](int t, int k) { return 0.4 * std::pow(u_of(t, k), 3); });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::missing);
  ASSERT_EQ(ids(*d), Ids{"cube"});
  EXPECT_NEAR(d->effects[0].parameters[0].value[0], 0.4, 4.0 * d->effects[0].parameters[0].sd[0]);
  ASSERT_EQ(d->steps.size(), 2u);
  EXPECT_LT(d->steps[1].held_out_rmse, 1.05 * kNoise);
  EXPECT_EQ(d->ranking[0].id, "cube");
}

TEST(Diagnose, TwoEffectsAreBothNamedAndOnlyThey) {
  const Toy toy([](int t, int k) {
    return 0.4 * std::pow(u_of(t, k), 3) + 0.3 * (w_of(t, k) > 0 ? 1.0 : -1.0);
  });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::missing);
  EXPECT_EQ(ids(*d), (Ids{"cube", "sign"}));
}

TEST(Diagnose, AnEffectOnWhichTheTrialsDisagreeIsNotNamed) {
  // Sizes 0.6, 0, 0.6, 0 …: with their mean the error is half as large, but it is only 2.6 of its standard errors,
  // 0.6/√28, from 0. The 5 possible effects share a chance of 5 %: Student's t with 7 degrees of freedom asks for 3.5.
  const Toy toy([](int t, int k) { return t % 2 == 0 ? 0.6 * std::pow(u_of(t, k), 3) : 0.0; });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::unexplained);
  EXPECT_EQ(ids(*d), Ids{});
}

TEST(Fit, StandardErrorsCountWhatTheSamplesOfATrialHaveInCommon) {
  // A constant of each trial's own: the common one is known as the mean of 8 numbers is, s/√8, widened by √(1 + 3/8) for
  // so few and by 1.25 for what all have in common. By independent samples it would be known to 0.05/√3200 = 0.0009.
  const std::vector<double> own{0.3, -0.1, 0.2, 0.4, -0.3, -0.2, 0.1, -0.4};
  const Toy toy([&](int t, int) { return own[std::size_t(t)]; });
  const auto found = fit(toy, {});
  ASSERT_TRUE(found) << found.error().what;
  const double s = std::sqrt(0.6 / 7.0);  // Σ own² = 0.6, their mean is 0
  EXPECT_NEAR(found->estimates[0].sd, 1.25 * s / std::sqrt(8.0) * std::sqrt(1.0 + 3.0 / 8.0), 0.02);
}

/// A fit of the base, as a diagnosis begins.
Solution base_of(const Residual& residual) {
  std::vector<double> start;
  for (const Parameter& p : residual.problem().parameters({})) start.push_back(p.start);
  return search(residual, {}, std::move(start));
}

TEST(ResidualDependence, IsTheShareThatAFunctionOfTheSignalsTakesAway) {
  // cos(4w), w over a cosine: about nothing linear in u. Its mean square over its and the noise's.
  const Toy toy([](int t, int k) { return 0.2 * std::cos(4.0 * w_of(t, k)); });
  double squares = 0.0, mean = 0.0;
  for (int t = 0; t < 8; ++t)
    for (int k = 0; k < kSamples; ++k) mean += 0.2 * std::cos(4.0 * w_of(t, k)) / (8.0 * kSamples);
  for (int t = 0; t < 8; ++t)
    for (int k = 0; k < kSamples; ++k)
      squares += std::pow(0.2 * std::cos(4.0 * w_of(t, k)) - mean, 2) / (8.0 * kSamples);
  const Residual residual(toy, 1);
  const auto found = residual_dependence(residual, base_of(residual));
  EXPECT_NEAR(found.predictable, squares / (squares + kNoise * kNoise), 0.05);
  EXPECT_EQ(found.trials_better, 1.0);
  EXPECT_EQ(found.words.substr(0, 3), "w (");
}

TEST(ResidualDependence, NoiseIsNotPredictedHoweverSlowItIs) {
  // A random walk that fades: neighbouring samples are nearly alike, trials have nothing in common.
  std::mt19937_64 random(23);
  std::normal_distribution<> normal;
  std::vector<std::vector<double>> slow(8);
  for (auto& trial : slow) {
    double level = 0.0;
    for (int k = 0; k < kSamples; ++k) trial.push_back(level = 0.95 * level + 0.1 * normal(random));
  }
  const Toy toy([&](int t, int k) { return slow[std::size_t(t)][std::size_t(k)]; });
  const Residual residual(toy, 1);
  EXPECT_LT(residual_dependence(residual, base_of(residual)).predictable, 0.03);
}

TEST(Diagnose, NoiseAboveTheStatedFloorThatNothingPredictsIsNoEffect) {
  std::mt19937_64 random(29);
  std::normal_distribution<> normal;
  std::vector<std::vector<double>> more(8);
  for (auto& trial : more)
    for (int k = 0; k < kSamples; ++k) trial.push_back(kNoise * normal(random));
  const Toy toy([&](int t, int k) { return more[std::size_t(t)][std::size_t(k)]; });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d);
  EXPECT_EQ(d->verdict, Verdict::complete);
  EXPECT_NEAR(d->base.held_out_rmse, std::sqrt(2.0) * kNoise, 0.05 * kNoise);
}

TEST(Diagnose, ThreeAtOnceAreSaidToBePerhapsAnImitation) {
  const Toy toy([](int t, int k) {
    return 2.0 * std::pow(u_of(t, k), 3) + (w_of(t, k) > 0 ? 1.0 : -1.0) +
           2.0 * w_of(t, k) * w_of(t, k);
  });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d);
  EXPECT_EQ(ids(*d), (Ids{"cube", "sign", "wave"}));
  EXPECT_EQ(d->verdict, Verdict::partly);
  ASSERT_FALSE(d->notes.empty());
  EXPECT_EQ(d->notes.back().substr(0, 17), "3 effects togethe");
}

TEST(Diagnose, TheSimplerParentIsPreferredWhereTheChildDoesNoBetter) {
  const Toy toy([](int t, int k) { return 0.3 * (w_of(t, k) > 0 ? 1.0 : -1.0); });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(ids(*d), Ids{"sign"});
}

TEST(Diagnose, TheChildIsNamedWhereItsShapeShows) {
  const Toy toy([](int t, int k) { return 0.5 * std::tanh(w_of(t, k) * 20.0 / 10.0); });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  ASSERT_EQ(ids(*d), Ids{"soft_sign"});
  EXPECT_NEAR(d->effects[0].parameters[1].value[0], 10.0, 1.0);
}

TEST(Diagnose, AnEffectWhoseNumbersContradictItsLawIsNotNamed) {
  Toy toy([](int t, int k) { return 2.0 * std::pow(u_of(t, k), 3); });
  toy.mean("cube", [](std::span<const double> v) { return v[0] > 5.0; });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d);
  EXPECT_EQ(std::ranges::count(ids(*d), "cube"), 0);
  EXPECT_NE(d->verdict, Verdict::missing);
}

TEST(Fit, ATrialThatDisagreesWidensTheStandardErrors) {
  // Eight trials whose slope is 3, but for one of 3.5: by the noise alone the slope would be known
  // to 0.05/√(3200/2) = 0.00125; the trials disagree by 0.5/8 = 0.06 with an error of that size.
  const Toy toy([](int t, int k) { return t == 3 ? 0.5 * u_of(t, k) : 0.0; });
  const auto f = fit(toy, {});
  ASSERT_TRUE(f);
  EXPECT_NEAR(f->values[1], 3.0 + 0.5 / 8.0, 0.02);
  EXPECT_GT(f->estimates[1].sd, 0.03);
  EXPECT_LT(f->estimates[1].sd, 0.12);
}

TEST(Diagnose, WhatIsNotInTheCatalogueIsUnexplainedAndItsSignalNamed) {
  const Toy toy([](int t, int k) { return 0.5 * std::sin(25.0 * w_of(t, k)); });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->verdict, Verdict::unexplained);
  EXPECT_TRUE(d->effects.empty());
  EXPECT_EQ(d->depends_on.substr(0, 1), "w") << d->depends_on;
}

TEST(Diagnose, SaysOfEachEffectWhyItWasNotTried) {
  const Toy toy([](int, int) { return 0.0; });
  const auto d = diagnose(toy);
  ASSERT_TRUE(d);
  for (const auto& r : d->ranking) {
    if (r.id == "silent") {
      EXPECT_EQ(r.note.substr(0, 11), "not excited");
    }
    if (r.id == "deaf") {
      EXPECT_EQ(r.note, "its channel was not recorded");
    }
  }
}

TEST(Diagnose, OneTrialAloneIsAnsweredWithAWordOfCaution) {
  const Toy toy([](int t, int k) { return 0.4 * std::pow(u_of(t, k), 3); }, 1);
  const auto d = diagnose(toy);
  ASSERT_TRUE(d) << d.error().what;
  EXPECT_EQ(d->base_fit.folds, "stretches of time");
  ASSERT_FALSE(d->notes.empty());
  EXPECT_EQ(d->notes.back().substr(0, 12), "1 trial only");
}

TEST(Diagnose, StopsWhenAsked) {
  const Toy toy([](int, int) { return 0.0; });
  const auto d = diagnose(toy, {}, [](double) { return false; });
  ASSERT_FALSE(d);
  EXPECT_EQ(d.error().code, core::Errc::cancelled);
}

TEST(Fit, IsTheLeastSquaresLineOfALinearProblem) {
  // Without effects the problem is a straight line in u: its normal equations, solved by hand.
  const Toy toy([](int, int) { return 0.0; }, 4);
  double su = 0, suu = 0, sy = 0, suy = 0, n = 0;
  for (int t = 0; t < 4; ++t) {
    Eigen::VectorXd r(kSamples);
    toy.residuals({}, std::vector{0.0, 0.0}, t, r);
    for (int k = 0; k < kSamples; ++k) {
      const double u = u_of(t, k), y = r(k) * kNoise;
      su += u, suu += u * u, sy += y, suy += u * y, n += 1;
    }
  }
  const double b = (n * suy - su * sy) / (n * suu - su * su), a = (sy - b * su) / n;
  const auto f = fit(toy, {});
  ASSERT_TRUE(f) << f.error().what;
  EXPECT_NEAR(f->values[0], a, 2e-3 * kNoise);
  EXPECT_NEAR(f->values[1], b, 2e-3 * kNoise);
  // Var b = σ²/(Σu² − n ū²) is the least that is stated; four trials that disagree by chance state
  // more, not twice as much (a χ² of three degrees over its mean is above 4 in less than 1 %).
  const double textbook = kNoise / std::sqrt(suu - su * su / n);
  EXPECT_GT(f->estimates[1].sd, 0.95 * textbook);
  EXPECT_LT(f->estimates[1].sd, 2.0 * 1.33 * textbook);
  EXPECT_NEAR(f->whitened_rms, 1.0, 0.05);
}

TEST(Fit, RefusesAnEffectThatIsNotThereAndOneThatCannotBeShown) {
  const Toy toy([](int, int) { return 0.0; }, 4);
  EXPECT_NE(fit(toy, {{"nonsense"}}).error().what.find("'nonsense'"), std::string::npos);
  EXPECT_NE(fit(toy, {{"deaf"}}).error().what.find("not recorded"), std::string::npos);
}

/// NIST StRD nonlinear regression, Misra1a: y = b1 (1 − e^(−b2 x)).
class Misra1a final : public Problem {
 public:
  const SelectionThresholds& selection_thresholds() const override {
    return kSettings.probing_thresholds;
  }
  std::string_view rig() const override { return "nist"; }
  int trials() const override { return 1; }
  std::string trial_id(int) const override { return "misra1a"; }
  double seconds(int) const override { return 1.0; }
  const std::vector<Channel>& channels() const override { return channels_; }
  const std::vector<Candidate>& candidates() const override { return none_; }
  std::vector<Parameter> parameters(const Structure&) const override {
    return {{.pointer = "/b1", .start = 500.0, .low = 1.0, .high = 5000.0, .step = 1e-4},
            {.pointer = "/b2", .start = 1e-4, .low = 1e-7, .high = 1.0, .step = 1e-9}};
  }
  Eigen::Index residual_size(int) const override { return 14; }
  void residuals(const Structure&, std::span<const double> b, int,
                 Eigen::Ref<Eigen::VectorXd> out) const override {
    constexpr double x[] = {77.6,  114.9, 141.1, 190.8, 239.9, 289.0, 332.8,
                            378.4, 434.8, 477.3, 536.8, 593.1, 689.1, 760.0};
    constexpr double y[] = {10.07, 14.73, 17.94, 23.93, 29.61, 35.18, 40.02,
                            44.82, 50.76, 55.05, 61.01, 66.40, 75.47, 81.78};
    for (int k = 0; k < 14; ++k) out(k) = y[k] - b[0] * (1.0 - std::exp(-b[1] * x[k]));
  }
  int free_per_trial(const Structure&) const override { return 0; }
  double noise_floor(const Structure&, std::span<const double>) const override {
    return channels().front().noise_floor;
  }
  Residuals full_rate(const Structure&, std::span<const double>, int) const override { return {}; }
  States states(int) const override { return {}; }
  std::vector<Derived> derived(const Structure&, std::span<const double>,
                               std::string_view) const override {
    return {};
  }
  const std::vector<std::string>& notes() const override { return notes_; }
  core::Json model(const Structure&, std::span<const double>) const override { return {}; }

 private:
  std::vector<Channel> channels_{{"y", 0.1}};
  std::vector<Candidate> none_;
  std::vector<std::string> notes_;
};

TEST(LeastSquares, ReachesTheCertifiedValuesOfMisra1a) {
  const Misra1a problem;
  const Residual residual(problem, 1);
  const Solution s = search(residual, {}, {500.0, 1e-4}, nullptr,
                            {.max_iterations = 100, .tolerance = 1e-14, .fresh_jacobian = true});
  // https://www.itl.nist.gov/div898/strd/nls/data/misra1a.shtml
  EXPECT_NEAR(s.values[0], 2.3894212918e+02, 1e-4 * 238.9);
  EXPECT_NEAR(s.values[1], 5.5015643181e-04, 1e-4 * 5.5e-4);
  EXPECT_NEAR(s.residual.squaredNorm(), 1.2455138894e-01, 1e-6);
}

}  // namespace
}  // namespace lab
}  // namespace tractus
