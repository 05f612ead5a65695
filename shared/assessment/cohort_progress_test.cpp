#include "assessment/cohort_progress.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace tractus {
namespace assessment {
namespace {

/// "1101": three correct answers of four.
Answers answers(const std::string& text) {
  Answers out;
  for (const char one : text) out.push_back(one == '1');
  return out;
}

TEST(CohortProgress, IsTheMeanOverTraineesWithItsInterval) {
  // Shares of trials 1 to 5: 0.4, 0.6, 0.8. R: t.test(c(.4, .6, .8)) gives the mean 0.6 and the 95 %
  // interval 0.1031724 to 1.0968276 (0.2 / sqrt(3) times qt(.975, 2) = 4.302653).
  const auto bins = progress_bins({answers("11000"), answers("1110011111"), answers("11110111")});
  ASSERT_EQ(bins.size(), 2u);
  EXPECT_EQ(bins[0].from, 1u);
  EXPECT_EQ(bins[0].to, 5u);
  EXPECT_EQ(bins[0].trainees, 3u);
  EXPECT_NEAR(bins[0].share, 0.6, 1e-12);
  EXPECT_NEAR(bins[0].low, 0.1031724, 1e-6);
  EXPECT_NEAR(bins[0].high, 1.0968276, 1e-6);
  EXPECT_EQ(bins[1].trainees, 1u);  // the third did three of the next five trials
  EXPECT_EQ(bins[1].share, 1.0);
  EXPECT_TRUE(std::isnan(bins[1].low));
}

TEST(CohortProgress, CallsBehindWhoIsRightLessOftenThanTheOthersAtTheSameTrials) {
  // Fisher 1935, the lady tasting tea, as R's fisher.test(matrix(c(3, 1, 1, 3), 2)): p = 0.4857.
  const auto tea = pace_of({answers("1000"), answers("1110")}, 0);
  EXPECT_NEAR(tea.p, 34.0 / 70.0, 1e-12);
  EXPECT_FALSE(tea.behind);
  // fisher.test(matrix(c(4, 6, 27, 3), 2)): the hypergeometric probabilities of the tables that are no
  // likelier than 4 of 10 beside 27 of 30, summed in Python, are 0.00331394.
  const std::string good = "1111111110";
  const std::vector<Answers> cohort{answers("1010100100"), answers(good + "0000000000"),
                                    answers(good), answers(good)};
  const auto slow = pace_of(cohort, 0);
  EXPECT_EQ(slow.trials, 10u);
  EXPECT_EQ(slow.right, 4u);
  EXPECT_NEAR(slow.others.value(), 0.9,
              1e-12);  // what the second did after trial 10 does not count
  EXPECT_NEAR(slow.p, 0.00331394, 1e-8);
  EXPECT_TRUE(slow.behind);
  EXPECT_FALSE(pace_of(cohort, 2).behind);
  // Far above the others is not behind: 10 of 10 against 4 of 10.
  EXPECT_FALSE(pace_of({answers("1111111111"), answers("1010100100")}, 0).behind);
}

TEST(CohortProgress, SaysNothingWhereNobodyElseDidAsManyTrials) {
  const std::string twelve = "000000000000";
  const auto alone = pace_of({answers(twelve), answers("11")}, 0);
  EXPECT_FALSE(alone.others.has_value());
  EXPECT_FALSE(alone.behind);
  EXPECT_FALSE(pace_of({answers(""), answers("1111")}, 0).behind);
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
