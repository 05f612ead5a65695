/// `tractus stats` from the outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <checkout.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/json.hpp"

namespace tractus {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

const std::string kReference =
    std::string(checkout::kSource) + "/tests/golden/statistics-reference/";

struct Ran {
  int exit = -1;
  std::string out, err;
};

class Stats : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("tractus_stats_" + std::to_string(::getpid()) + "_" + core::new_id());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path file(const std::string& text) {
    const fs::path path = folder_ / "data.csv";
    EXPECT_TRUE(core::write_file(path, core::bytes_of(text)));
    return path;
  }
  std::string text_of(const fs::path& path) {
    const auto bytes = core::read_file(path);
    return bytes ? std::string(core::text_of(*bytes)) : "";
  }
  Ran run(const std::string& method, const std::string& data, const std::string& formula,
          const std::string& more = "") {
    const fs::path out = folder_ / "out", err = folder_ / "err";
    const std::string command = std::string(checkout::kBin) + "/tractus stats " + method +
                                " --data '" + data + "' --formula '" + formula + "' " + more +
                                " >'" + out.string() + "' 2>'" + err.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
  }
  core::Json json(const std::string& method, const std::string& data, const std::string& formula,
                  const std::string& more = "") {
    const Ran ran = run(method, kReference + "data/" + data, formula, "--json " + more);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    const auto parsed = core::parse_json(ran.out, "stdout");
    EXPECT_TRUE(parsed) << ran.out;
    return parsed ? *parsed : core::Json();
  }
  /// A method with the options as they stand.
  Ran plain(const std::string& options) {
    const fs::path out = folder_ / "out", err = folder_ / "err";
    const std::string command = std::string(checkout::kBin) + "/tractus stats " + options + " >'" +
                                out.string() + "' 2>'" + err.string() + "'";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(out), text_of(err)};
  }
  /// One line on standard error, exit 2, nothing on standard output.
  std::string refusal(const std::string& method, const std::string& data,
                      const std::string& formula) {
    const Ran ran = run(method, data, formula);
    EXPECT_EQ(ran.exit, 2) << ran.out;
    EXPECT_EQ(ran.out, "");
    EXPECT_EQ(std::ranges::count(ran.err, '\n'), 1) << ran.err;
    return ran.err;
  }
  core::Json expected(const std::string& name) {
    return *core::read_json(kReference + "expected/" + name + ".json");
  }

  fs::path folder_;
};

void expect_near(const core::Json& got, const core::Json& want, double relative) {
  ASSERT_TRUE(got.is_number()) << got.dump();
  EXPECT_NEAR(got.get<double>(), want.get<double>(), relative * std::abs(want.get<double>()));
}

TEST_F(Stats, PrintsThePublishedTable3AndSaysWhoSteersIt) {
  const Ran ran =
      run("ols", kReference + "data/paper_table2_table4.csv", "wrong_breach ~ experience_years");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("0.158828"));
  EXPECT_THAT(ran.out, HasSubstr("row 1 steers the fit (leverage 0.797, Cook's distance 1.09)"));
  const auto got = json("ols", "paper_table2_table4.csv", "wrong_breach ~ experience_years");
  const auto reference = expected("ols_paper_tables3_5");
  const auto& want = reference["table3"];
  for (const std::size_t j : {0u, 1u}) {
    expect_near(got["coefficients"][j]["estimate"], want["coef"][j], 1e-12);
    expect_near(got["coefficients"][j]["p"], want["p_value"][j], 1e-12);
  }
}

