/// Logistic regression: plain, Firth's where outcomes are separated, mixed with (1|group) or with any
/// random terms.
#include "statistics/regression/logistic.hpp"

#include <fmt/format.h>

#include "assessment/random_terms.hpp"
#include "assessment/report.hpp"
#include "assessment/terms.hpp"
#include "core/try.hpp"
#include "statistics/mixed/glmm.hpp"
#include "statistics/mixed/logistic_mixed_model.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Counts;
using statistics::Vector;

constexpr double kFewAnswers = 10.0;  // for each level, below which Laplace's bias is said

core::Result<Counts> counts_of(const Analysis& of) {
  auto successes = TRY(of.table.numbers(of.formula.response));
  const auto rows = successes.size();
  if (of.formula.trials.empty())
    return Counts{successes, Vector::Constant(rows, of.formula.trials_number)};
  auto trials = TRY(of.table.numbers(of.formula.trials));
  return Counts{successes, trials};
}

/// Wald tests on the normal.
void add_tests(const Analysis& of, const ModelMatrix& model, const Vector& coefficients,
               const statistics::Matrix& covariance, Json& out) {
  add_term_tests(of.formula, model,
                 {coefficients, covariance, Vector::Zero(coefficients.size()), "z"}, out);
}

core::Result<Findings> firth(const Analysis& of, const ModelMatrix& model, const Counts& counts) {
  const auto fit = statistics::firth_logistic(model.design, counts);
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
  // Of each coefficient alone: Firth's fit keeps no covariance between them.
  Json tests = Json::array();
  for (std::size_t j = 0; j < fit->names.size(); ++j) {
    const auto i = static_cast<Eigen::Index>(j);
    if (fit->names[j] == "(Intercept)" && fit->names.size() > 1) continue;
    tests.push_back(Test{fit->names[j], "z", fit->z[i], 0, 0, fit->p[i], "log odds ratio",
                         fit->coefficients[i], fit->ci_low[i], fit->ci_high[i]}
                        .to_json());
  }
  out["tests"] = tests;
  out["model"] = {{"penalised_log_likelihood", fit->penalised_log_likelihood},
                  {"iterations", fit->iterations}};
  out["notes"] = {
      "the columns separate the outcomes: maximum likelihood has no finite answer, so Firth's "
      "estimate is given; its Wald p and intervals are rough"};
  return Findings{std::move(out), {}};
}

core::Result<Findings> mixed(const Analysis& of, const ModelMatrix& model, const Counts& counts) {
  const auto fit = statistics::logistic_mixed(model.design, counts, group_labels(of));
  if (!fit) return located(of, fit.error());
  const Vector odds = fit->coefficients.array().exp();
  Json out = report_head(of, "logistic mixed model, random intercept, 50-node quadrature");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"z", &fit->z},
                                                       {"p", &fit->p},
                                                       {"odds_ratio", &odds}});
  add_tests(of, model, fit->coefficients, fit->covariance, out);
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
  return Findings{std::move(out), {}};
}

core::Result<Findings> mixed_with_random_terms(const Analysis& of, const ModelMatrix& model,
                                               const Counts& counts) {
  const auto terms = TRY(random_terms(of));
  const auto fit = statistics::logistic_mixed_model(model.design, counts, terms, of.progress);
  if (!fit) return located(of, fit.error());
  if (of.progress) of.progress(1.0);
  const Vector odds = fit->coefficients.array().exp(), low = fit->ci_low.array().exp(),
               high = fit->ci_high.array().exp();
  Json out = report_head(of, "logistic mixed model, Laplace's approximation");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"z", &fit->z},
                                                       {"p", &fit->p},
                                                       {"odds_ratio", &odds},
                                                       {"odds_ratio95_low", &low},
                                                       {"odds_ratio95_high", &high}});
  add_tests(of, model, fit->coefficients, fit->covariance, out);
  add_random_effects(fit->random, out);
  out["model"] = {
      {"log_likelihood", fit->log_likelihood}, {"AIC", fit->aic}, {"parameters", fit->parameters}};
  out["notes"] = random_notes(fit->random, fit->converged);
  for (const auto& part : fit->random) {
    const double answers = counts.trials.sum() / double(part.levels.size());
    if (answers < kFewAnswers)
      out["notes"].push_back(fmt::format(
          "{:.3g} answers for each level of {}: of few, Laplace's approximation makes the spread "
          "between levels and the odds ratios too small",
          answers, part.group));
  }
  return Findings{std::move(out), {}};
}

