/// What passing is.
#include "assessment/criteria.hpp"

#include <gtest/gtest.h>

#include "assessment/curriculum.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

/// '1' right, '0' wrong, '-' without an answer.
std::vector<JudgedTrial> answered(const std::string& answers) {
  std::vector<JudgedTrial> out;
  for (const char c : answers) {
    JudgedTrial trial{.id = std::to_string(out.size() + 1)};
    if (c != '-') trial.right = c == '1';
    out.push_back(trial);
  }
  return out;
}
std::vector<JudgedTrial> timed(std::initializer_list<double> times_s) {
  std::vector<JudgedTrial> out;
  for (const double t : times_s)
    out.push_back({.id = std::to_string(out.size() + 1), .metrics = {{"operation_time", t}}});
  return out;
}
Criteria criteria_of(const Json& requirement) {
  const auto out = Criteria::from_json(
      {{"format", "tractus-criteria/1"}, {"requirements", {requirement}}}, "body");
  EXPECT_TRUE(out) << out.error().what;
  return out ? *out : Criteria{};
}
std::string refusal(const Json& requirement) {
  const auto out = Criteria::from_json(
      {{"format", "tractus-criteria/1"}, {"requirements", {requirement}}}, "body");
  return out ? "" : out.error().what;
}

const Json kFast{{"kind", "metric"},  {"metric", "operation_time"},
                 {"side", "at_most"}, {"bound", 45.0},
                 {"times", 3},        {"last", 5}};

TEST(Criteria, ABoundIsKeptByNOfTheLastM) {
  const Criteria fast = criteria_of(kFast);
  // Kept by the 1st, 3rd and 6th value: of trials 2 to 6 by two, of 3 to 7 by three.
  const auto slow = judge(fast, timed({44, 60, 45, 60, 60, 40}));
  EXPECT_FALSE(slow.passed());
  EXPECT_EQ(slow.now[0].found, "2 of 5");
  EXPECT_EQ(slow.now[0].required, "Operation time at most 45 s in 3 of the last 5 trials");
  const auto passed = judge(fast, timed({44, 60, 45, 60, 60, 40, 30, 99, 99, 99, 99}));
  EXPECT_EQ(passed.passed_at, 7u);
  EXPECT_EQ(passed.then[0].found, "3 of 5");
  EXPECT_FALSE(passed.holds_now()) << "passed, and slower since";
  EXPECT_FALSE(judge(fast, {}).passed());
}

TEST(Criteria, ATrialWithoutTheMetricIsNoValue) {
  auto trials = timed({40, 40});
  trials.insert(trials.begin() + 1, JudgedTrial{.id = "no time"});
  Json two = kFast;
  two["times"] = two["last"] = 2;
  EXPECT_EQ(judge(criteria_of(two), trials).passed_at, 3u);
}

TEST(Criteria, RecognitionNeedsItsLowEnd) {
  // Wilson 1927 with z = 1.959964, as R's prop.test(x, n, correct = FALSE) prints: 18 of 20 has the
  // 95 % interval 0.699 to 0.972, 20 of 20 has 0.839 to 1.
  const Criteria seventy = criteria_of({{"kind", "recognition"}, {"share", 0.70}});
  const auto not_yet = judge(seventy, answered(std::string(18, '1') + "00"));
  EXPECT_EQ(not_yet.now[0].found, "18 of 20 right, low end 69.9 %");
  EXPECT_FALSE(not_yet.holds_now());
  // With none wrong the low end is n / (n + 3.8415): 9 / 12.8415 = 0.7009 is the first above 0.70.
  EXPECT_EQ(judge(seventy, answered(std::string(20, '1'))).passed_at, 9u);
  const Criteria window = criteria_of({{"kind", "recognition"}, {"share", 0.70}, {"last", 9}});
  EXPECT_EQ(judge(window, answered("0000" + std::string(9, '1'))).passed_at, 13u);
  EXPECT_EQ(judge(seventy, answered("---")).now[0].found, "no answer yet");
}

TEST(Criteria, LcCusumIsThatOfTheTraineesPage) {
  const Criteria usual = Criteria::usual();
  EXPECT_EQ(usual.requirements[0].rates.adequate, 0.10);
  EXPECT_EQ(usual.requirements[0].rates.inadequate, 0.25);
  const Certification& rule = usual_certification({0.10, 0.25});
  // A success adds ln(0.90/0.75) = 0.18232: h is reached after ceil(h / 0.18232) successes.
  const auto first = std::size_t(std::ceil(rule.threshold / 0.1823215568));
  const auto verdict = judge(usual, answered(std::string(60, '1')));
  EXPECT_EQ(verdict.passed_at, first);
  const auto lapsed = judge(usual, answered(std::string(60, '1') + "00"));
  EXPECT_TRUE(lapsed.passed());
  EXPECT_FALSE(lapsed.holds_now());
  // Laxer rates need fewer: a success then adds ln(0.80/0.40) = 0.6931.
  const Criteria lax =
      criteria_of({{"kind", "lc_cusum"}, {"adequate", 0.20}, {"inadequate", 0.60}});
  EXPECT_LT(judge(lax, answered(std::string(60, '1'))).passed_at, first);
}