TEST_F(Stats, GivesTheReferenceValuesByEveryMethod) {
  const auto robust = json("robust", "paper_table2_table4.csv", "wrong_breach ~ experience_years");
  // statistics of the tool the paper used, 50-digit recomputation: slope, SE.
  expect_near(robust["coefficients"][1]["estimate"], 0.22252899, 1e-5);
  expect_near(robust["coefficients"][1]["standard_error"], 0.14965, 1e-4);

  const auto anova = json("anova", "PlantGrowth.csv", "weight ~ group");
  expect_near(anova["analysis"]["p"], expected("anova_oneway")["PlantGrowth"]["p_value"], 1e-11);

  const auto rm = json("rm-anova", "sim_lateral_breach_velocity.csv",
                       "breach_velocity_mm_s ~ repetition + (1|surgeon)");
  const auto want_rm = expected("rm_anova")["cases"]["breach_velocity_mm_s"];
  expect_near(rm["analysis"]["p_greenhouse_geisser"], want_rm["p_GG"], 1e-10);

  const auto lmm = json("lmm", "lmm_sleepstudy.csv", "y ~ days + (1|group)");
  const auto want_lmm = expected("lmm_random_intercept")["fits"]["lmm_sleepstudy"]["REML"];
  expect_near(lmm["model"]["variance_between"], want_lmm["tau2"], 1e-9);
  expect_near(lmm["coefficients"][0]["df"], want_lmm["satterthwaite_df"][0], 1e-9);

  const auto logistic =
      json("logistic", "paper_table2_table4.csv", "wrong_breach/breach_trials ~ experience_years");
  const auto want = expected("logistic")["paper_table2"];
  expect_near(logistic["coefficients"][1]["estimate"], want["coef"][1], 1e-11);
  expect_near(logistic["model"]["likelihood_ratio_p"], want["LR_p"], 1e-11);

  const auto mixed = json("logistic", "glmm_paper_total.csv", "y/m ~ experience_years + (1|group)");
  const auto want_mixed = expected("glmm_random_intercept")["fits"]["glmm_paper_total"]["exact_ML"];
  expect_near(mixed["model"]["sd_between_groups"], want_mixed["sigma_u"], 1e-8);
}

/// glmer's fits with nAGQ = 1: expected/logistic_random_terms.json of
/// logistic_random_terms.R (R 4.2.2, lme4 1.1.31, numDeriv 2016.8.1.1). SIMULATED data.
TEST_F(Stats, FitsAnswersWithCrossedTermsAsLme4Does) {
  const auto reference = expected("logistic_random_terms");
  const auto agrees = [&](const std::string& name, const std::string& formula) {
    const auto got = json("logistic", name + ".csv", formula);
    const auto& want = reference["fits"][name];
    expect_near(got["model"]["log_likelihood"], -0.5 * want["deviance"].get<double>(), 1e-10);
    expect_near(got["model"]["AIC"], want["aic"], 1e-10);
    for (const std::size_t j : {0u, 1u}) {
      const auto& row = got["coefficients"][j];
      const double estimate = want["fixef"][j], error = want["se"][j];
      expect_near(row["estimate"], estimate, 1e-6);
      expect_near(row["standard_error"], error, 1e-6);
      expect_near(row["odds_ratio"], std::exp(estimate), 1e-6);
      expect_near(row["odds_ratio95_high"], std::exp(estimate + 1.959964 * error), 1e-6);
    }
    for (const auto& row : got["random_effects"]) {
      const auto& block = want["covariances"][row["group"].get<std::string>()];
      const std::size_t slope = row["effect"] == "(Intercept)" ? 0 : 1;
      const std::size_t other = row["effect"] == "trial" ? 1 : 0;
      expect_near(row["covariance"], block[slope][other], 1e-5);
    }
    return got;
  };
  const auto single = agrees("sim_logistic_1", "y ~ trial + (1 | surgeon) + (1 | scenario)");
  ASSERT_EQ(single["random_effects"].size(), 2);
  int compared = 0;
  for (const auto& row : single["group_effects"]) {
    const auto& want = reference["fits"]["sim_logistic_1"];
    const std::string group = row["group"];
    if (row["name"] != want["first_levels"][group]) continue;
    expect_near(row["effect"], want["first_effects"][group], 1e-6);
    ++compared;
  }
  EXPECT_EQ(compared, 2);
  const auto sloped =
      agrees("sim_logistic_2", "y/m ~ trial + (1 + trial | surgeon) + (1 | scenario)");
  EXPECT_EQ(sloped["random_effects"].size(), 4);
}

TEST_F(Stats, MakesFactorsOfTextAndOfNumbersOnRequest) {
  const auto got = json("lmm", "sim_cohort_trials.csv",
                        "breach_velocity_mm_s ~ factor(repetition) + scenario + experience_years "
                        "+ (1|surgeon)",
                        "--drop-missing");
  EXPECT_EQ(got["rows"], 60);
  EXPECT_EQ(got["rows_left_out"], 60);
  const auto reference = expected("lmm_random_intercept");
  const auto& want = reference["fits"]["lmm_sim_balanced"]["REML"];
  EXPECT_EQ(got["coefficients"][1]["name"], "repetition[2]");
  expect_near(got["coefficients"][1]["estimate"], want["fixef"][1], 1e-9);
  expect_near(got["coefficients"][4]["p"], want["p_satterthwaite"][4], 1e-8);
}

