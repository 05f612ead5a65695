/// Two groups or two levels: the difference with its size.
#include "statistics/summary/effect_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"
#include "core/words.hpp"
#include "statistics/ranks/rank_tests.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

Json block(const statistics::MeanDifference& d) {
  return {{"difference", d.difference},
          {"ci95_low", d.difference_95.low},
          {"ci95_high", d.difference_95.high},
          {"t", d.t},
          {"df", d.df},
          {"p", d.p}};
}

void add_test(const std::string& term, const statistics::MeanDifference& d, const char* effect,
              Json& out) {
  out["tests"] = Json::array(
      {Test{term, "t", d.t, 0, d.df, d.p, effect, d.d, d.d_95.low, d.d_95.high}.to_json()});
}

core::Result<Findings> of_pairs(const Analysis& of, const std::string& column, const Vector& y) {
  const auto cells = TRY(cells_of(of, {column}, y));
  if (cells.names.size() != 2)
    return core::bad_input(
        fmt::format("{}: column '{}' has {} levels; a paired effect size is of two",
                    of.table.name(), column, cells.names.size()));
  const Vector difference = cells.values.col(1) - cells.values.col(0);
  const auto d = statistics::paired(cells.values.col(1), cells.values.col(0));
  if (!d) return located(of, d.error());
  Json out = report_head(of, "paired difference and its size");
  out["compared"] = cells.names[1] + " minus " + cells.names[0];
  out["difference"] = block(*d);
  out["effect"] = {{"d_z", d->d},
                   {"d_z_ci95_low", d->d_95.low},
                   {"d_z_ci95_high", d->d_95.high},
                   {"g_z", d->g},
                   {"d_average", d->d_other}};
  const auto signed_rank = statistics::wilcoxon_signed_rank(difference);
  if (signed_rank)
    out["wilcoxon_signed_rank"] = {{"V", signed_rank->statistic}, {"p_exact", signed_rank->p}};
  add_test(column, *d, "Cohen's d_z", out);
  out["checks"] = Json::array({normality_check(difference)});
  return Findings{std::move(out),
                  {profile_picture(cells.names, cells.values, of.formula.response)}};
}

/// The reference first, where one is given.
core::Result<statistics::Groups> two_of(const Analysis& of, const std::string& column,
                                        statistics::Groups groups) {
  if (groups.names.size() != 2)
    return core::bad_input(
        fmt::format("{}: column '{}' has {} values; an effect size is of two groups: choose them "
                    "with level and reference (anova gives those of more)",
                    of.table.name(), column, groups.names.size()));
  if (groups.names[1] == of.text("reference")) {
    std::swap(groups.names[0], groups.names[1]);
    std::swap(groups.values[0], groups.values[1]);
  }
  return groups;
}

Json means_table(const statistics::Groups& groups) {
  Json out = Json::array();
  for (std::size_t j = 0; j < groups.names.size(); ++j) {
    const Vector& values = groups.values[j];
    const double mean = values.mean(), n = static_cast<double>(values.size());
    out.push_back({{"group", groups.names[j]},
                   {"persons", values.size()},
                   {"mean", mean},
                   {"sd", std::sqrt((values.array() - mean).square().sum() / (n - 1.0))}});
  }
  return out;
}

/// Each person is in one of two groups and counts once, by the mean of their rows.
core::Result<Findings> of_persons(const Analysis& of, const std::string& column,
                                  const statistics::Groups& groups) {
  const Vector &compared = groups.values[1], &reference = groups.values[0];
  const auto d = statistics::two_samples(compared, reference);
  if (!d) return located(of, d.error());
  const auto w = statistics::welch_t(compared, reference);
  if (!w) return located(of, w.error());
  const double j = statistics::hedges_j(d->df);
  Json out = report_head(of, "difference of two groups of persons and its size");
  out["compared"] = groups.names[1] + " minus " + groups.names[0];
  out["groups"] = means_table(groups);
  out["difference"] = {{"difference", d->difference},
                       {"ci95_low", w->difference_95.low},
                       {"ci95_high", w->difference_95.high},
                       {"t", w->t},
                       {"df", w->df},
                       {"p", w->p}};
  out["effect"] = {{"hedges_g", d->g},
                   {"hedges_g_ci95_low", j * d->d_95.low},
                   {"hedges_g_ci95_high", j * d->d_95.high},
                   {"cohen_d", d->d}};
  if (const auto u = statistics::mann_whitney(compared, reference))
    out["mann_whitney"] = {{"W", u->w}, {"p_exact", u->p}, {"cliff_delta", u->cliff_delta}};
  out["tests"] = Json::array(
      {Test{column, "t", w->t, 0, w->df, w->p, "Hedges' g", d->g, j * d->d_95.low, j * d->d_95.high}
           .to_json()});
  Vector residuals(compared.size() + reference.size());
  residuals.head(compared.size()).array() = compared.array() - compared.mean();
  residuals.tail(reference.size()).array() = reference.array() - reference.mean();
  out["checks"] = Json::array({normality_check(residuals)});
  return Findings{
      std::move(out),
      {group_picture(column, groups, of.formula.response + ", mean of each " + of.formula.group)}};
}

