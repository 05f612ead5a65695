/// Rubrics, and how far raters agree.
#include <gtest/gtest.h>

#include "assessment/rating_agreement.hpp"
#include "assessment/rubric.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Matrix;

/// Six subjects rated by four judges [Shrout1979, Table 2].
Matrix four_judges() {
  Matrix out(6, 4);
  out << 9, 2, 5, 8, 6, 1, 3, 2, 8, 4, 6, 8, 7, 1, 2, 6, 10, 5, 6, 9, 6, 2, 4, 7;
  return out;
}

Json rubric_json() {
  return {
      {"format", "tractus-rubric/1"},
      {"title", "Global rating"},
      {"items",
       {{{"label", "Respect for tissue"},
         {"low_text", "careless"},
         {"middle_text", "careful, at times too much force"},
         {"high_text", "careful throughout"}},
        {{"label", "Passed"}, {"low", 0}, {"high", 1}, {"low_text", "no"}, {"high_text", "yes"}}}}};
}

std::string rubric_refusal(const char* pointer, const Json& value) {
  Json json = rubric_json();
  json[Json::json_pointer(pointer)] = value;
  const auto read = Rubric::from_json(json, "body");
  return read ? "" : read.error().what;
}

// ICC(2,1) = 0.29 and ICC(2,4) = 0.62 [Shrout1979, Table 4]; the intervals as R's psych::ICC prints
// them of the same data (its `sf`): 0.019 to 0.76, 0.071 to 0.93.
TEST(RatingAgreement, OfTheFourJudgesIsThePublished) {
  const RatingAgreement got = rating_agreement(four_judges(), {});
  ASSERT_TRUE(got.single && got.mean) << got.note;
  EXPECT_NEAR(*got.single, 0.29, 0.005);
  EXPECT_NEAR(*got.mean, 0.62, 0.005);
  EXPECT_NEAR(got.single_95.low, 0.019, 0.0005);
  EXPECT_NEAR(got.single_95.high, 0.76, 0.005);
  EXPECT_NEAR(got.mean_95.low, 0.071, 0.0005);
  EXPECT_NEAR(got.mean_95.high, 0.93, 0.005);
  EXPECT_FALSE(got.kappa) << "of two raters alone";
}

// Two raters, four trials, scores 1 to 3: (1,1) (2,3) (3,3) (1,2). Weights 1 − (d/2)²: the two
// that differ by one weigh 3/4, so observed = (1 + 3/4 + 1 + 3/4)/4 = 7/8. Shares of the first
// 1/2, 1/4, 1/4, of the second 1/4, 1/4, 1/2: expected = 1 − (1/4)(Σ p q d²) with
// Σ = 1/2·1/4·1 + 1/2·1/2·4 + 1/4·1/4·1 + 1/4·1/2·1 + 1/4·1/4·4 + 1/4·1/4·1 = 13/8: 1 − 13/32.
// kappa = (7/8 − 19/32)/(13/32) = 9/13.
TEST(RatingAgreement, OfAnItemHasCohensWeightedKappa) {
  Matrix scores(4, 2);
  scores << 1, 1, 2, 3, 3, 3, 1, 2;
  const RatingAgreement got = rating_agreement(scores, ScoreScale{1, 3});
  ASSERT_TRUE(got.kappa);
  EXPECT_NEAR(*got.kappa, 9.0 / 13.0, 1e-12);
}

TEST(RatingAgreement, SaysWhyThereIsNone) {
  Matrix one(1, 2), same(3, 2);
  one << 3, 4;
  same << 1, 1, 3, 3, 5, 5;
  EXPECT_NE(rating_agreement(one, ScoreScale{}).note.find("two trials"), std::string::npos);
  const RatingAgreement exact = rating_agreement(same, ScoreScale{});
  EXPECT_FALSE(exact.single);
  EXPECT_NE(exact.note.find("no error"), std::string::npos);
  EXPECT_EQ(exact.kappa, 1.0);
}

// Differences −1, 0, 1, 2: mean 0.5, SD √(5/3) = 1.29099; 1.959964 of them: 2.53030.
TEST(DifferenceLimits, AreTheMeanAndItsSpread) {
  Matrix totals(4, 2);
  totals << 10, 11, 12, 12, 14, 13, 9, 7;
  const auto got = difference_limits(totals);
  ASSERT_TRUE(got);
  EXPECT_NEAR(got->mean, 0.5, 1e-12);
  EXPECT_NEAR(got->low, 0.5 - 2.53030, 1e-5);
  EXPECT_NEAR(got->high, 0.5 + 2.53030, 1e-5);
  EXPECT_FALSE(difference_limits(four_judges()));
}

TEST(Rubric, IsReadAndWrittenAsItIs) {
  const auto read = Rubric::from_json(rubric_json(), "body");
  ASSERT_TRUE(read) << read.error().what;
  ASSERT_EQ(read->items.size(), 2u);
  EXPECT_EQ(read->items[0].high, 5);
  EXPECT_EQ(read->items[1].high, 1);
  const auto again = Rubric::from_json(read->to_json(), "stored");
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->to_json(), read->to_json());
}

TEST(Rubric, TakesOneScoreForEachItemOnItsScale) {
  const auto read = Rubric::from_json(rubric_json(), "body");
  ASSERT_TRUE(read);
  const auto refused = [&](const std::vector<int>& scores) {
    const auto checked = read->check(scores, "body: /scores");
    return checked ? "" : checked.error().what;
  };
  EXPECT_EQ(refused({1, 0}), "");
  EXPECT_EQ(refused({5, 1}), "");
  EXPECT_EQ(refused({5}), "body: /scores: 2 scores, one for each item, are expected, not 1");
  EXPECT_EQ(refused({6, 1}),
            "body: /scores/0: 6 is outside 1 to 5, the scale of 'Respect for tissue'");
}

TEST(Rubric, RefusesWhatIsNone) {
  EXPECT_NE(rubric_refusal("/format", "x"), "");
  EXPECT_NE(rubric_refusal("/title", "  "), "");
  EXPECT_NE(rubric_refusal("/items", Json::array()), "");
  EXPECT_NE(rubric_refusal("/items/0/label", "").find("/items/0"), std::string::npos);
  EXPECT_NE(rubric_refusal("/items/0/high_text", " "), "");
  EXPECT_NE(rubric_refusal("/items/0/high", 1), "");
  EXPECT_NE(rubric_refusal("/items/0/weight", 2), "") << "an unknown field";
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
