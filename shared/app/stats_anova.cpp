/// The analyses of variance of `tractus stats`.
#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "app/stats_report.hpp"
#include "statistics/anova.hpp"
#include "statistics/p_adjust.hpp"
#include "statistics/rm_anova.hpp"

namespace commands {
namespace {

using core::Json;
using statistics::Matrix;
using statistics::Vector;

core::Error wrong(std::string what) { return {core::Errc::bad_input, std::move(what)}; }

core::Error located(const Analysis& of, const core::Error& error) {
  return {error.code, of.table.name() + ": " + error.what};
}

/// The one column that both kinds compare.
core::Result<std::string> factor_of(const Analysis& of, const char* method) {
  if (of.formula.terms.size() != 1 || !of.formula.trials.empty() || of.formula.trials_number != 1 ||
      !of.formula.intercept)
    return wrong(fmt::format("{} compares the levels of one column: write y ~ column", method));
  return of.formula.terms[0].column;
}

statistics::Groups groups_in_order(const Table& table, const std::string& column, const Vector& y) {
  const auto& cells = table.texts(column);
  auto found = statistics::grouped({cells.begin(), cells.end()}, y);
  statistics::Groups out;
  for (const auto& level : levels_of(table, column)) {
    const auto at = std::ranges::find(found.names, level) - found.names.begin();
    out.names.push_back(level);
    out.values.push_back(std::move(found.values[static_cast<std::size_t>(at)]));
  }
  return out;
}

Json group_table(const statistics::Groups& groups, const statistics::OneWay& fit) {
  Json out = Json::array();
  for (std::size_t j = 0; j < groups.names.size(); ++j)
    out.push_back({{"group", groups.names[j]},
                   {"n", groups.values[j].size()},
                   {"mean", fit.means[j]},
                   {"sd", fit.deviations[j]}});
  return out;
}

void add_companions(const statistics::Groups& groups, Json& out) {
  const auto add = [&](const char* name, const core::Result<statistics::SpreadTest>& test) {
    if (test)
      out[name] = {{"F", test->statistic}, {"df1", test->df1}, {"df2", test->df2}, {"p", test->p}};
    else
      out["notes"].push_back(fmt::format("no {}: {}", name, test.error().what));
  };
  add("welch_unequal_variances", statistics::welch(groups));
  add("brown_forsythe_equal_spread", statistics::brown_forsythe(groups));
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

/// Subjects by levels, every cell exactly once.
struct Cells {
  std::vector<std::string> subjects, levels;
  Matrix values;
};

core::Result<Cells> cells_of(const Analysis& of, const std::string& within, const Vector& y) {
  Cells out{levels_of(of.table, of.formula.group), levels_of(of.table, within), {}};
  if (out.subjects.size() * out.levels.size() > 2 * of.table.rows())
    return wrong(fmt::format("{}: {} subjects × {} levels, but {} rows: most cells are empty",
                             of.table.name(), out.subjects.size(), out.levels.size(),
                             of.table.rows()));
  std::map<std::string_view, Eigen::Index> row, column;
  for (const auto& name : out.subjects) row.emplace(name, std::ssize(row));
  for (const auto& name : out.levels) column.emplace(name, std::ssize(column));
  out.values = Matrix::Constant(std::ssize(out.subjects), std::ssize(out.levels), std::nan(""));
  const auto& who = of.table.texts(of.formula.group);
  const auto& what = of.table.texts(within);
  for (std::size_t i = 0; i < who.size(); ++i) {
    double& cell = out.values(row.at(who[i]), column.at(what[i]));
    if (!std::isnan(cell))
      return wrong(
          fmt::format("{}: {} '{}' has more than one row for {} '{}': average them first, "
                      "or use lmm",
                      of.table.name(), of.formula.group, who[i], within, what[i]));
    cell = y[static_cast<Eigen::Index>(i)];
  }
  for (Eigen::Index i = 0; i < out.values.rows(); ++i)
    for (Eigen::Index j = 0; j < out.values.cols(); ++j)
      if (std::isnan(out.values(i, j)))
        return wrong(fmt::format("{}: {} '{}' has no row for {} '{}' (lmm takes such data)",
                                 of.table.name(), of.formula.group,
                                 out.subjects[static_cast<std::size_t>(i)], within,
                                 out.levels[static_cast<std::size_t>(j)]));
  return out;
}

/// Paired t tests of all pairs of levels with Holm's adjustment.
Json pair_table(const Cells& cells) {
  Json out = Json::array();
  std::vector<double> p;
  for (Eigen::Index a = 0; a < cells.values.cols(); ++a)
    for (Eigen::Index b = a + 1; b < cells.values.cols(); ++b) {
      Vector weights = Vector::Zero(cells.values.cols());
      weights[b] = 1.0;
      weights[a] = -1.0;
      const auto c = statistics::contrast(cells.values, weights);
      p.push_back(std::isnan(c.p) ? 1.0 : c.p);
      out.push_back({{"pair", cells.levels[static_cast<std::size_t>(b)] + "-" +
                                  cells.levels[static_cast<std::size_t>(a)]},
                     {"difference", c.estimate},
                     {"ci95_low", c.ci_low},
                     {"ci95_high", c.ci_high},
                     {"t", c.t},
                     {"p", c.p}});
    }
  const auto holm = statistics::adjusted(p, statistics::Adjustment::holm);
  for (std::size_t i = 0; i < out.size(); ++i) out[i]["p_holm"] = holm[i];
  return out;
}

}  // namespace

core::Result<Json> anova_report(const Analysis& of) {
  if (!of.formula.group.empty())
    return wrong("(1|" + of.formula.group + ") needs 'rm-anova' or 'lmm': anova knows no subjects");
  const auto column = factor_of(of, "anova");
  if (!column) return column.error();
  const auto y = of.table.numbers(of.formula.response);
  if (!y) return y.error();
  const auto groups = groups_in_order(of.table, *column, *y);
  const auto fit = statistics::one_way(groups);
  if (!fit) return located(of, fit.error());
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
  out["notes"] = {
      "rows are taken as independent; repeated trials of one person need rm-anova or lmm"};
  add_companions(groups, out);
  return out;
}

core::Result<Json> rm_anova_report(const Analysis& of) {
  if (of.formula.group.empty())
    return wrong("rm-anova needs the subject: add (1|COLUMN) to the formula");
  const auto column = factor_of(of, "rm-anova");
  if (!column) return column.error();
  if (*column == of.formula.group) return wrong("the subject cannot be the levels as well");
  const auto y = of.table.numbers(of.formula.response);
  if (!y) return y.error();
  const auto cells = cells_of(of, *column, *y);
  if (!cells) return cells.error();
  const auto fit = statistics::rm_anova(cells->values);
  if (!fit) return located(of, fit.error());
  const auto trend = statistics::linear_trend(cells->values);
  Json out = report_head(of, "repeated-measures analysis of variance");
  out["levels"] = coefficient_table(cells->levels, {{"mean", &fit->level_means}});
  out["analysis"] = {{"subjects", cells->subjects.size()},
                     {"F", fit->f},
                     {"df1", fit->df1},
                     {"df2", fit->df2},
                     {"p_greenhouse_geisser", fit->p_gg},
                     {"epsilon_greenhouse_geisser", fit->epsilon_gg},
                     {"p_huynh_feldt", fit->p_hf},
                     {"epsilon_huynh_feldt", fit->epsilon_hf},
                     {"p_if_spherical", fit->p},
                     {"p_lower_bound", fit->p_lower},
                     {"mauchly_W", fit->mauchly.w},
                     {"mauchly_p", fit->mauchly.p},
                     {"ss_effect", fit->ss_effect},
                     {"ss_subjects", fit->ss_subjects},
                     {"ss_error", fit->ss_error},
                     {"partial_eta_squared", fit->partial_eta_squared},
                     {"generalized_eta_squared", fit->generalized_eta_squared}};
  out["pairs"] = pair_table(*cells);
  out["linear_trend"] = {
      {"estimate", trend.estimate}, {"t", trend.t}, {"df", trend.df}, {"p", trend.p}};
  return out;
}

}  // namespace commands