core::Result<Findings> of_groups(const Analysis& of, const std::string& column, const Vector& y) {
  const auto groups = TRY(two_of(of, column, groups_in_order(of.table, column, y)));
  const auto d = statistics::two_samples(groups.values[1], groups.values[0]);
  if (!d) return located(of, d.error());
  Json out = report_head(of, "difference of two groups and its size");
  out["compared"] = groups.names[1] + " minus " + groups.names[0];
  out["difference"] = block(*d);
  out["effect"] = {{"cohen_d", d->d},
                   {"cohen_d_ci95_low", d->d_95.low},
                   {"cohen_d_ci95_high", d->d_95.high},
                   {"hedges_g", d->g},
                   {"glass_delta", d->d_other}};
  if (const auto w = statistics::welch_t(groups.values[1], groups.values[0]))
    out["welch"] = {{"t", w->t},
                    {"df", w->df},
                    {"p", w->p},
                    {"ci95_low", w->difference_95.low},
                    {"ci95_high", w->difference_95.high}};
  if (const auto u = statistics::mann_whitney(groups.values[1], groups.values[0]))
    out["mann_whitney"] = {{"W", u->w}, {"p_exact", u->p}, {"cliff_delta", u->cliff_delta}};
  add_test(column, *d, "Cohen's d", out);
  return Findings{std::move(out), {group_picture(column, groups, of.formula.response)}};
}

bool is_between_persons(const Analysis& of, const statistics::Groups& means) {
  std::size_t values = 0;
  for (const auto& group : means.values) values += static_cast<std::size_t>(group.size());
  return values == levels_of(of.table, of.formula.group).size();
}

core::Result<Findings> of_two(const Analysis& of, const std::string& column) {
  const auto y = TRY(of.table.numbers(of.formula.response));
  if (of.formula.group.empty()) return of_groups(of, column, y);
  const auto means = group_means(of, column, y);
  if (!is_between_persons(of, means)) return of_pairs(of, column, y);
  const auto groups = TRY(two_of(of, column, means));
  return of_persons(of, column, groups);
}

core::Result<Findings> run_effect_size(const Analysis& of) {
  const auto column = TRY(single_column(of, "effect-size"));
  const std::string &level = of.text("level"), &reference = of.text("reference");
  if (level.empty() && reference.empty()) return of_two(of, column);
  if (level.empty() || reference.empty() || level == reference)
    return core::bad_input("effect-size: level and reference are two different values of " +
                           column);
  const auto& cells = of.table.texts(column);
  for (const auto& wanted : {level, reference})
    if (std::ranges::find(cells, wanted) == cells.end())
      return core::bad_input(fmt::format("{}: column '{}' has no value '{}'", of.table.name(),
                                         column, core::one_line(wanted, 60)));
  const Table two = of.table.filtered(
      [&](std::size_t row) { return cells[row] == level || cells[row] == reference; });
  return of_two({of.formula, two, of.formula_text, of.options}, column);
}

}  // namespace

namespace methods {
Method effect_size_method() {
  return {"effect-size",
          "Two groups, of rows or of persons with (1|subject): difference, d, g, Cliff's delta",
          "operation_time_s ~ group",
          "Cohen's d and Hedges' g (exact factor) with intervals from the noncentral t; persons "
          "who each belong to one group are compared by their means, with Welch's t test",
          {{.name = "level",
            .meaning = "value of the column that is compared; empty: there are two",
            .fallback = "",
            .choices = {},
            .text = true},
           {.name = "reference",
            .meaning = "value of the column with which it is compared",
            .fallback = "",
            .choices = {},
            .text = true}},
          run_effect_size};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