TEST_F(Stats, SaysInOneLineWhatIsWrongWithTheData) {
  const auto data = file("y,x,z,g\n1,2,4,a\n2,3,6,b\n3,5,10,a\n5,4,8,b\n4,9,18,a\n").string();
  EXPECT_THAT(refusal("ols", data, "y ~ w"),
              HasSubstr("there is no column 'w'; the columns are y, x, z, g"));
  EXPECT_THAT(refusal("ols", data, "y ~ x + z"), HasSubstr("'z' is a linear combination of x"));
  EXPECT_THAT(refusal("ols", data, "g ~ x"),
              HasSubstr(":2: column 'g' should be a number and is 'a'"));
  EXPECT_THAT(refusal("ols", data, "y ~ x + (1|g)"), HasSubstr("needs 'lmm'"));
  EXPECT_THAT(refusal("lmm", data, "y ~ x"), HasSubstr("add (1|COLUMN)"));
  EXPECT_THAT(refusal("rm-anova", data, "y ~ x + (1|g)"), HasSubstr("has no row for"));
  EXPECT_THAT(refusal("ols", data, "y ~ x +"), HasSubstr("at character 8"));
  EXPECT_THAT(refusal("ols", folder_ / "none.csv", "y ~ x"), HasSubstr("No such file"));
}

TEST_F(Stats, RefusesFilesThatAreNoTable) {
  EXPECT_THAT(refusal("ols", file("y,x\n1,2\n2\n"), "y ~ x"),
              HasSubstr(":3: 1 cells, the header has 2"));
  EXPECT_THAT(refusal("ols", file("y,x\n1,2\n2,\n3,1\n4,4\n"), "y ~ x"),
              HasSubstr(":3: column 'x' has no value"));
  EXPECT_THAT(refusal("ols", file("y,x\n1,2\n2,3\n"), "y ~ x"), HasSubstr("at least 3 are needed"));
  EXPECT_THAT(refusal("ols", file("y,x\n"), "y ~ x"), HasSubstr("no row to analyse"));
  EXPECT_THAT(refusal("ols", file(""), "y ~ x"), HasSubstr("header line is empty"));
  EXPECT_THAT(refusal("ols", file("y\x01,x\n1,2\n"), "y ~ x"), HasSubstr("no text file"));
  EXPECT_THAT(refusal("ols", file("y,x\n5,1\n5,2\n5,4\n"), "y ~ x"),
              HasSubstr("there is nothing to explain"));
  EXPECT_THAT(refusal("ols", file("y,x\n1e300,1\n2e300,2\n3.5e300,3\n-9e300,1.5\n"), "y ~ x"),
              HasSubstr("rescale them"));
}

TEST_F(Stats, FallsBackToFirthWhereOutcomesAreSeparatedAndSaysSo) {
  const Ran ran = run("logistic", file("y,x\n0,1\n0,2\n1,3\n1,4\n"), "y ~ x");
  EXPECT_EQ(ran.exit, 0) << ran.err;
  EXPECT_THAT(ran.out, HasSubstr("Firth"));
  EXPECT_THAT(ran.out, HasSubstr("the columns separate the outcomes"));
}

