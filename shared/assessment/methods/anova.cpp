/// One-way analysis of variance, as published, with what does not need its assumptions beside it.
#include "statistics/anova/anova.hpp"

#include <fmt/format.h>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

Json group_table(const statistics::Groups& groups, const statistics::OneWay& fit) {
  Json out = Json::array();
  for (std::size_t j = 0; j < groups.names.size(); ++j)
    out.push_back({{"group", groups.names[j]},
                   {"n", groups.values[j].size()},
                   {"mean", fit.means[j]},
                   {"sd", fit.deviations[j]}});
  return out;
}

/// Residuals and fitted values, in the order of the groups.
std::pair<statistics::Vector, statistics::Vector> residuals_of(const statistics::Groups& groups,
                                                               const statistics::OneWay& fit) {
  Eigen::Index n = 0;
  for (const auto& values : groups.values) n += values.size();
  statistics::Vector fitted(n), residuals(n);
  Eigen::Index at = 0;
  for (std::size_t j = 0; j < groups.values.size(); ++j) {
    const auto size = groups.values[j].size();
    fitted.segment(at, size).setConstant(fit.means[j]);
    residuals.segment(at, size) = groups.values[j].array() - fit.means[j];
    at += size;
  }
  return {fitted, residuals};
}

void add_companions(const statistics::Groups& groups, Json& out) {
  const auto add = [&](const char* name, const core::Result<statistics::SpreadTest>& test) {
    if (test)
      out[name] = {{"F", test->statistic}, {"df1", test->df1}, {"df2", test->df2}, {"p", test->p}};
    else
      out["notes"].push_back(fmt::format("no {}: {}", name, test.error().what));
  };
  add("welch_unequal_variances", statistics::welch(groups));
  const auto spread = statistics::brown_forsythe(groups);
  add("brown_forsythe_equal_spread", spread);
  if (spread)
    out["checks"].push_back(check_row(
        "groups spread equally", fmt::format("Brown-Forsythe F = {:.4g}", spread->statistic),
        spread->p, spread->p < 0.05 ? "read Welch's F" : "nothing against it"));
  if (groups.names.size() > 20) return;
  const auto pairs = statistics::tukey(groups);
  if (!pairs) return;
  out["tukey_pairs"] = Json::array();
  for (const auto& pair : *pairs)
    out["tukey_pairs"].push_back({{"pair", pair.pair},
                                  {"difference", pair.difference},
                                  {"ci95_low", pair.low},
                                  {"ci95_high", pair.high},
                                  {"p", pair.p}});
}

core::Result<Findings> run_anova(const Analysis& of) {
  if (!of.formula.group.empty())
    return core::bad_input("(1|" + of.formula.group +
                           ") needs 'rm-anova' or 'lmm': anova knows no subjects");
  const auto column = TRY(single_column(of, "anova"));
  const auto y = TRY(of.table.numbers(of.formula.response));
  const auto groups = groups_in_order(of.table, column, y);
  const auto fit = statistics::one_way(groups);
  if (!fit) return located(of, fit.error());
  const auto [fitted, residuals] = residuals_of(groups, *fit);
  Json out = report_head(of, "one-way analysis of variance");
  out["groups"] = group_table(groups, *fit);
  out["analysis"] = {{"F", fit->f},
                     {"df_between", fit->df_between},
                     {"df_within", fit->df_within},
                     {"p", fit->p},
                     {"ss_between", fit->ss_between},
                     {"ss_within", fit->ss_within},
                     {"residual_sd", fit->residual_sd},
                     {"eta_squared", fit->eta_squared},
                     {"omega_squared", fit->omega_squared},
                     {"cohen_f", fit->cohen_f}};
  const double none = std::nan("");
  out["tests"] = Json::array({Test{column, "F", fit->f, fit->df_between, fit->df_within, fit->p,
                                   "omega squared", fit->omega_squared, none, none}
                                  .to_json()});
  out["checks"] = Json::array({normality_check(residuals)});
  out["notes"] = {
      "rows are taken as independent; repeated trials of one person need rm-anova or lmm"};
  add_companions(groups, out);
  return Findings{
      std::move(out),
      {group_picture(column, groups, of.formula.response), residual_picture(fitted, residuals)}};
}

}  // namespace

namespace methods {
Method anova_method() {
  return {"anova",
          "One-way analysis of variance of independent rows",
          "breach_velocity_m_s ~ repetition",
          "one-way analysis of variance, with Welch's form for unequal variances and "
          "Tukey-Kramer intervals of all pairs",
          {},
          run_anova};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
