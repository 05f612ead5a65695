/// Hotelling's T² against the reference's 50-digit values, and of two groups against R 4.2.2:
/// summary(manova(…), test = "Hotelling-Lawley").
#include "statistics/anova/hotelling.hpp"

#include "statistics/golden_test.hpp"
#include "statistics/summary/effect_size.hpp"

namespace tractus {
namespace statistics {
namespace {

TEST(Hotelling, OfTwoGroupsAgreesWithR) {
  // cbind(wrong_breach, wrong_total) ~ (experience_years >= 1) of the paper's Tables 2 and 4.
  const golden::Csv csv("data/paper_table2_table4.csv");
  Matrix y(10, 2);
  y << csv.numbers("wrong_breach"), csv.numbers("wrong_total");
  const auto got = hotelling(y.topRows(4), y.bottomRows(6), {"wrong_breach", "wrong_total"});
  ASSERT_TRUE(got) << got.error().what;
  EXPECT_NEAR(got->t_squared, 8.0 * 0.023043649233189169, 1e-14);
  EXPECT_NEAR(got->f, 0.080652772316162094, 1e-13);
  EXPECT_EQ(got->df1, 2.0);
  EXPECT_EQ(got->df2, 7.0);
  EXPECT_NEAR(got->p, 0.92335866044538917, 1e-13);
}

TEST(Hotelling, OfRepeatedMeasuresAgreesWithTheReference) {
  const auto reference = golden::expected("rm_anova");
  int compared = 0;
  for (const auto& [name, one] : reference["cases"].items()) {
    if (!one.contains("hotelling")) continue;
    const auto& want = one["hotelling"];
    const Matrix y = golden::Csv(one["data"]).numeric_from(1);
    const Eigen::Index k = y.cols();
    const auto got = hotelling(y.rightCols(k - 1) - y.leftCols(k - 1),
                               std::vector<std::string>(static_cast<std::size_t>(k - 1), "step"));
    ASSERT_TRUE(got) << name << ": " << got.error().what;
    ++compared;
    golden::expect_near(got->t_squared, want["T2"], 1e-10, name);
    golden::expect_near(got->f, want["F"], 1e-10, name);
    golden::expect_near(got->p, want["p_value"], 1e-10, name);
    EXPECT_EQ(got->df2, want["df2"].get<double>()) << name;
  }
  EXPECT_EQ(compared, 5);
}

TEST(Hotelling, OfOneResponseIsTheSquareOfT) {
  const Vector x = Eigen::Vector4d(1, 2, 4, 9), y = Eigen::Vector4d(3, 5, 8, 8);
  const auto got = hotelling(Matrix(x), Matrix(y), {"y"});
  const auto t = two_samples(x, y);
  ASSERT_TRUE(got && t);
  EXPECT_NEAR(got->t_squared, t->t * t->t, 1e-12);
  EXPECT_NEAR(got->p, t->p, 1e-12);
  EXPECT_NEAR(got->mahalanobis, std::abs(t->d), 1e-12);
}

TEST(Hotelling, DoesNotDependOnTheUnitsNorOnALinearMix) {
  const golden::Csv csv("data/sim_rm_lateral_breach_velocity_mm_s.csv");
  const Matrix y = csv.numeric_from(1);
  Matrix mixed(y.rows(), 2);
  mixed << 1e-9 * (y.col(2) - y.col(0)), 1e6 * (y.col(1) - y.col(2));
  const auto got = hotelling(mixed, {"a", "b"});
  ASSERT_TRUE(got) << got.error().what;
  EXPECT_NEAR(got->t_squared, 10.197671659853086, 1e-10);
}

TEST(Hotelling, NamesResponsesThatDetermineOneAnother) {
  Matrix y(6, 3);
  y << 1, 2, 3, 2, 1, 3, 4, 4, 8, 5, 3, 8, 6, 7, 13, 1, 5, 6;  // the third is the sum
  const auto got = hotelling(y, {"a", "b", "c"});
  ASSERT_FALSE(got);
  EXPECT_NE(got.error().what.find("linear combination"), std::string::npos);
  EXPECT_FALSE(hotelling(Matrix::Ones(6, 2), {"a", "b"}));
  EXPECT_FALSE(hotelling(y.topRows(3), {"a", "b", "c"}));
  EXPECT_FALSE(hotelling(y.topRows(1), y.bottomRows(5), {"a", "b", "c"}));
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