TEST_F(Stats, GivesTheReferenceValuesByEveryFurtherMethod) {
  const auto power = core::parse_json(plain("power --json --test repeated").out, "stdout");
  EXPECT_EQ((*power)["answer"]["n"], 28);  // R: f = .25, rho = .5, eps = 1
  const auto simulated = core::parse_json(
      plain("power --json --test mixed --compares groups --trials 1 --effect 1 --n 17").out,
      "stdout");
  // R: power.t.test(n = 17, delta = 1)$power = 0.8070; five standard errors of 1000 runs.
  EXPECT_NEAR((*simulated)["answer"]["power"].get<double>(), 0.8070, 0.063);
  EXPECT_EQ((*simulated)["design"]["seed"], 1);
  const auto looks = core::parse_json(plain("looks --json --at 5 --power 0.9").out, "stdout");
  expect_near((*looks)["looks"][4]["z_bound"], 2.0310320, 1e-6);  // R: mvtnorm
  expect_near((*looks)["answer"]["times_the_size_of_one_look"], 1.0230779, 1e-6);
  const auto crossed =
      json("lmm", "sim_crossed_2.csv", "y ~ trial + (1 + trial | surgeon) + (1 | scenario)",
           "--df kenward-roger");
  const auto pbkrtest = expected("kenward_roger")["fits"]["sim_crossed_2"];
  expect_near(crossed["kenward_roger"][1]["standard_error"], pbkrtest["se"][1], 1e-6);
  expect_near(crossed["tests"][0]["p"], pbkrtest["p"][1], 1e-4);

  const auto p = json("p-adjust", "paper_table6_table7_p.csv", "p ~ table + scenario + measure");
  const auto want_p = expected("p_adjust")["paper_tables6_7"];
  for (std::size_t i = 0; i < 16; ++i) {
    expect_near(p["adjusted"][i]["hommel"], want_p["hommel"][i], 1e-14);
    expect_near(p["adjusted"][i]["holm"], want_p["holm"][i], 1e-14);
  }
  const auto exact =
      json("permutation", "paper_table2_table4.csv", "wrong_breach ~ experience_years");
  EXPECT_EQ(exact["analysis"]["as_extreme"], 2505);
  EXPECT_EQ(exact["analysis"]["arrangements"], 6300);

  const auto rank = json("rank", "sim_lateral_breach_velocity.csv",
                         "breach_velocity_mm_s ~ C(repetition) + (1|surgeon)");
  const auto want_rm = expected("rm_anova")["cases"]["breach_velocity_mm_s"];
  expect_near(rank["analysis"]["chi_squared"], want_rm["friedman"]["chi2"], 1e-12);

  const auto curve = json("learning-curve", "sim_learning_curve.csv", "time_s ~ trial");
  EXPECT_EQ(curve["best"], "power with plateau");

  const auto share = json("proportions", "paper_table2_table4.csv", "wrong_breach/6 ~ 1");
  // 9 of 60: Wilson 1 − (0.739, 0.919) of the 51 right ones, to their three digits.
  EXPECT_NEAR(share["proportions"][0]["wilson_low"].get<double>(), 1.0 - 0.919, 5e-4);
  EXPECT_NEAR(share["proportions"][0]["wilson_high"].get<double>(), 1.0 - 0.739, 5e-4);
}

TEST_F(Stats, AnalysesTwoWithinFactorsAndAGroupTogether) {
  const auto got =
      json("rm-anova", "sim_cohort_trials.csv",
           "breach_velocity_mm_s ~ scenario*repetition + (1|surgeon)", "--drop-missing");
  const auto want = expected("rm_anova")["cases"]["two_within_2x3"];
  for (std::size_t i = 0; i < 3; ++i) {
    expect_near(got["effects"][i]["F"], want["F"][i + 1], 1e-9);
    EXPECT_EQ(got["effects"][i]["df2"], want["den_df"][i + 1]);
  }
  EXPECT_EQ(got["effects"][2]["effect"], "scenario:repetition");
}

TEST_F(Stats, AnInteractionIsTestedByTheTermThatHoldsIt) {
  const auto got =
      json("ols", "sim_cohort_trials.csv", "operation_time_s ~ scenario*C(repetition)");
  ASSERT_EQ(got["tests"].size(), 1u);  // the margins are contained in it
  EXPECT_EQ(got["tests"][0]["term"], "scenario:repetition");
  EXPECT_EQ(got["tests"][0]["df1"], 6.0);
  EXPECT_EQ(got["coefficients"].size(), 12u);  // 4 × 3 cells
}

