#include "lab/report/report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>

#include "effects/catalogues.hpp"
#include "lab/identify/verdict_text.hpp"
#include "lab/signal/phases.hpp"

namespace tractus {
namespace lab {
namespace {

/// Without the page itself in the message: it is long.
#define EXPECT_HOLDS(html, part) EXPECT_NE((html).find(part), std::string::npos) << (part)
#define EXPECT_LACKS(html, part) EXPECT_EQ((html).find(part), std::string::npos) << (part)

using testing::HasSubstr;

Side side(double error) {
  Side out;
  out.samples.channels = {{"fz_N", 0.05}};
  out.samples.judged = {0};
  out.samples.judged_name = "fz_N";
  out.samples.judged_unit = "N";
  out.samples.features = {{"direction", "", kDirections}, {"depth", "m", {}}};
  for (int t = 0; t < 4; ++t) {
    TrialSamples trial;
    trial.id = "trial" + std::to_string(t + 1);
    trial.measured.resize(1);
    trial.simulated.resize(1);
    trial.features.resize(2);
    for (int k = 0; k < 800; ++k) {
      const double s = 0.01 * k, way = std::sin(1.5 * s) >= 0.0 ? 1.0 : -1.0;
      trial.t_s.push_back(s);
      trial.measured[0].push_back(20.0 - 15.0 * std::cos(1.5 * s) + error * way);
      trial.simulated[0].push_back(20.0 - 15.0 * std::cos(1.5 * s));
      trial.features[0].push_back(way > 0.0 ? 0.0f : 1.0f);
      trial.features[1].push_back(float(0.01 - 0.01 * std::cos(1.5 * s)));
    }
    out.samples.trials.push_back(trial);
  }
  out.comparison = compare(out.samples);
  return out;
}

/// A made-up answer; its figures are this test's own.
ReportContent content() {
  ReportContent out;
  out.model_name = "layered <bone>";
  out.set_name = "set & more";
  out.before = side(2.31);
  out.given_rmse = 2.31;
  out.better = side(0.04);
  Diagnosis d;
  d.verdict = Verdict::missing;
  d.probability = 0.98;
  d.base = {1.97, 2.02, 0.05};
  d.effects = {{"coulomb_friction", 0.98, {{"friction_N", {2.31}, {0.02}}}}};
  d.ranking = {{"coulomb_friction", 0.98, 0.06, ""},
               {"hysteresis", 0.01, 0.07, ""},
               {"inertia", 0.0, std::nullopt, "not excited: the speed hardly changes"}};
  d.steps = {{"base", 1.97, 2.02, 0.04}, {"+ coulomb_friction", 0.05, 0.06, 0.05}};
  d.confounded = {{"hysteresis", "coulomb_friction"}};
  d.discriminating_experiment = DiscriminatingExperiment{
      {"hysteresis", "coulomb_friction"}, "three small reversals at 12 mm", 0.4};
  d.final_fit.folds = "trials";
  d.final_fit.noise_floor = 0.05;
  d.final_fit.estimates = {{"/base/layers/0/stiffness_N_per_m", 4100.0, 12.0, true, false},
                           {"/base/layers/0/equilibrium_m", 0.0, INFINITY, false, false},
                           {"coulomb_friction/friction_N", 2.31, 0.02, true, false}};
  const VerdictText said = sentences(d, "N");
  out.stated = {d.verdict, d.probability, said.headline, said.detail};
  out.diagnosis = d;
  out.start = {{"/base/layers/0/stiffness_N_per_m", 4000.0, 0.0, 1e6, 1.0}};
  return out;
}

TEST(Report, SaysTheVerdictFirstInPlainWords) {
  const std::string html = report(content());
  const auto verdict = html.find("Coulomb friction is missing.");
  ASSERT_NE(verdict, std::string::npos);
  EXPECT_LT(verdict, html.find("step by step"));
  EXPECT_THAT(html,
              HasSubstr("falls from 2.02&nbsp;N to 0.06&nbsp;N; the noise floor is 0.05&nbsp;N"));
}

TEST(Report, HoldsAllItPromises) {
  const std::string html = report(content());
  for (const char* heading :
       {"The error, step by step", "Measured and simulated", "Where the model fails",
        "What could be missing", "Parameters", "What these recordings cannot tell",
        "How the error is distributed", "Trial by trial", "What was taken for granted"})
    EXPECT_HOLDS(html, heading);
  for (const char* held :
       {"direction = out", "layer 1 · stiffness", "+2.5 %", "2.271 … 2.349",
        "not informed by these recordings", "three small reversals at 12 mm",
        "not excited: the speed hardly changes", "98 %", "prefers-color-scheme:dark", "trial4"})
    EXPECT_HOLDS(html, held);
}

TEST(Report, StandsAloneAndRunsNothing) {
  const std::string html = report(content());
  EXPECT_LACKS(html, "<script");
  EXPECT_LACKS(html, "<link rel=\"stylesheet");
  EXPECT_LACKS(html, "@import");
  // The only address is the name of SVG's vocabulary, which nobody fetches.
  const std::regex address(R"((https?:)?//[a-z])");
  const std::string without =
      std::regex_replace(html, std::regex("http://www.w3.org/2000/svg"), "");
  EXPECT_FALSE(std::regex_search(without, address));
}

TEST(Report, EscapesNamesFromFiles) {
  const std::string html = report(content());
  EXPECT_HOLDS(html, "layered &lt;bone&gt; against set &amp; more");
  EXPECT_LACKS(html, "<bone>");
}

TEST(Report, LeavesOutWhatThereIsNot) {
  ReportContent bare = content();
  bare.diagnosis.reset();
  bare.stated.reset();
  bare.better.reset();
  const std::string html = report(bare);
  EXPECT_HOLDS(html, "The model is off by 2.31 N.");
  EXPECT_LACKS(html, "What could be missing");
  EXPECT_LACKS(html, "held out");
}

TEST(Words, NameEffectsAndUnits) {
  EXPECT_EQ(effects::label_of("stribeck_friction"), "Stribeck friction");
  EXPECT_EQ(name_and_unit("coefficient_Ns2_per_m2").unit, "N·s²/m²");
  EXPECT_EQ(name_and_unit("yield_displacement_m").name, "yield displacement");
  EXPECT_EQ(figure(0.0123456, "N"), "0.0123 N");
  EXPECT_EQ(figure(4123.6), "4124");
  EXPECT_EQ(figure(2.5e-5), "2.5e-5");
  EXPECT_EQ(figure_with_uncertainty(4000.0123, 0.21), "4000.01");
  EXPECT_EQ(figure_with_uncertainty(2.29993, 0.06), "2.300");
}

TEST(Words, SayEachVerdict) {
  Diagnosis d = *content().diagnosis;
  d.verdict = Verdict::complete;
  EXPECT_EQ(sentences(d, "N").headline, "No effect is missing.");
  d.verdict = Verdict::partly;
  d.depends_on = "depth";
  EXPECT_THAT(sentences(d, "N").detail, HasSubstr("the noise floor. It varies with depth."));
  d.depends_on = "no recorded signal predicts it";
  EXPECT_THAT(sentences(d, "N").detail,
              HasSubstr("the noise floor. No recorded signal predicts it."));
  d.verdict = Verdict::unexplained;
  d.effects.clear();
  EXPECT_THAT(sentences(d, "N").headline, HasSubstr("not in the catalogue"));
}

}  // namespace
}  // namespace lab
}  // namespace tractus
