/// Formulas and conditions on rows.
#include "assessment/formula.hpp"

#include <gtest/gtest.h>

#include "assessment/filter.hpp"

namespace tractus {
namespace assessment {
namespace {

Table table_of(const std::string& text) {
  const auto bytes = core::bytes_of(text);
  auto out = Table::parse({bytes.begin(), bytes.end()}, "t.csv", {}, Missing::keep);
  EXPECT_TRUE(out) << out.error().what;
  return std::move(*out);
}

const char* kCells =
    "y,a,b,x\n1,p,u,1\n2,p,v,2\n3,q,u,3\n4,q,v,4\n5,r,u,5\n6,r,v,6\n7,p,u,7\n8,q,v,8\n";

std::vector<std::string> names(const std::string& formula) {
  const auto parsed = parse_formula(formula);
  EXPECT_TRUE(parsed) << parsed.error().what;
  const auto model = model_matrix(*parsed, table_of(kCells));
  EXPECT_TRUE(model) << model.error().what;
  return model->design.names;
}

using Names = std::vector<std::string>;

TEST(Formula, CodesTermsAsTheRuleOfMarginalityAsks) {
  // By hand, after the rule: contrasts where the margin is in the model, every level where not.
  EXPECT_EQ(names("y ~ a*b"),
            (Names{"(Intercept)", "a[q]", "a[r]", "b[v]", "a[q]:b[v]", "a[r]:b[v]"}));
  EXPECT_EQ(names("y ~ a:b"), (Names{"(Intercept)", "a[p]:b[u]", "a[q]:b[u]", "a[r]:b[u]",
                                     "a[p]:b[v]", "a[q]:b[v]", "a[r]:b[v]"}));
  EXPECT_EQ(names("y ~ a + a:x"),
            (Names{"(Intercept)", "a[q]", "a[r]", "a[p]:x", "a[q]:x", "a[r]:x"}));
  EXPECT_EQ(names("y ~ 0 + a"), (Names{"a[p]", "a[q]", "a[r]"}));
  EXPECT_EQ(names("y ~ 0 + x + a"), (Names{"x", "a[p]", "a[q]", "a[r]"}));
}

TEST(Formula, MultipliesPowersAndLogarithms) {
  const auto parsed = parse_formula("y ~ I(x^3) + log(x) + x:b");
  ASSERT_TRUE(parsed);
  const auto model = model_matrix(*parsed, table_of(kCells));
  ASSERT_TRUE(model) << model.error().what;
  const auto& row = model->design.columns.row(1);  // x = 2, b = v
  EXPECT_EQ(row[1], 8.0);
  EXPECT_NEAR(row[2], 0.6931471805599453, 1e-15);  // ln 2
  EXPECT_EQ(row[3], 0.0);                          // x:b[u]
  EXPECT_EQ(row[4], 2.0);
}

TEST(Formula, NamesThePlaceOfWhatItCannotRead) {
  const auto refusal = [](const std::string& text) {
    const auto parsed = parse_formula(text);
    return parsed ? "" : parsed.error().what;
  };
  EXPECT_NE(refusal("y ~ sin(x)").find("'sin(' is unknown"), std::string::npos);
  EXPECT_NE(refusal("y ~ I(x^1)").find("takes n from 2 to 9"), std::string::npos);
  EXPECT_NE(refusal("y ~ x*x").find("multiplies itself"), std::string::npos);
  EXPECT_NE(refusal("y ~ x + x").find("twice"), std::string::npos);
  EXPECT_NE(refusal("y ~ x x").find("at character 7"), std::string::npos);
  std::string product = "y ~ x0";
  for (int i = 1; i < 60; ++i) product += "*x" + std::to_string(i);  // 2^60 terms
  EXPECT_NE(refusal(product).find("more than 200 terms"), std::string::npos);
  EXPECT_NE(refusal("y ~ y").find("both sides"), std::string::npos);
  const auto parsed = parse_formula("y ~ log(x)");
  const auto model = model_matrix(*parsed, table_of("y,x\n1,1\n2,0\n"));
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().what, "t.csv:3: column 'x' is 0 and has no logarithm");
}

TEST(Formula, ReadsRandomTermsAsLme4WritesThem) {
  const auto read = [](const std::string& text) {
    const auto parsed = parse_formula(text);
    EXPECT_TRUE(parsed) << parsed.error().what;
    return parsed ? *parsed : Formula{};
  };
  const auto one = read("y ~ x + (1|a)");
  EXPECT_EQ(one.group, "a");
  EXPECT_TRUE(one.random.empty());
  const auto crossed = read("y ~ x + (1 + x | a) + (1 | b)");
  EXPECT_EQ(crossed.group, "");
  EXPECT_EQ(crossed.random, (std::vector<RandomEffects>{{true, {"x"}, {"a"}}, {true, {}, {"b"}}}));
  EXPECT_EQ(crossed.columns(), (Names{"y", "x", "a", "b"}));
  // a/b stands for a and a:b (Bates et al. 2015, table 2); a slope brings its intercept unless 0.
  EXPECT_EQ(read("y ~ x + (x | a/b)").random,
            (std::vector<RandomEffects>{{true, {"x"}, {"a"}}, {true, {"x"}, {"a", "b"}}}));
  EXPECT_EQ(read("y ~ x + (0 + x | a)").random,
            (std::vector<RandomEffects>{{false, {"x"}, {"a"}}}));
  EXPECT_EQ(read("y ~ x + (1 | a:b)").random[0].group(), "a:b");
  for (const auto& [text, why] :
       {std::pair("y ~ x + (0 | a)", "holds no random effect"),
        std::pair("y ~ x + (1 | a) + (1 | a)", "the random term of a stands there twice"),
        std::pair("y ~ x + (1 | a:a)", "'a' stands there twice"),
        std::pair("y ~ x + (1 + x a)", "'|' is expected")}) {
    const auto parsed = parse_formula(text);
    ASSERT_FALSE(parsed) << text;
    EXPECT_NE(parsed.error().what.find(why), std::string::npos) << parsed.error().what;
  }
}

std::vector<bool> rows(const std::string& condition, const std::string& text) {
  const auto filter = Filter::parse(condition);
  EXPECT_TRUE(filter) << filter.error().what;
  const auto out = filter->rows_of(table_of(text));
  EXPECT_TRUE(out) << out.error().what;
  return *out;
}

TEST(Filter, ComparesNumbersWordsAndEmptyCells) {
  const std::string text = "t,s\n1,a\n,b\n3.0,a\n";
  using Rows = std::vector<bool>;
  EXPECT_EQ(rows("t > 1", text), (Rows{false, false, true}));
  EXPECT_EQ(rows("t = 3", text), (Rows{false, false, true}));  // as numbers: 3.0 is 3
  EXPECT_EQ(rows("t != 3", text), (Rows{true, false, false}));
  EXPECT_EQ(rows("t = missing", text), (Rows{false, true, false}));
  EXPECT_EQ(rows("s = a and t <= 1", text), (Rows{true, false, false}));
}

TEST(Filter, RefusesWhatIsNoCondition) {
  EXPECT_FALSE(Filter::parse("t"));
  EXPECT_FALSE(Filter::parse("t > much"));
  EXPECT_FALSE(Filter::parse("t === 1"));
  const auto filter = Filter::parse("s > 1");
  const auto out = filter->rows_of(table_of("s\na\n"));
  ASSERT_FALSE(out);
  EXPECT_EQ(out.error().what, "t.csv:2: column 's' should be a number and is 'a'");
  EXPECT_FALSE(Filter::parse("z = 1")->rows_of(table_of("s\na\n")));
}

}  // namespace
}  // namespace assessment
}  // namespace tractus
