/// The page of one trainee.
#include "assessment/trainee.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace tractus {
namespace assessment {
namespace {

const statistics::Rates kRates{0.10, 0.25};

/// One trainee, scenarios in turn; 1 is right.
Cohort cohort_with(const std::string& answers) {
  std::string text = "participant,order,scenario,correct,time_s\n";
  for (std::size_t i = 0; i < answers.size(); ++i)
    text += fmt::format("p,{},{},{},{}\n", i + 1, i % 2 ? "soft" : "hard", answers[i], 10 - i % 3);
  const auto bytes = core::bytes_of(text);
  TraineeColumns columns;
  columns.scores = {"time_s"};
  const auto table =
      Table::parse({bytes.begin(), bytes.end()}, "t.csv", columns.all(), Missing::keep);
  EXPECT_TRUE(table);
  auto out = cohort_of(*table, columns);
  EXPECT_TRUE(out) << out.error().what;
  return std::move(*out);
}

core::Json report(const std::string& answers, std::optional<double> threshold = {}) {
  const auto cohort = cohort_with(answers);
  return trainee_report(cohort, 0, certification(kRates), {kRates, threshold, 1.25}).report;
}

TEST(Certification, IsTheShortestRuleThatKeepsBothErrors) {
  const auto rule = certification(kRates);
  ASSERT_GT(rule.trials, 12);
  const auto n = static_cast<std::size_t>(rule.trials - 1);
  EXPECT_LE(rule.passes_if_inadequate[n], 0.05);
  EXPECT_GE(rule.passes_if_adequate[n], 0.80);
  EXPECT_LT(rule.passes_if_adequate[n - 1], 0.80);
  // Rates that hardly differ cannot be told apart within 400 trials.
  EXPECT_EQ(certification({0.10, 0.11}).trials, 0);
}

TEST(Trainee, TwelveRightOfTwelveCertifyNobodyAndThePageSaysSo) {
  const auto r = report(std::string(12, '1'), 1.25);
  EXPECT_EQ(r["state"], "competent");  // at h = 1.25: 7 successes of ln 1.2 = 0.182 each
  EXPECT_EQ(r["competent_at_trial"], 7);
  EXPECT_EQ(r["certified"], false);
  const std::string why = r["why"];
  EXPECT_NE(why.find("12 trials are too few"), std::string::npos) << why;
  // Exact dynamic programming of the reference: 0.300 of the inadequate pass h = 1.25 within 12.
  EXPECT_NE(why.find("30 %"), std::string::npos) << why;
}

TEST(Trainee, SixtyRightAreCertifiedAndALapseIsSeen) {
  const auto good = report(std::string(60, '1'));
  EXPECT_EQ(good["certified"], true) << good["why"];
  // After the signal two failures (2 × 0.916 > 1.25) raise the alarm.
  const auto lapsed = report(std::string(60, '1') + "00");
  EXPECT_EQ(lapsed["state"], "relapsed");
  EXPECT_EQ(lapsed["relapses"],
            core::Json::parse(R"([{"at_trial": 62, "recovered_at_trial": null}])"));
  EXPECT_EQ(lapsed["certified"], false);
}

TEST(Trainee, ARelapseEndsWhereItsSumIsBackAtZero) {
  // By hand: a failure adds ln(0.25/0.10) = 0.9163, a success takes ln(0.90/0.75) = 0.1823. Two
  // failures from 0 make 1.8326, so that the 11th success (11 · 0.1823 = 2.0055) is the first that
  // leaves nothing: after 10 there is 0.0094.
  const std::string lapsed = std::string(60, '1') + "00";
  EXPECT_EQ(report(lapsed + std::string(10, '1'))["state"], "relapsed");
  const auto back = report(lapsed + std::string(11, '1'));
  EXPECT_EQ(back["state"], "competent");
  EXPECT_EQ(back["relapses"], core::Json::parse(R"([{"at_trial": 62, "recovered_at_trial": 73}])"));
  EXPECT_EQ(back["certified"], true) << back["why"];
  EXPECT_NE(back["why"].get<std::string>().find("recovered at trial 73"), std::string::npos);
  // And may come again.
  const auto again = report(lapsed + std::string(11, '1') + "00");
  EXPECT_EQ(again["state"], "relapsed");
  EXPECT_EQ(again["relapses"].size(), 2u);
  EXPECT_EQ(again["relapses"][1]["at_trial"], 75);
}

TEST(Trainee, NextIsTheScenarioThatMayFailMostAndTheLeastRecentOfEquals) {
  EXPECT_EQ(report("010101")["next"]["scenario"], "hard");  // hard always wrong
  EXPECT_EQ(report("1111")["next"]["scenario"], "hard");    // equal; hard was done longer ago
  const auto r = report("0101010101");
  EXPECT_EQ(r["scenarios"][0]["verdict"], "weakness");       // 0 of 5: at most 43 %
  EXPECT_EQ(r["scenarios"][1]["verdict"], "not known yet");  // 5 of 5: at least 57 % only
}

TEST(Trainee, RefusesAnswersAndOrdersThatAreNone) {
  const auto refusal = [](const std::string& rows) {
    const std::string text = "participant,order,scenario,correct\n" + rows;
    const auto bytes = core::bytes_of(text);
    const auto table = Table::parse({bytes.begin(), bytes.end()}, "t.csv", {}, Missing::keep);
    const auto cohort = cohort_of(*table, {});
    return cohort ? std::string() : cohort.error().what;
  };
  EXPECT_EQ(refusal("p,1,a,maybe\n"), "t.csv:2: column 'correct' should be 0 or 1 and is 'maybe'");
  EXPECT_NE(refusal("p,1,a,1\np,1,b,1\n").find("'order' is 1 twice for 'p'"), std::string::npos);
  EXPECT_NE(refusal("p,x,a,1\n").find("should be a number"), std::string::npos);
}

TEST(Trainee, ThePageHoldsItsPicturesAndEscapesNames) {
  auto cohort = cohort_with("110110110110");
  cohort.trainees[0] = "<b>";
  const auto page =
      trainee_page(trainee_report(cohort, 0, certification(kRates), {kRates, {}, 1.25}), true);
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_NE(page.find("simulated"), std::string::npos);
  EXPECT_EQ(page.find("<b>"), std::string::npos);
  EXPECT_NE(page.find("@media print"), std::string::npos);
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
