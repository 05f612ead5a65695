/// Ordinary least squares.
#include "statistics/regression/ols.hpp"

#include <fmt/format.h>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "assessment/terms.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

constexpr double kInfluential = 0.5;  // Cook's distance worth a sentence

/// What the fit becomes without row `i`, as a sentence; empty when that cannot be fitted.
std::string without_row(const Problem& problem, const statistics::Ols& fit, Eigen::Index i,
                        double cook) {
  const Eigen::Index n = problem.y.size(), last = n - 1 - i;
  const auto& columns = problem.design().columns;
  statistics::Design rest = problem.design();
  Vector y(n - 1);
  rest.columns.resize(n - 1, columns.cols());
  rest.columns << columns.topRows(i), columns.bottomRows(last);
  y << problem.y.head(i), problem.y.tail(last);
  const auto again = statistics::ols(rest, y);
  std::string out = fmt::format("row {} steers the fit (leverage {:.3f}, Cook's distance {:.2f})",
                                i + 1, fit.leverage[i], cook);
  if (!again) return out;
  out += "; without it:";
  for (Eigen::Index j = 0; j < fit.coefficients.size(); ++j)
    out += fmt::format(" {} {:.4g} (was {:.4g}, p {:.3g})", fit.names[static_cast<std::size_t>(j)],
                       again->coefficients[j], fit.coefficients[j], again->p[j]);
  return out;
}

void add_notes_and_checks(const Problem& problem, const statistics::Ols& fit, Json& out) {
  out["checks"] = Json::array({normality_check(fit.residuals)});
  out["notes"] = Json::array();
  if (!(fit.rss > 1e-24 * (problem.y - fit.residuals).squaredNorm()))
    out["notes"].push_back("the columns fit the response to the last digit: t and p mean nothing");
  Eigen::Index most = 0;
  const Vector cook = statistics::influence(fit).cooks_distance;
  if (!cook.allFinite()) return;
  const double largest = cook.maxCoeff(&most);
  out["checks"].push_back(
      check_row("no row steers the fit",
                fmt::format("largest Cook's distance {:.3f}, row {}", largest, most + 1),
                std::nan(""), largest >= kInfluential ? "read the note below" : "none does"));
  if (largest >= kInfluential) out["notes"].push_back(without_row(problem, fit, most, largest));
}

core::Result<Findings> run_ols(const Analysis& of) {
  const auto problem = TRY(problem_of(of, false));
  const auto fit = statistics::ols(problem.design(), problem.y);
  if (!fit) return located(of, fit.error());
  const Vector hc3 = statistics::hc3_standard_errors(problem.design(), *fit);
  Json out = report_head(of, "ordinary least squares");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"t", &fit->t},
                                                       {"p", &fit->p},
                                                       {"ci95_low", &fit->ci_low},
                                                       {"ci95_high", &fit->ci_high},
                                                       {"hc3_standard_error", &hc3}});
  const Fitted fitted{fit->coefficients, fit->sigma * fit->sigma * fit->unscaled_covariance,
                      Vector::Constant(fit->coefficients.size(), fit->df_residual), "t"};
  add_term_tests(of.formula, problem.model, fitted, out);
  out["model"] = {{"df_residual", fit->df_residual},
                  {"residual_sd", fit->sigma},
                  {"residual_sum_of_squares", fit->rss},
                  {"r_squared", fit->r_squared},
                  {"adjusted_r_squared", fit->adjusted_r_squared},
                  {"F", fit->f},
                  {"F_df1", fit->f_df1},
                  {"F_p", fit->f_p},
                  {"log_likelihood", fit->log_likelihood},
                  {"AIC", fit->aic},
                  {"BIC", fit->bic}};
  add_notes_and_checks(problem, *fit, out);
  Findings found{std::move(out), {}};
  std::vector<RegressionLine> lines;
  if (fit->coefficients.size() == 2)
    lines.push_back({"least squares", fit->coefficients[0], fit->coefficients[1],
                     band_of(fitted.covariance, fit->df_residual)});
  if (auto figure = predictor_picture(of, problem, lines)) found.figures.push_back(*figure);
  found.figures.push_back(residual_picture(problem.y - fit->residuals, fit->residuals));
  return found;
}

}  // namespace

namespace methods {
Method ols_method() {
  return {"ols",
          "Linear regression by ordinary least squares",
          "wrong_breach ~ experience_years",
          "ordinary least squares with t tests of the coefficients",
          {},
          run_ols};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
