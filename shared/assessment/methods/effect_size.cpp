/// Two groups or two levels: the difference with its size.
#include "statistics/summary/effect_size.hpp"

#include <fmt/format.h>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"
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

core::Result<Findings> of_groups(const Analysis& of, const std::string& column, const Vector& y) {
  const auto groups = groups_in_order(of.table, column, y);
  if (groups.names.size() != 2)
    return core::bad_input(
        fmt::format("{}: column '{}' has {} values; an effect size is of two groups "
                    "(anova gives those of more)",
                    of.table.name(), column, groups.names.size()));
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

core::Result<Findings> run_effect_size(const Analysis& of) {
  const auto column = TRY(single_column(of, "effect-size"));
  const auto y = TRY(of.table.numbers(of.formula.response));
  return of.formula.group.empty() ? of_groups(of, column, y) : of_pairs(of, column, y);
}

}  // namespace

namespace methods {
Method effect_size_method() {
  return {"effect-size",
          "Two groups, or two levels with (1|subject): difference, d, g, Cliff's delta",
          "operation_time_s ~ group",
          "Cohen's d and Hedges' g (exact factor) with intervals from the noncentral t",
          {},
          run_effect_size};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