/// Extra hours of sleep of two groups of ten (Student 1908, R's data set `sleep`), each person with
/// two rows half an hour below and above; a third group beside them.
TEST_F(Stats, ComparesTwoGroupsOfPersonsEachCountedOnce) {
  const double sleep[] = {0.7, -1.6, -0.2, -1.2, -0.1, 3.4, 3.7, 0.8, 0.0, 2.0,
                          1.9, 0.8,  1.1,  0.1,  -0.1, 4.4, 5.5, 1.6, 4.6, 3.4};
  std::string rows = "extra,group,person\n";
  for (int i = 0; i < 20; ++i)
    for (const double half : {-0.5, 0.5})
      rows += std::to_string(sleep[i] + half) + (i < 10 ? ",first,p" : ",second,p") +
              std::to_string(i) + "\n";
  const std::string two = file(rows).string(), formula = "extra ~ group + (1|person)";
  const auto found = [&](const std::string& data, const std::string& more) {
    const Ran ran = run("effect-size", data, formula, "--json " + more);
    EXPECT_EQ(ran.exit, 0) << ran.err;
    return *core::parse_json(ran.out, "stdout");
  };
  const auto got = found(two, "");
  EXPECT_EQ(got["compared"], "second minus first");
  // R: t.test(extra ~ group, data = sleep), as its help page prints it, with the sign of second −
  // first: t = 1.8608, df = 17.776, p-value = 0.07939, interval -0.2054832 to 3.3654832.
  EXPECT_NEAR(got["difference"]["difference"].get<double>(), 1.58, 1e-12);
  EXPECT_NEAR(got["difference"]["t"].get<double>(), 1.8608, 5e-5);
  EXPECT_NEAR(got["difference"]["df"].get<double>(), 17.776, 5e-4);
  EXPECT_NEAR(got["difference"]["p"].get<double>(), 0.07939, 5e-6);
  EXPECT_NEAR(got["difference"]["ci95_low"].get<double>(), -0.2054832, 5e-8);
  EXPECT_NEAR(got["difference"]["ci95_high"].get<double>(), 3.3654832, 5e-8);
  // g = J(18) d and the interval of d by bisecting the noncentral t, integrated over chi-square by
  // Simpson's rule in Python; R's effectsize::hedges_g multiplies both by J as well.
  EXPECT_NEAR(got["effect"]["hedges_g"].get<double>(), 0.79693524, 1e-7);
  EXPECT_NEAR(got["effect"]["hedges_g_ci95_low"].get<double>(), -0.09140773, 1e-6);
  EXPECT_NEAR(got["effect"]["hedges_g_ci95_high"].get<double>(), 1.66517179, 1e-6);
  EXPECT_EQ(got["tests"][0]["effect"], "Hedges' g");

  const std::string three = file(rows + "9,third,x\n8,third,y\n").string();
  const auto turned = found(three, "--level first --reference second");
  EXPECT_EQ(turned["compared"], "first minus second");
  EXPECT_NEAR(turned["difference"]["t"].get<double>(), -1.8608, 5e-5);
  EXPECT_THAT(refusal("effect-size", three, formula), HasSubstr("has 3 values"));
  EXPECT_THAT(run("effect-size", three, formula, "--level first").err,
              HasSubstr("level and reference"));
  EXPECT_THAT(run("effect-size", three, formula, "--level first --reference nobody").err,
              HasSubstr("has no value 'nobody'"));
}

TEST_F(Stats, RefusesByNameWhatEachMethodCannotTake) {
  const auto data = file("y,g,s,t\n1,a,p,1\n0,a,q,2\n1,b,p,3\n2,b,q,4\n").string();
  EXPECT_THAT(refusal("recognition", data, "y ~ g"), HasSubstr(":5: column 'y' should be 0 or 1"));
  EXPECT_THAT(refusal("proportions", data, "y ~ g"), HasSubstr(":5: 2 of 1 is no count"));
  EXPECT_THAT(refusal("p-adjust", data, "y ~ 1"), HasSubstr(":5: 2 is no p-value"));
  EXPECT_THAT(refusal("icc", data, "y ~ g"), HasSubstr("icc needs the subject"));
  EXPECT_THAT(refusal("effect-size", data, "y ~ t"), HasSubstr("has 4 values"));
  EXPECT_THAT(refusal("learning-curve", data, "y ~ t"), HasSubstr("at least 5 trials"));
  EXPECT_THAT(refusal("rm-anova", data, "y ~ s + t + (1|g)"),
              HasSubstr("join the columns with '*'"));
  EXPECT_THAT(refusal("lmm", data, "y ~ t + (1|nobody)"), HasSubstr("there is no column 'nobody'"));
  EXPECT_THAT(refusal("lc-cusum", file("f,o\n1,1\n0,1\n").string(), "f ~ o"),
              HasSubstr("'o' is 1 twice"));
  EXPECT_THAT(refusal("anova", file("y,g\n1,a\n2,a\n").string(), "y ~ g"), HasSubstr("one group"));
  EXPECT_THAT(plain("power --test correlation --effect 2").err, HasSubstr("between -1 and 1"));
  EXPECT_THAT(plain("power --alpha 7").err, HasSubstr("option 'alpha' is '7'"));
  EXPECT_THAT(plain("looks --at many").err, HasSubstr("'many' in at 'many' is no number"));
  EXPECT_THAT(plain("power --test mixed --n 2.5").err, HasSubstr("n is 2.5; a whole number"));
  EXPECT_THAT(plain("power --test mixed --trials 1").err, HasSubstr("needs 2 trials of each"));
  EXPECT_EQ(plain("magic").exit, 2);
}

