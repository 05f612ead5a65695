/// Plans: locks, exclusions, corrections, and the published study recomputed.
#include "assessment/plan.hpp"

#include <gtest/gtest.h>

#include <checkout.hpp>

#include "assessment/analyse.hpp"
#include "assessment/plan_page.hpp"
#include "assessment/snapshot.hpp"
#include "core/file.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

const std::string kExample =
    std::string(checkout::kSource) + "/shared/assessment/examples/probing-study/";
const std::string kReference =
    std::string(checkout::kSource) + "/tests/golden/statistics-reference/";

Table table_in_file(const std::string& path) {
  auto out = Table::read(path, {}, Missing::keep);
  EXPECT_TRUE(out) << out.error().what;
  return std::move(*out);
}

Plan plan_of(const Json& json) {
  auto out = Plan::from_json(json, "plan.json");
  EXPECT_TRUE(out) << out.error().what;
  return std::move(*out);
}

Json small_plan() {
  return {{"format", "tractus-plan/1"},
          {"title", "t"},
          {"question", "q"},
          {"subject", "surgeon"},
          {"exclusions", {{{"where", "scenario = soft"}, {"reason", "not asked"}}}},
          {"analyses",
           {{{"id", "time"},
             {"family", "primary"},
             {"method", "rm-anova"},
             {"formula", "breach_velocity_mm_s ~ repetition + (1|surgeon)"},
             {"where", "scenario = lateral"}},
            {{"id", "none"},
             {"family", "primary"},
             {"method", "ols"},
             {"formula", "operation_time_s ~ experience_years"},
             {"term", "age"}}}}};
}

TEST(Plan, ALockHoldsEveryWordAndNoLayout) {
  const auto locked_once = locked(small_plan(), "p", {"A", "2026-01-01T00:00:00Z", false, ""});
  ASSERT_TRUE(locked_once);
  EXPECT_TRUE(check_lock(plan_of(*locked_once), "p"));
  // Written with other blanks it is the same plan.
  const auto again = core::parse_json(locked_once->dump(7), "p");
  EXPECT_TRUE(check_lock(plan_of(*again), "p"));
  Json changed = *locked_once;
  changed["analyses"][0]["formula"] = "breach_velocity_mm_s ~ repetition + (1|group)";
  const auto refused = check_lock(plan_of(changed), "p");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::conflict);
  EXPECT_FALSE(locked(*locked_once, "p", {"B", "2027", false, ""}));
  EXPECT_FALSE(check_lock(plan_of(small_plan()), "p"));
  EXPECT_FALSE(locked(small_plan(), "p", {"", "2026", false, ""}));
}

TEST(Plan, RefusesUnknownMethodsOptionsAndDoubleIds) {
  const auto refusal = [](const std::function<void(Json&)>& change) {
    Json json = small_plan();
    change(json);
    const auto plan = Plan::from_json(json, "p");
    return plan ? std::string() : plan.error().what;
  };
  EXPECT_NE(refusal([](Json& j) {
              j["analyses"][0]["method"] = "magic";
            }).find("/analyses/0/method: there is no method 'magic'"),
            std::string::npos);
  EXPECT_NE(refusal([](Json& j) {
              j["analyses"][0]["options"] = {{"x", 1}};
            }).find("there is no option 'x'"),
            std::string::npos);
  EXPECT_NE(refusal([](Json& j) { j["analyses"][1]["id"] = "time"; }).find("stands there twice"),
            std::string::npos);
  EXPECT_NE(refusal([](Json& j) { j["correction"] = "luck"; }).find("/correction"),
            std::string::npos);
  EXPECT_NE(refusal([](Json& j) { j["colour"] = 1; }).find("not known"), std::string::npos);
  EXPECT_NE(refusal([](Json& j) { j["exclusions"][0]["where"] = "soft"; }).find("COLUMN = VALUE"),
            std::string::npos);
  EXPECT_NE(refusal([](Json& j) { j["analyses"] = Json::array(); }).find("one analysis"),
            std::string::npos);
}

