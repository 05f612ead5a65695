/// The regressions of `tractus stats`: least squares, robust, mixed, logistic.
#include <fmt/format.h>

#include "app/stats_report.hpp"
#include "statistics/bisquare.hpp"
#include "statistics/glmm.hpp"
#include "statistics/lmm.hpp"
#include "statistics/logistic.hpp"
#include "statistics/ols.hpp"

namespace commands {
namespace {

using core::Json;
using statistics::Design;
using statistics::Vector;

constexpr double kInfluential = 0.5;  // Cook's distance worth a sentence

core::Error wrong(std::string what) { return {core::Errc::bad_input, std::move(what)}; }

struct Problem {
  Design design;
  Vector y;
};

core::Error located(const Analysis& of, const core::Error& error) {
  return {error.code, of.table.name() + ": " + error.what};
}

core::Result<Problem> problem_of(const Analysis& of, bool grouped) {
  if (!grouped && !of.formula.group.empty())
    return wrong("(1|" + of.formula.group + ") needs 'lmm': this method knows no groups");
  if (!of.formula.trials.empty() || of.formula.trials_number != 1)
    return wrong("successes/trials on the left is for 'logistic' alone");
  auto design = design_of(of.formula, of.table);
  if (!design) return design.error();
  auto y = of.table.numbers(of.formula.response);
  if (!y) return y.error();
  return Problem{std::move(*design), std::move(*y)};
}

/// What the fit becomes without row `i`, as a sentence; empty when that cannot be fitted.
std::string without_row(const Problem& problem, const statistics::Ols& fit, Eigen::Index i,
                        double cook) {
  const Eigen::Index n = problem.y.size(), last = n - 1 - i;
  Problem rest{problem.design, Vector(n - 1)};
  rest.design.columns.resize(n - 1, problem.design.columns.cols());
  rest.design.columns << problem.design.columns.topRows(i), problem.design.columns.bottomRows(last);
  rest.y << problem.y.head(i), problem.y.tail(last);
  const auto again = statistics::ols(rest.design, rest.y);
  std::string out = fmt::format("row {} steers the fit (leverage {:.3f}, Cook's distance {:.2f})",
                                i + 1, fit.leverage[i], cook);
  if (!again) return out;
  out += "; without it:";
  for (Eigen::Index j = 0; j < fit.coefficients.size(); ++j)
    out += fmt::format(" {} {:.4g} (was {:.4g}, p {:.3g})", fit.names[static_cast<std::size_t>(j)],
                       again->coefficients[j], fit.coefficients[j], again->p[j]);
  return out;
}

Json ols_notes(const Problem& problem, const statistics::Ols& fit) {
  Json notes = Json::array();
  if (!(fit.rss > 1e-24 * fit.fitted.squaredNorm()))
    notes.push_back("the columns fit the response to the last digit: t and p mean nothing");
  Eigen::Index most = 0;
  const Vector cook = statistics::influence(fit).cooks_distance;
  if (cook.allFinite() && cook.maxCoeff(&most) >= kInfluential)
    notes.push_back(without_row(problem, fit, most, cook[most]));
  return notes;
}

}  // namespace

core::Result<Json> ols_report(const Analysis& of) {
  const auto problem = problem_of(of, false);
  if (!problem) return problem.error();
  const auto fit = statistics::ols(problem->design, problem->y);
  if (!fit) return located(of, fit.error());
  const Vector hc3 = statistics::hc3_standard_errors(problem->design, *fit);
  Json out = report_head(of, "ordinary least squares");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"t", &fit->t},
                                                       {"p", &fit->p},
                                                       {"ci95_low", &fit->ci_low},
                                                       {"ci95_high", &fit->ci_high},
                                                       {"hc3_standard_error", &hc3}});
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
  out["notes"] = ols_notes(*problem, *fit);
  return out;
}