TEST_F(Stats, NumbersAtTheEdgesOfADoubleGetAnAnswerOrAName) {
  const auto tiny = file("y,g\n1e-300,a\n2e-300,a\n3e-300,b\n5e-300,b\n").string();
  EXPECT_THAT(refusal("anova", tiny, "y ~ g"), HasSubstr("rescale them"));
  const auto huge = file("y,g\n1e300,a\n2e300,a\n3e300,b\n5e300,b\n").string();
  EXPECT_THAT(refusal("anova", huge, "y ~ g"), HasSubstr("rescale them"));
  // Ranks do not mind.
  EXPECT_EQ(run("rank", huge, "y ~ g").exit, 0);
}

TEST_F(Stats, NoMethodGivesANumberOfScalesThatADoubleCannotSquare) {
  const auto rows = [&](const std::string& power) {
    std::string out = "y,x,g,s,k,o,f\n";
    const double y[] = {1.2, 2.9, 2.2, 4.1, 3.3, 5.2, 2.4, 3.8, 4.9};
    for (int i = 0; i < 9; ++i)
      out += std::to_string(y[i]) + power + "," + std::to_string(3.1 * y[8 - i] + i) + power + "," +
             (i % 2 ? "a" : "b") + ",s" + std::to_string(i / 3) + "," + std::to_string(i % 3) +
             "," + std::to_string(i + 1) + "," + (i % 4 ? "1" : "0") + "\n";
    return file(out).string();
  };
  const std::pair<const char*, const char*> asked[] = {
      {"ols", "y ~ x"},         {"ols", "o ~ x"},
      {"robust", "y ~ x"},      {"robust", "o ~ x"},
      {"anova", "y ~ g"},       {"rm-anova", "y ~ k + (1|s)"},
      {"lmm", "y ~ x + (1|s)"}, {"lmm", "o ~ x + (1|s)"},
      {"logistic", "f ~ x"},    {"effect-size", "y ~ g"},
      {"icc", "y ~ k + (1|s)"}, {"hotelling", "g ~ y + o"},
      {"permutation", "y ~ o"}, {"learning-curve", "y ~ o"},
  };
  for (const char* power : {"e300", "e-300"}) {
    const auto data = rows(power);
    for (const auto& [method, formula] : asked)
      EXPECT_THAT(refusal(method, data, formula), HasSubstr("rescale"))
          << method << " " << formula << " " << power;
  }
  const auto plain_rows = rows("");
  for (const auto& [method, formula] : asked)
    EXPECT_EQ(run(method, plain_rows, formula).exit, 0) << method << " " << formula;
}

TEST_F(Stats, ASlipAmongNumbersIsNamedAndMakesNoFactor) {
  const auto data = file("y,x\n1,2\n2,3\n3,o\n4,5\n5,7\n").string();
  for (const char* method : {"ols", "robust", "rank", "logistic"})
    EXPECT_THAT(refusal(method, data, "y ~ x"), HasSubstr(":4: column 'x' holds numbers"));
  EXPECT_EQ(run("rank", data, "y ~ C(x)").exit, 0);
  EXPECT_THAT(refusal("confusion", file("a,b\n1,x\n0,y\n1,y\n").string(), "a ~ b"),
              HasSubstr("no label in common"));
}

TEST_F(Stats, WaldsTestAndHotellingsRunFromFiles) {
  // Four failures in a row pass ln((1 - 0.2)/0.05) = 2.77 at 0.916 each.
  const auto got = core::parse_json(
      run("sprt", file("failed,n\n1,1\n1,2\n1,3\n1,4\n0,5\n").string(), "failed ~ n", "--json").out,
      "stdout");
  ASSERT_TRUE(got);
  EXPECT_EQ((*got)["persons"][0]["verdict"], "inadequate");
  EXPECT_EQ((*got)["persons"][0]["at_trial"], 4);
  const auto want = expected("rm_anova")["cases"]["breach_velocity_mm_s"]["hotelling"];
  const auto t2 = json("hotelling", "sim_lateral_breach_velocity.csv",
                       "breach_velocity_mm_s ~ C(repetition) + (1|surgeon)");
  expect_near(t2["analysis"]["T_squared"], want["T2"], 1e-10);
  expect_near(t2["analysis"]["p"], want["p_value"], 1e-10);
}

}  // namespace
}  // namespace tractus
