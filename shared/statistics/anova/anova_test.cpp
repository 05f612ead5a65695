/// One-way ANOVA and its companions against R and exact rational values.
#include "statistics/anova/anova.hpp"

#include "statistics/golden_test.hpp"

namespace tractus {
namespace statistics {
namespace {

using golden::expect_near;

struct Case {
  const char* name;
  const char* file;
  const char* label;
  const char* value;
};

const std::vector<Case> kCases = {{"paper_style_lateral", "data/sim_lateral_breach_velocity.csv",
                                   "repetition", "breach_velocity_mm_s"},
                                  {"PlantGrowth", "data/PlantGrowth.csv", "group", "weight"},
                                  {"unbalanced", "data/sim_unbalanced_oneway.csv", "g", "y"}};

Groups groups_of(const Case& c) {
  const golden::Csv csv(c.file);
  return grouped(csv.texts(c.label), csv.numbers(c.value));
}

TEST(OneWay, AgreesWithRToElevenDigits) {
  const auto reference = golden::expected("anova_oneway");
  for (const auto& c : kCases) {
    const auto& want = reference[c.name];
    const auto fit = one_way(groups_of(c));
    ASSERT_TRUE(fit) << fit.error().what;
    expect_near(fit->ss_between, want["ss_between"], 1e-11, c.name);
    expect_near(fit->ss_within, want["ss_within"], 1e-11, c.name);
    expect_near(fit->f, want["F"], 1e-11, c.name);
    expect_near(fit->p, want["p_value"], 1e-11, c.name);
    expect_near(fit->df_within, want["df_within"], 0.0, c.name);
    expect_near(fit->df_between, want["df_between"], 0.0, c.name);
    expect_near(fit->grand_mean, want["grand_mean"], 1e-11, c.name);
    expect_near(fit->ss_between / fit->df_between, want["ms_between"], 1e-11, c.name);
    expect_near(fit->ss_within / fit->df_within, want["ms_within"], 1e-11, c.name);
    expect_near(fit->residual_sd, want["residual_sd"], 1e-11, c.name);
    expect_near(fit->eta_squared, want["eta2"], 1e-11, c.name);
    expect_near(fit->omega_squared, want["omega2"], 1e-11, c.name);
    expect_near(fit->epsilon_squared, want["epsilon2"], 1e-11, c.name);
    expect_near(fit->cohen_f, want["cohen_f"], 1e-11, c.name);
    expect_near(Eigen::Map<const Vector>(fit->means.data(), Eigen::Index(fit->means.size())),
                want["group_mean"], 1e-11, c.name);
    expect_near(
        Eigen::Map<const Vector>(fit->deviations.data(), Eigen::Index(fit->deviations.size())),
        want["group_sd"], 1e-11, c.name);
  }
}

void expect_test(const core::Result<SpreadTest>& got, const core::Json& want,
                 const std::string& statistic, const std::string& what) {
  ASSERT_TRUE(got) << what;
  expect_near(got->statistic, want[statistic], 1e-11, what);
  expect_near(got->p, want["p_value"], 1e-11, what);
  if (want.contains("df2")) expect_near(got->df2, want["df2"], 1e-11, what);
}

TEST(OneWay, CompanionsAgreeWithR) {
  const auto reference = golden::expected("anova_oneway");
  for (const auto& c : kCases) {
    const auto& want = reference[c.name];
    const Groups groups = groups_of(c);
    expect_test(welch(groups), want["welch"], "F", std::string(c.name) + " welch");
    expect_test(levene(groups), want["levene_mean"], "F", std::string(c.name) + " levene");
    expect_test(brown_forsythe(groups), want["brown_forsythe"], "F", std::string(c.name) + " bf");
    expect_test(bartlett(groups), want["bartlett"], "K2", std::string(c.name) + " bartlett");
  }
}

TEST(OneWay, TukeyAgreesWithRWithinItsOwnAccuracy) {
  const auto reference = golden::expected("anova_oneway");
  for (const auto& c : kCases) {
    const auto& want = reference[c.name]["tukey"];
    const auto got = tukey(groups_of(c));
    ASSERT_TRUE(got);
    ASSERT_EQ(got->size(), want["pairs"].size());
    for (std::size_t i = 0; i < got->size(); ++i) {
      EXPECT_EQ((*got)[i].pair, want["pairs"][i].get<std::string>());
      EXPECT_NEAR((*got)[i].difference, want["diff"][i].get<double>(), 1e-11);
      // R's ptukey is good to about 1e-8.
      EXPECT_NEAR((*got)[i].low, want["lwr95"][i].get<double>(), 2e-7);
      EXPECT_NEAR((*got)[i].high, want["upr95"][i].get<double>(), 2e-7);
      EXPECT_NEAR((*got)[i].p, want["p_adj"][i].get<double>(), 2e-8);
    }
  }
}

TEST(OneWay, LosesNothingToTenEqualLeadingDigits) {
  const auto reference = golden::expected("anova_hard_smls_type");
  for (const auto& [name, want] : reference["cases"].items()) {
    const golden::Csv csv(want["data"].get<std::string>());
    const auto fit = one_way(grouped(csv.texts("treatment"), csv.numbers("response")));
    ASSERT_TRUE(fit) << name;
    const auto& exact = want["exact_on_parsed_doubles"];
    expect_near(fit->f, exact["F"], 1e-9, name);
    expect_near(fit->ss_between, exact["ss_between"], 1e-9, name);
    expect_near(fit->ss_within, exact["ss_within"], 1e-9, name);
  }
}

TEST(OneWay, NamesTheEmptyOrConstantGroup) {
  Groups groups{{"a", "b"}, {Vector::LinSpaced(3, 0.0, 2.0), Vector()}};
  EXPECT_EQ(one_way(groups).error().what, "group 'b' is empty");
  groups.values[1] = Vector::Constant(3, 1.0);
  EXPECT_TRUE(one_way(groups));
  EXPECT_EQ(welch(groups).error().what, "group 'b' has no spread");
  groups.values[0].setConstant(4.0);
  EXPECT_FALSE(one_way(groups));
  groups.names.pop_back();
  groups.values.pop_back();
  EXPECT_FALSE(one_way(groups));
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