core::Result<Json> robust_report(const Analysis& of) {
  const auto problem = problem_of(of, false);
  if (!problem) return problem.error();
  const auto fit = statistics::bisquare(problem->design, problem->y);
  if (!fit) return located(of, fit.error());
  Json out = report_head(of, "bisquare M-estimation (tuning 4.685)");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"t", &fit->t},
                                                       {"p", &fit->p},
                                                       {"least_squares", &fit->ols_coefficients}});
  out["model"] = {{"df_residual", fit->df_residual},
                  {"sigma", fit->sigma},
                  {"robust_sigma", fit->robust_sigma},
                  {"mad_sigma", fit->mad_sigma},
                  {"least_squares_sigma", fit->ols_sigma},
                  {"iterations", fit->iterations},
                  {"converged", fit->converged}};
  Json rows = Json::array();
  for (Eigen::Index i = 0; i < fit->weights.size(); ++i)
    if (fit->weights[i] < 0.5 && rows.size() < 1000)
      rows.push_back({{"row", i + 1},
                      {"weight", fit->weights[i]},
                      {"residual", fit->residuals[i]},
                      {"leverage", fit->leverage[i]}});
  out["rows_with_weight_below_half"] = std::move(rows);
  out["notes"] = Json::array();
  if (!fit->converged) out["notes"].push_back("50 iterations were not enough to settle");
  Eigen::Index most = 0;
  if (fit->leverage.maxCoeff(&most) > kInfluential)
    out["notes"].push_back(
        fmt::format("row {} has leverage {:.3f}: robust in y, this fit does not protect against it",
                    most + 1, fit->leverage[most]));
  return out;
}

core::Result<Json> lmm_report(const Analysis& of) {
  if (of.formula.group.empty())
    return wrong("lmm needs a random intercept: add (1|COLUMN) to the formula");
  const auto problem = problem_of(of, true);
  if (!problem) return problem.error();
  const auto& cells = of.table.texts(of.formula.group);
  const std::vector<std::string> labels(cells.begin(), cells.end());
  const auto fit = statistics::lmm(problem->design, problem->y, labels);
  if (!fit) return located(of, fit.error());
  Json out = report_head(of, "linear mixed model, random intercept, REML, Satterthwaite");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"df", &fit->df},
                                                       {"t", &fit->t},
                                                       {"p", &fit->p}});
  out["model"] = {{"groups", fit->groups.size()},
                  {"variance_between", fit->tau_squared},
                  {"variance_within", fit->sigma_squared},
                  {"icc", fit->icc},
                  {"reml_criterion", fit->criterion},
                  {"likelihood_ratio_of_groups", fit->rlrt},
                  {"p_of_groups", fit->rlrt_p}};
  out["group_effects"] = coefficient_table(fit->groups, {{"effect", &fit->group_effects}});
  out["notes"] = Json::array();
  if (fit->tau_squared == 0.0)
    out["notes"].push_back("the spread between groups is estimated as 0: this is least squares");
  return out;
}

namespace {

core::Result<statistics::Counts> counts_of(const Analysis& of) {
  auto successes = of.table.numbers(of.formula.response);
  if (!successes) return successes.error();
  const auto rows = successes->size();
  if (of.formula.trials.empty())
    return statistics::Counts{*successes, Vector::Constant(rows, of.formula.trials_number)};
  auto trials = of.table.numbers(of.formula.trials);
  if (!trials) return trials.error();
  return statistics::Counts{*successes, *trials};
}

core::Result<Json> firth_report(const Analysis& of, const Design& design,
                                const statistics::Counts& counts) {
  const auto fit = statistics::firth_logistic(design, counts);
  if (!fit) return located(of, fit.error());
  const Vector odds = fit->coefficients.array().exp();
  Json out = report_head(of, "logistic regression, Firth's penalised likelihood");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"z", &fit->z},
                                                       {"p", &fit->p},
                                                       {"ci95_low", &fit->ci_low},
                                                       {"ci95_high", &fit->ci_high},
                                                       {"odds_ratio", &odds}});
  out["model"] = {{"penalised_log_likelihood", fit->penalised_log_likelihood},
                  {"iterations", fit->iterations}};
  out["notes"] = {
      "the columns separate the outcomes: maximum likelihood has no finite answer, so Firth's "
      "estimate is given; its Wald p and intervals are rough"};
  return out;
}

}  // namespace

