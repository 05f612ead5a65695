/// Tests on ranks: which one follows from the formula.
#include <fmt/format.h>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"
#include "statistics/ranks/rank_tests.hpp"
#include "statistics/summary/effect_size.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

const double kNone = std::nan("");

core::Result<Findings> correlations(const Analysis& of, const std::string& column,
                                    const Vector& y) {
  const auto x = TRY(of.table.numbers(column));
  const auto rho = statistics::spearman(x, y);
  if (!rho) return located(of, rho.error());
  const auto tau = statistics::kendall(x, y);
  if (!tau) return located(of, tau.error());
  const auto or_null = [](const std::optional<double>& p) { return p ? Json(*p) : Json(nullptr); };
  Json out = report_head(of, "rank correlation");
  out["spearman"] = {
      {"rho", rho->r}, {"t", rho->statistic}, {"p_t", rho->p}, {"p_exact", or_null(rho->p_exact)}};
  out["kendall"] = {{"tau_b", tau->r},
                    {"z", tau->statistic},
                    {"p_normal", tau->p},
                    {"p_exact", or_null(tau->p_exact)}};
  if (const auto r = statistics::pearson(x, y))
    out["pearson"] = {{"r", r->r},
                      {"t", r->t},
                      {"p", r->p},
                      {"ci95_low", r->r_95.low},
                      {"ci95_high", r->r_95.high}};
  Test test{column, "t", rho->statistic, 0, static_cast<double>(y.size() - 2), rho->p};
  if (rho->p_exact) test = {column, "exact", rho->r, 0, 0, *rho->p_exact};
  test.effect = "Spearman's rho";
  test.size = rho->r;
  test.low = test.high = kNone;
  out["tests"] = Json::array({test.to_json()});
  return Findings{std::move(out), {scatter_picture(column, x, of.formula.response, y, {})}};
}

core::Result<Findings> two_groups(const Analysis& of, const std::string& column,
                                  const statistics::Groups& groups) {
  const auto u = statistics::mann_whitney(groups.values[1], groups.values[0]);
  if (!u) return located(of, u.error());
  Json out = report_head(of, "Mann-Whitney test, exact");
  out["compared"] = groups.names[1] + " against " + groups.names[0];
  out["analysis"] = {{"W", u->w}, {"p_exact", u->p}, {"cliff_delta", u->cliff_delta}};
  out["tests"] = Json::array(
      {Test{column, "exact", u->w, 0, 0, u->p, "Cliff's delta", u->cliff_delta, kNone, kNone}
           .to_json()});
  return Findings{std::move(out), {group_picture(column, groups, of.formula.response)}};
}

core::Result<Findings> independent(const Analysis& of, const std::string& column, const Vector& y) {
  const auto groups = groups_in_order(of.table, column, y);
  if (groups.names.size() == 2 && y.size() <= 200) return two_groups(of, column, groups);
  const auto h = statistics::kruskal_wallis(groups);
  if (!h) return located(of, h.error());
  Json out = report_head(of, "Kruskal-Wallis test");
  out["analysis"] = {
      {"H", h->h}, {"df", h->df}, {"p_chi_squared", h->p}, {"epsilon_squared", h->epsilon_squared}};
  double p = h->p;
  if (const auto exact = statistics::kruskal_wallis_exact(groups)) {
    p = exact->p;
    out["exact"] = {
        {"p", p}, {"as_extreme", exact->as_extreme}, {"arrangements", exact->arrangements}};
  }
  if (const auto spread = statistics::fligner_killeen(groups))
    out["checks"] = Json::array({check_row("groups spread equally",
                                           fmt::format("Fligner-Killeen {:.4g}", spread->statistic),
                                           spread->p, "unequal spread is read as a shift too")});
  out["tests"] = Json::array(
      {Test{column, "chi2", h->h, h->df, 0, p, "epsilon squared", h->epsilon_squared, kNone, kNone}
           .to_json()});
  return Findings{std::move(out), {group_picture(column, groups, of.formula.response)}};
}

core::Result<Findings> repeated(const Analysis& of, const std::string& column, const Vector& y) {
  const auto cells = TRY(cells_of(of, {column}, y));
  const plot::Figure figure = profile_picture(cells.names, cells.values, of.formula.response);
  if (cells.names.size() == 2) {
    const auto v = statistics::wilcoxon_signed_rank(cells.values.col(1) - cells.values.col(0));
    if (!v) return located(of, v.error());
    Json out = report_head(of, "Wilcoxon signed-rank test, exact");
    out["compared"] = cells.names[1] + " minus " + cells.names[0];
    out["analysis"] = {{"V", v->statistic}, {"p_exact", v->p}};
    out["tests"] =
        Json::array({Test{column, "exact", v->statistic, 0, 0, v->p, "", 0, 0, 0}.to_json()});
    return Findings{std::move(out), {figure}};
  }
  const auto f = statistics::friedman(cells.values);
  if (!f) return located(of, f.error());
  Json out = report_head(of, "Friedman test");
  out["analysis"] = {
      {"chi_squared", f->chi_squared}, {"df", f->df}, {"p", f->p}, {"kendall_w", f->kendall_w}};
  out["tests"] = Json::array({Test{column, "chi2", f->chi_squared, f->df, 0, f->p, "Kendall's W",
                                   f->kendall_w, kNone, kNone}
                                  .to_json()});
  const auto rising = statistics::page_trend(cells.values);
  const auto falling = statistics::page_trend(-cells.values);
  if (rising && falling)
    out["page_trend"] = {
        {"L", rising->l}, {"p_rising", rising->p_rising}, {"p_falling", falling->p_rising}};
  return Findings{std::move(out), {figure}};
}

core::Result<Findings> run_rank(const Analysis& of) {
  const auto column = TRY(single_column(of, "rank"));
  const auto y = TRY(of.table.numbers(of.formula.response));
  if (!of.formula.group.empty()) return repeated(of, column, y);
  if (of.formula.terms[0].variables[0].as != Variable::As::itself)
    return independent(of, column, y);
  const auto number = TRY(of.table.holds_numbers(column));
  return number ? correlations(of, column, y) : independent(of, column, y);
}

}  // namespace

namespace methods {
Method rank_method() {
  return {"rank",
          "Spearman and Kendall, Mann-Whitney, Kruskal-Wallis, Wilcoxon, Friedman, Page",
          "velocity_m_s ~ C(repetition) + (1|surgeon)",
          "tests on ranks, exact where the sizes allow",
          {},
          run_rank};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