TEST(Analyse, ExcludesWithReasonsCorrectsAndGivesTheSameBytesAgain) {
  const Table table = table_in_file(kReference + "data/sim_cohort_trials.csv");
  const Plan plan = plan_of(small_plan());
  const auto once = analyse(plan, table);
  ASSERT_TRUE(once) << once.error().what;
  const Json& r = once->result;
  EXPECT_EQ(r["data"]["rows"], 120);
  EXPECT_EQ(r["data"]["rows_used"], 90);  // 10 surgeons × 3 soft trials left out
  EXPECT_EQ(r["data"]["exclusions"][0]["rows"], 30);
  EXPECT_EQ(r["data"]["subjects"], 10);
  EXPECT_EQ(std::ranges::count(once->excluded_because, "not asked"), 30);
  // R's car: the reference's lateral breach velocity.
  const auto expected = core::read_json(kReference + "expected/rm_anova.json");
  const double p = (*expected)["cases"]["breach_velocity_mm_s"]["p_GG"];
  const auto& tests = r["families"][0]["tests"];
  ASSERT_EQ(tests.size(), 2u);
  EXPECT_NEAR(tests[0]["p"].get<double>(), p, 1e-10 * p);
  // The second analysis has no term 'age': it counts as p = 1, so Holm doubles the first.
  EXPECT_EQ(tests[1]["p"], 1.0);
  EXPECT_NEAR(tests[0]["p_adjusted"].get<double>(), 2.0 * p, 1e-10 * p);
  EXPECT_TRUE(tests[0]["holds"].get<bool>());
  const auto twice = analyse(plan, table);
  EXPECT_EQ(twice->result.dump(), r.dump());
}

TEST(Analyse, SaysForWhatTheStudyWasPlannedBesideWhatTheDataHave) {
  Json json = small_plan();
  json["analyses"].push_back({{"id", "size"},
                              {"method", "power"},
                              {"options",
                               {{"test", "mixed"},
                                {"compares", "groups"},
                                {"n", 17},
                                {"trials", 1},
                                {"effect", 1},
                                {"runs", 400}}}});
  const auto done =
      analyse(plan_of(json), table_in_file(kReference + "data/sim_cohort_trials.csv"));
  ASSERT_TRUE(done) << done.error().what;
  const auto& answer = done->result["analyses"][2]["report"]["answer"];
  // R: power.t.test(n = 17, delta = 1)$power = 0.8070; five standard errors of 400 runs.
  EXPECT_NEAR(answer["power"].get<double>(), 0.8070, 0.1);
  std::string sentences;
  for (const auto& sentence : done->result["results"]) sentences += sentence.get<std::string>();
  EXPECT_NE(sentences.find("'size': planned for 17 surgeons per group and an effect of 1, power "),
            std::string::npos);
  EXPECT_NE(sentences.find("; the data have 10 subjects."), std::string::npos);
}

TEST(Analyse, StopsWhenAsked) {
  const Table table = table_in_file(kReference + "data/sim_cohort_trials.csv");
  Json json = small_plan();
  json["analyses"][0] = {
      {"id", "mixed"},
      {"method", "lmm"},
      {"formula", "operation_time_s ~ repetition + (1 | surgeon) + (1 | scenario)"}};
  std::vector<double> shares;
  const auto stopped = analyse(plan_of(json), table, {}, [&](double share) {
    shares.push_back(share);
    return shares.size() < 4;  // within the first analysis
  });
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Errc::cancelled);
  ASSERT_EQ(shares.size(), 4u);
  EXPECT_GT(shares[3], 0.0);
  EXPECT_LT(shares[3], 0.5);
}

TEST(Analyse, SaysWhatCouldNotBeDone) {
  Json json = small_plan();
  json["analyses"][0]["formula"] = "breach_velocity_mm_s ~ repetition + (1|scenario)";
  const auto done =
      analyse(plan_of(json), table_in_file(kReference + "data/sim_cohort_trials.csv"));
  ASSERT_TRUE(done);
  EXPECT_TRUE(done->result["analyses"][0].contains("error"));
  EXPECT_EQ(done->result["families"][0]["tests"][0]["p"], 1.0);
  json["exclusions"][0]["where"] = "repetition >= 1";
  EXPECT_FALSE(analyse(plan_of(json), table_in_file(kReference + "data/sim_cohort_trials.csv")));
}