namespace {

core::Result<Json> mixed_report(const Analysis& of, const Design& design,
                                const statistics::Counts& counts) {
  const auto& cells = of.table.texts(of.formula.group);
  const auto fit = statistics::logistic_mixed(design, counts, {cells.begin(), cells.end()});
  if (!fit) return located(of, fit.error());
  const Vector odds = fit->coefficients.array().exp();
  Json out = report_head(of, "logistic mixed model, random intercept, 50-node quadrature");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"z", &fit->z},
                                                       {"p", &fit->p},
                                                       {"odds_ratio", &odds}});
  out["model"] = {{"groups", fit->groups.size()},
                  {"sd_between_groups", fit->sigma_u},
                  {"sd_between_groups_se", fit->sigma_u_se},
                  {"log_likelihood", fit->log_likelihood}};
  out["notes"] = Json::array();
  if (fit->sigma_u == 0.0)
    out["notes"].push_back("the spread between groups is estimated as 0: this is plain logistic");
  if (fit->groups.size() < 30)
    out["notes"].push_back(
        fmt::format("{} groups: the normal p is somewhat too small; an exact "
                    "permutation test is safer",
                    fit->groups.size()));
  return out;
}

/// Likelihood-profile ends of every coefficient; NaN where the likelihood does not bound it.
std::pair<Vector, Vector> profiles(const Design& design, const statistics::Counts& counts,
                                   const statistics::Logistic& fit) {
  Vector low(fit.coefficients.size()), high(fit.coefficients.size());
  for (Eigen::Index j = 0; j < low.size(); ++j) {
    const auto ends = statistics::profile_interval(design, counts, fit, j);
    low[j] = ends ? ends->first : std::nan("");
    high[j] = ends ? ends->second : std::nan("");
  }
  return {low, high};
}

Json plain_report(const Analysis& of, const Design& design, const statistics::Counts& counts,
                  const statistics::Logistic& fit) {
  const Vector odds = fit.coefficients.array().exp();
  const auto [low, high] = profiles(design, counts, fit);
  Json out = report_head(of, "logistic regression");
  out["coefficients"] = coefficient_table(fit.names, {{"estimate", &fit.coefficients},
                                                      {"standard_error", &fit.standard_errors},
                                                      {"z", &fit.z},
                                                      {"p", &fit.p},
                                                      {"profile95_low", &low},
                                                      {"profile95_high", &high},
                                                      {"odds_ratio", &odds}});
  out["model"] = {{"deviance", fit.deviance},
                  {"null_deviance", fit.null_deviance},
                  {"df_residual", fit.df_residual},
                  {"likelihood_ratio", fit.lr_chi_squared},
                  {"likelihood_ratio_df", fit.lr_df},
                  {"likelihood_ratio_p", fit.lr_p},
                  {"log_likelihood", fit.log_likelihood},
                  {"AIC", fit.aic},
                  {"pearson_dispersion", fit.dispersion}};
  if (counts.trials.maxCoeff() <= 1.0) return out;
  const auto quasi = statistics::quasi_binomial(fit);
  out["allowing_for_dispersion"] = coefficient_table(
      fit.names, {{"standard_error", &quasi.standard_errors}, {"t", &quasi.t}, {"p", &quasi.p}});
  return out;
}

}  // namespace

core::Result<Json> logistic_report(const Analysis& of) {
  const auto design = design_of(of.formula, of.table);
  if (!design) return design.error();
  const auto counts = counts_of(of);
  if (!counts) return counts.error();
  if (!of.formula.group.empty()) return mixed_report(of, *design, *counts);
  const auto fit = statistics::logistic(*design, *counts);
  if (!fit && fit.error().code == core::Errc::out_of_range)
    return firth_report(of, *design, *counts);
  if (!fit) return located(of, fit.error());
  return plain_report(of, *design, *counts, *fit);
}

}  // namespace commands