TEST(Criteria, AllRequirementsAreMetAtOnce) {
  Criteria both = criteria_of(kFast);
  both.requirements[0].times = both.requirements[0].last = 1;
  both.requirements.push_back(
      criteria_of({{"kind", "recognition"}, {"share", 0.20}}).requirements[0]);
  // 1 of 1 right has the low end 1/4.8415 = 0.2065. Fast at first and wrong; then right and slow.
  auto trials = timed({40, 60, 60, 40});
  for (std::size_t i = 0; i < trials.size(); ++i) trials[i].right = i > 0;
  EXPECT_EQ(judge(both, trials).passed_at, 4u);
}

TEST(Criteria, ReadsWhatItWrites) {
  for (const Json& one :
       {kFast, Json{{"kind", "recognition"}, {"share", 0.8}, {"level", 0.9}, {"last", 20}},
        Json{{"kind", "lc_cusum"}, {"adequate", 0.05}, {"inadequate", 0.2}, {"basis", "ours"}}}) {
    const Criteria read = criteria_of(one);
    const auto again = Criteria::from_json(read.to_json(), "again");
    ASSERT_TRUE(again);
    EXPECT_EQ(again->to_json(), read.to_json());
  }
}

TEST(Criteria, RefusesWhatCannotBeMeant) {
  const auto with = [](const char* key, const Json& value) {
    Json out = kFast;
    out[key] = value;
    return out;
  };
  EXPECT_NE(refusal(with("metric", "speed of thought")).find("no such metric"), std::string::npos);
  EXPECT_NE(refusal(with("side", "about")), "");
  EXPECT_NE(refusal(with("times", 6)).find("/last"), std::string::npos);
  EXPECT_NE(refusal(with("bound", "fast")), "");
  EXPECT_NE(refusal(with("bund", 1)), "");
  EXPECT_NE(refusal({{"kind", "lc_cusum"}, {"adequate", 0.3}, {"inadequate", 0.2}}), "");
  EXPECT_NE(refusal({{"kind", "recognition"}, {"share", 1.0}}), "");
  EXPECT_NE(refusal({{"kind", "opinion"}}), "");
  EXPECT_FALSE(Criteria::from_json(
      {{"format", "tractus-criteria/1"}, {"requirements", Json::array()}}, "body"));
  EXPECT_FALSE(Criteria::from_json({{"format", "x"}, {"requirements", {kFast}}}, "body"));
}

TEST(Criteria, AVersionHoldsForThoseWhoBeganWithIt) {
  const std::vector<std::int64_t> made{100, 200, 300};
  EXPECT_EQ(version_for(made, 50), 0u) << "trials before there was any";
  EXPECT_EQ(version_for(made, 100), 0u);
  EXPECT_EQ(version_for(made, 250), 1u);
  EXPECT_EQ(version_for(made, 999), 2u);
  EXPECT_EQ(version_for(made, {}), 2u) << "not begun";
}

const Json kTwoSteps = Json::parse(R"({"format": "tractus-curriculum/1", "steps": [
  {"id": "a", "name": "Intact walls", "cases": ["c1", "c2"], "repeats": 3, "after": [],
   "criteria": {"format": "tractus-criteria/1", "requirements": [
     {"kind": "recognition", "share": 0.3}]}},
  {"id": "b", "name": "Breaches", "cases": ["c3"], "repeats": 2, "after": ["a"],
   "criteria": {"format": "tractus-criteria/1", "requirements": [
     {"kind": "recognition", "share": 0.2}]}}]})");

TEST(Curriculum, AStepOpensWhenWhatItNeedsIsPassed) {
  const auto of = Curriculum::from_json(kTwoSteps, "body");
  ASSERT_TRUE(of) << of.error().what;
  // Low ends with none wrong, n / (n + 3.8415): 1: 0.207, 2: 0.342.
  const auto trial = [](const char* of_case, bool right) {
    return StepTrial{{.id = "t", .right = right}, of_case};
  };
  std::vector<std::vector<StepTrial>> trials{{trial("c1", true)}, {}};
  auto where = progress(*of, trials);
  EXPECT_TRUE(where.steps[0].open);
  EXPECT_FALSE(where.steps[1].open);
  EXPECT_EQ(where.next_step, 0u);
  EXPECT_EQ(where.next_case, "c2") << "never done, so that it may fail most";
  trials[0].push_back(trial("c2", true));
  where = progress(*of, trials);
  EXPECT_EQ(where.steps[0].verdict.passed_at, 2u);
  EXPECT_TRUE(where.steps[1].open);
  EXPECT_EQ(where.next_case, "c3");
  EXPECT_FALSE(where.passed);
  trials[1].push_back(trial("c3", true));
  where = progress(*of, trials);
  EXPECT_TRUE(where.passed);
  EXPECT_FALSE(where.next_step);
}

TEST(Curriculum, RefusesStepsThatCannotBeReached) {
  const auto refused = [](const char* pointer, const Json& value) {
    Json changed = kTwoSteps;
    changed[Json::json_pointer(pointer)] = value;
    const auto out = Curriculum::from_json(changed, "body");
    return out ? "" : out.error().what;
  };
  EXPECT_NE(refused("/steps/0/after", {"b"}).find("earlier step"), std::string::npos);
  EXPECT_NE(refused("/steps/1/after", {"b"}).find("earlier step"), std::string::npos);
  EXPECT_NE(refused("/steps/1/id", "a").find("twice"), std::string::npos);
  EXPECT_NE(refused("/steps/1/cases", Json::array()), "");
  EXPECT_NE(refused("/steps/0/cases", {"c1", "c1"}), "");
  EXPECT_NE(refused("/steps/0/repeats", 0), "");
  EXPECT_NE(refused("/steps", Json::array()), "");
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