TEST(Example, RecomputesTheSixteenPublishedNumbersAndNamesTheSlips) {
  const auto json = core::read_json(kExample + "plan.json");
  ASSERT_TRUE(json) << json.error().what;
  const auto done = analyse(plan_of(*json), table_in_file(kExample + "surgeons.csv"));
  ASSERT_TRUE(done) << done.error().what;
  int agree = 0, disagree = 0;
  for (const auto& one : done->result["published"])
    if (one.contains("agrees")) (one["agrees"].get<bool>() ? agree : disagree) += 1;
  EXPECT_EQ(agree, 17);    // Tables 3 and 5, and the 85 %
  EXPECT_EQ(disagree, 1);  // the 81.8 %: 97 of 120 are 80.83 %
  for (const auto& one : done->result["analyses"])
    EXPECT_FALSE(one.contains("error")) << one.dump();
  const std::string page = report_page(*done);
  // shared statistics.md's values: both senior surgeons' modified Z, n = 81, exact p 0.3976.
  for (const char* text : {"9.07", "4.2", "81 surgeons", "0.3976", "0.8083", "Type II"})
    EXPECT_NE(page.find(text), std::string::npos) << text;
  EXPECT_EQ(page.find("(not computed)"), std::string::npos);
  EXPECT_EQ(page.find("<script"), std::string::npos);
}

TEST(Example, CorrectsThePublishedPValues) {
  const auto json = core::read_json(kExample + "plan-p-values.json");
  ASSERT_TRUE(json);
  const auto done = analyse(plan_of(*json), table_in_file(kExample + "p-values.csv"));
  ASSERT_TRUE(done) << done.error().what;
  const std::string page = report_page(*done);
  EXPECT_NE(page.find("0.001608"), std::string::npos);  // R's p.adjust, Table 6
  EXPECT_NE(page.find("0.2508"), std::string::npos);    // Table 7, Holm
  EXPECT_NE(page.find("0.1344"), std::string::npos);    // Table 7, Benjamini-Hochberg
}

TEST(Snapshot, KnowsItsColumnsAndRefusesChangedData) {
  const auto bytes = core::bytes_of("who,force_N,n\na,1.5,1\nb,,2\n");
  const auto made = frozen({bytes.begin(), bytes.end()},
                           {"x", "2026-01-01T00:00:00Z", "", true, {{"force_N", "mean force"}}});
  ASSERT_TRUE(made) << made.error().what;
  const auto& words = made->description["dictionary"];
  EXPECT_EQ(words[0]["levels"], Json({"a", "b"}));
  EXPECT_EQ(words[1]["unit"], "N");
  EXPECT_EQ(words[1]["meaning"], "mean force");
  EXPECT_EQ(words[1]["missing"], 1);
  EXPECT_EQ(words[1]["highest"], 1.5);
  const auto folder =
      std::filesystem::temp_directory_path() / ("tractus_snapshot_" + core::new_id());
  ASSERT_TRUE(write(*made, folder));
  EXPECT_FALSE(write(*made, folder));
  EXPECT_TRUE(Snapshot::read(folder));
  ASSERT_TRUE(core::write_file(folder / "data.csv", core::bytes_of("who,force_N,n\na,1.6,1\n")));
  const auto refused = Snapshot::read(folder);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::conflict);
  std::filesystem::remove_all(folder);
  EXPECT_FALSE(frozen({bytes.begin(), bytes.end()}, {"x", "", "", false, {{"age", "?"}}}));
}

TEST(Worded, GivesStatisticsAsPapersPrintThem) {
  EXPECT_EQ(worded({{"statistic", "F"},
                    {"value", 5.97159},
                    {"df1", 1.942},
                    {"df2", 17.478},
                    {"p", 0.011034}}),
            "F(1.94, 17.48) = 5.97, p = 0.011");
  EXPECT_EQ(worded({{"statistic", "t"},
                    {"value", -2.0},
                    {"df2", 8.0},
                    {"p", 1e-9},
                    {"effect", "slope"},
                    {"size", 0.5},
                    {"ci95_low", 0.1},
                    {"ci95_high", 0.9}}),
            "t(8) = -2, p < 0.001, slope 0.5 (95 % interval 0.1 to 0.9)");
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
