#include "assessment/terms.hpp"

#include <algorithm>
#include <cmath>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace assessment {
namespace {

Test single(const Fitted& fit, const std::string& name, Eigen::Index j) {
  const double estimate = fit.coefficients[j], se = std::sqrt(fit.covariance(j, j));
  Test out{name, fit.statistic, estimate / se};
  out.df2 = fit.df[j];
  const double reach = out.df2 > 0.0 ? statistics::student_t_quantile(0.975, out.df2)
                                     : statistics::normal_quantile(0.975);
  out.p = out.df2 > 0.0 ? statistics::student_t_two_sided(out.value, out.df2)
                        : 2.0 * statistics::normal_upper(std::abs(out.value));
  out.effect = "coefficient";
  out.size = estimate;
  out.low = estimate - reach * se;
  out.high = estimate + reach * se;
  return out;
}

Test joint(const Fitted& fit, const std::string& name, const std::vector<Eigen::Index>& columns) {
  double df = fit.df[columns[0]];
  for (const auto j : columns) df = std::min(df, fit.df[j]);
  const auto test = fit.joint
                        ? fit.joint(columns)
                        : statistics::joint_test(fit.coefficients, fit.covariance, columns, df);
  return {name, df > 0.0 ? "F" : "chi2", test.statistic, test.df1, test.df2, test.p, "", 0, 0, 0};
}

bool contained(const Formula& formula, std::size_t t) {
  for (std::size_t other = 0; other < formula.terms.size(); ++other)
    if (other != t && formula.terms[other].contains(formula.terms[t])) return true;
  return false;
}

}  // namespace

void add_term_tests(const Formula& formula, const ModelMatrix& model, const Fitted& fit,
                    core::Json& out) {
  core::Json tests = core::Json::array(), table = core::Json::array();
  bool several = false;
  for (std::size_t t = 0; t < formula.terms.size(); ++t) {
    if (contained(formula, t)) continue;
    std::vector<Eigen::Index> columns;
    for (std::size_t j = 0; j < model.term_of.size(); ++j)
      if (model.term_of[j] == static_cast<int>(t)) columns.push_back(static_cast<Eigen::Index>(j));
    several = several || columns.size() > 1;
    const std::string name = formula.terms[t].name();
    const Test test =
        columns.size() == 1 ? single(fit, name, columns[0]) : joint(fit, name, columns);
    tests.push_back(test.to_json());
    table.push_back({{"term", name},
                     {"statistic", test.statistic},
                     {"value", test.value},
                     {"df1", columns.size()},
                     {"df2", test.df2},
                     {"p", test.p}});
  }
  if (tests.empty() && formula.intercept) tests.push_back(single(fit, "(Intercept)", 0).to_json());
  if (several) out["terms"] = table;
  out["tests"] = tests;
}

}  // namespace assessment
}  // namespace tractus
