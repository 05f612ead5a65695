/// Robust regression: bisquare M-estimation.
#include <fmt/format.h>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "assessment/terms.hpp"
#include "core/try.hpp"
#include "statistics/regression/bisquare.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

constexpr double kHighLeverage = 0.5;

Json light_rows(const statistics::Bisquare& fit) {
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < fit.weights.size(); ++i)
    if (fit.weights[i] < 0.5 && rows.size() < 1000)
      rows.push_back({{"row", i + 1},
                      {"weight", fit.weights[i]},
                      {"residual", fit.residuals[i]},
                      {"leverage", fit.leverage[i]}});
  return rows;
}

core::Result<Findings> run_robust(const Analysis& of) {
  const auto problem = TRY(problem_of(of, false));
  const auto fit = statistics::bisquare(problem.design(), problem.y);
  if (!fit) return located(of, fit.error());
  Json out = report_head(of, "bisquare M-estimation (tuning 4.685)");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"t", &fit->t},
                                                       {"p", &fit->p},
                                                       {"least_squares", &fit->ols_coefficients}});
  add_term_tests(of.formula, problem.model,
                 {fit->coefficients, fit->covariance,
                  statistics::Vector::Constant(fit->coefficients.size(), fit->df_residual), "t"},
                 out);
  out["model"] = {{"df_residual", fit->df_residual},
                  {"sigma", fit->sigma},
                  {"robust_sigma", fit->robust_sigma},
                  {"mad_sigma", fit->mad_sigma},
                  {"least_squares_sigma", fit->ols_sigma},
                  {"iterations", fit->iterations},
                  {"converged", fit->converged}};
  out["rows_with_weight_below_half"] = light_rows(*fit);
  Eigen::Index most = 0;
  const double leverage = fit->leverage.maxCoeff(&most);
  out["checks"] = Json::array(
      {check_row("no row stands alone at its x",
                 fmt::format("largest leverage {:.3f}, row {}", leverage, most + 1), std::nan(""),
                 leverage > kHighLeverage ? "read the note below" : "none does")});
  out["notes"] = Json::array();
  if (!(fit->sigma > 1e-12 * problem.y.cwiseAbs().maxCoeff()))
    out["notes"].push_back("the columns fit the response to the last digit: t and p mean nothing");
  if (!fit->converged) out["notes"].push_back("50 iterations were not enough to settle");
  if (leverage > kHighLeverage)
    out["notes"].push_back(
        fmt::format("row {} has leverage {:.3f}: robust in y, this fit does not protect against it",
                    most + 1, leverage));
  Findings found{std::move(out), {}};
  std::vector<RegressionLine> lines;
  if (fit->coefficients.size() == 2)
    lines = {{"bisquare", fit->coefficients[0], fit->coefficients[1],
              band_of(fit->covariance, fit->df_residual)},
             {"least squares", fit->ols_coefficients[0], fit->ols_coefficients[1]}};
  if (auto figure = predictor_picture(of, problem, lines)) found.figures.push_back(*figure);
  found.figures.push_back(
      residual_picture(problem.design().columns * fit->coefficients, fit->residuals));
  return found;
}

}  // namespace

namespace methods {
Method robust_method() {
  return {"robust",
          "Linear regression that outliers in the response cannot steer",
          "force_variance_N2 ~ experience_years",
          "M-estimation with Tukey's bisquare (tuning constant 4.685, leverage-adjusted residuals, "
          "standard errors after DuMouchel and O'Brien 1989)",
          {},
          run_robust};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