/// Likelihood-profile ends of every coefficient; NaN where the likelihood does not bound it.
std::pair<Vector, Vector> profiles(const statistics::Design& design, const Counts& counts,
                                   const statistics::Logistic& fit) {
  Vector low(fit.coefficients.size()), high(fit.coefficients.size());
  for (Eigen::Index j = 0; j < low.size(); ++j) {
    const auto ends = statistics::profile_interval(design, counts, fit, j);
    low[j] = ends ? ends->first : std::nan("");
    high[j] = ends ? ends->second : std::nan("");
  }
  return {low, high};
}

Findings plain(const Analysis& of, const ModelMatrix& model, const Counts& counts,
               const statistics::Logistic& fit) {
  const Vector odds = fit.coefficients.array().exp();
  const auto [low, high] = profiles(model.design, counts, fit);
  Json out = report_head(of, "logistic regression");
  out["coefficients"] = coefficient_table(fit.names, {{"estimate", &fit.coefficients},
                                                      {"standard_error", &fit.standard_errors},
                                                      {"z", &fit.z},
                                                      {"p", &fit.p},
                                                      {"profile95_low", &low},
                                                      {"profile95_high", &high},
                                                      {"odds_ratio", &odds}});
  add_tests(of, model, fit.coefficients, fit.covariance, out);
  out["model"] = {{"deviance", fit.deviance},
                  {"null_deviance", fit.null_deviance},
                  {"df_residual", fit.df_residual},
                  {"likelihood_ratio", fit.lr_chi_squared},
                  {"likelihood_ratio_df", fit.lr_df},
                  {"likelihood_ratio_p", fit.lr_p},
                  {"log_likelihood", fit.log_likelihood},
                  {"AIC", fit.aic},
                  {"pearson_dispersion", fit.dispersion}};
  if (counts.trials.maxCoeff() <= 1.0) return {std::move(out), {}};
  const auto quasi = statistics::quasi_binomial(fit);
  out["allowing_for_dispersion"] = coefficient_table(
      fit.names, {{"standard_error", &quasi.standard_errors}, {"t", &quasi.t}, {"p", &quasi.p}});
  out["checks"] = Json::array({check_row(
      "answers do not cluster", fmt::format("Pearson dispersion {:.3f}", fit.dispersion),
      std::nan(""),
      fit.dispersion > 1.5 ? "use the tests that allow for dispersion" : "near 1: as binomial")});
  return {std::move(out), {}};
}

core::Result<Findings> run_logistic(const Analysis& of) {
  const auto model = TRY(model_matrix(of.formula, of.table));
  const auto counts = TRY(counts_of(of));
  if (!of.formula.random.empty()) return mixed_with_random_terms(of, model, counts);
  if (!of.formula.group.empty()) return mixed(of, model, counts);
  const auto fit = statistics::logistic(model.design, counts);
  if (!fit && fit.error().code == core::Errc::out_of_range) return firth(of, model, counts);
  if (!fit) return located(of, fit.error());
  return plain(of, model, counts, *fit);
}

}  // namespace

namespace methods {
Method logistic_method() {
  return {
      "logistic",
      "Logistic regression of right and wrong answers; mixed with (1|subject) or more random terms",
      "wrong_breach/6 ~ experience_years",
      "logistic regression by maximum likelihood (Firth's penalised likelihood where outcomes "
      "are separated; a random intercept by 50-node adaptive quadrature where answers of the "
      "same person recur; other random terms by Laplace's approximation)",
      {},
      run_logistic,
      true};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
