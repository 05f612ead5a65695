/// Linear mixed model: one random intercept, or any random terms, crossed or nested.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "assessment/pictures.hpp"
#include "assessment/random_terms.hpp"
#include "assessment/report.hpp"
#include "assessment/terms.hpp"
#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"
#include "statistics/mixed/lmm_tests.hpp"
#include "statistics/mixed/mixed_model.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

void add_model(const statistics::Lmm& fit, Json& out) {
  out["model"] = {{"groups", fit.groups.size()},
                  {"variance_between", fit.tau_squared},
                  {"variance_within", fit.sigma_squared},
                  {"icc", fit.icc},
                  {"reml_criterion", fit.criterion},
                  {"likelihood_ratio_of_groups", fit.rlrt},
                  {"p_of_groups", fit.rlrt_p}};
  out["group_effects"] = coefficient_table(fit.groups, {{"effect", &fit.group_effects}});
}

/// Coefficients with both small-sample corrections; the tests by the one that was asked for.
void add_tests(const Analysis& of, const ModelMatrix& model, const statistics::Lmm& fit,
               Json& out) {
  const auto kr = statistics::kenward_roger(fit);
  out["coefficients"] = coefficient_table(fit.names, {{"estimate", &fit.coefficients},
                                                      {"standard_error", &fit.standard_errors},
                                                      {"df", &fit.df},
                                                      {"t", &fit.t},
                                                      {"p", &fit.p}});
  out["kenward_roger"] = coefficient_table(
      fit.names,
      {{"standard_error", &kr.standard_errors}, {"df", &kr.df}, {"t", &kr.t}, {"p", &kr.p}});
  const bool by_kr = of.text("df") == "kenward-roger";
  const auto how =
      by_kr ? statistics::SmallSample::kenward_roger : statistics::SmallSample::satterthwaite;
  out["degrees_of_freedom"] = {{"of_the_tests", of.text("df")}};
  add_term_tests(
      of.formula, model,
      {fit.coefficients, by_kr ? kr.covariance : fit.covariance, by_kr ? kr.df : fit.df, "t",
       [&](const std::vector<Eigen::Index>& columns) {
         return statistics::joint_test(fit, columns, how);
       }},
      out);
}

/// Of the 95 % interval of intercept + slope · x, by t on Satterthwaite's degrees of freedom.
double half_width(const statistics::Lmm& fit, double x) {
  const Vector contrast = Eigen::Vector2d(1.0, x);
  return statistics::student_t_quantile(0.975, statistics::satterthwaite_df(fit, contrast)) *
         std::sqrt(contrast.dot(fit.covariance * contrast));
}

/// y − X β − Z b: what is left of each row.
statistics::Vector residuals_of(const Problem& problem,
                                const std::vector<statistics::RandomTerm>& terms,
                                const statistics::MixedModel& fit) {
  Vector out = problem.y - problem.design().columns * fit.coefficients;
  for (std::size_t t = 0; t < terms.size(); ++t) {
    const auto& part = fit.random[t];
    std::map<std::string_view, Eigen::Index> place;
    for (const auto& level : part.levels) place.emplace(level, std::ssize(place));
    for (Eigen::Index i = 0; i < out.size(); ++i)
      out[i] -=
          terms[t].columns.row(i).dot(part.effects.row(place.at(terms[t].labels[std::size_t(i)])));
  }
  return out;
}

core::Result<Findings> run_with_random_terms(const Analysis& of) {
  const auto problem = TRY(problem_of(of, true));
  const auto terms = TRY(random_terms(of));
  const auto fit = statistics::mixed_model(problem.design(), problem.y, terms,
                                           statistics::Likelihood::reml, of.progress);
  if (!fit) return located(of, fit.error());
  if (of.progress) of.progress(1.0);
  const bool by_kr = of.text("df") == "kenward-roger";
  statistics::KenwardRoger kr;
  if (by_kr) {
    auto tests = statistics::kenward_roger(*fit, problem.design(), terms);
    if (!tests) return located(of, tests.error());
    kr = std::move(*tests);
  }
  Json out = report_head(of, "linear mixed model, REML");
  out["coefficients"] = coefficient_table(fit->names, {{"estimate", &fit->coefficients},
                                                       {"standard_error", &fit->standard_errors},
                                                       {"df", &fit->df},
                                                       {"t", &fit->t},
                                                       {"p", &fit->p}});
  if (by_kr)
    out["kenward_roger"] = coefficient_table(
        fit->names,
        {{"standard_error", &kr.standard_errors}, {"df", &kr.df}, {"t", &kr.t}, {"p", &kr.p}});
  out["degrees_of_freedom"] = {{"of_the_tests", of.text("df")}};
  add_term_tests(
      of.formula, problem.model,
      {fit->coefficients, by_kr ? kr.covariance : fit->covariance, by_kr ? kr.df : fit->df, "t",
       [&](const std::vector<Eigen::Index>& columns) {
         return by_kr ? statistics::joint_test(kr, columns) : statistics::joint_test(*fit, columns);
       }},
      out);
  add_random_effects(fit->random, out);
  out["model"] = {{"variance_residual", fit->sigma_squared},
                  {"reml_criterion", fit->criterion},
                  {"parameters", fit->parameters}};
  const Vector residuals = residuals_of(problem, terms, *fit);
  out["checks"] = Json::array({normality_check(residuals)});
  out["notes"] = random_notes(fit->random, fit->converged);
  Findings found{std::move(out), {}};
  found.figures.push_back(residual_picture(problem.y - residuals, residuals));
  return found;
}

core::Result<Findings> run_lmm(const Analysis& of) {
  if (!of.formula.random.empty()) return run_with_random_terms(of);
  if (of.formula.group.empty())
    return core::bad_input("lmm needs a random intercept: add (1|COLUMN) to the formula");
  const auto problem = TRY(problem_of(of, true));
  const auto labels = group_labels(of);
  const auto fit = statistics::lmm(problem.design(), problem.y, labels);
  if (!fit) return located(of, fit.error());
  Json out = report_head(of, "linear mixed model, random intercept, REML");
  add_tests(of, problem.model, *fit, out);
  add_model(*fit, out);
  const Vector fixed = problem.design().columns * fit->coefficients;
  Vector fitted = fixed;
  const auto places = places_of(of.table, of.formula.group, fit->groups);
  for (std::size_t i = 0; i < places.size(); ++i)
    fitted[static_cast<Eigen::Index>(i)] +=
        fit->group_effects[static_cast<Eigen::Index>(places[i])];
  const Vector residuals = problem.y - fitted;
  out["checks"] = Json::array({normality_check(residuals)});
  auto effects = normality_check(fit->group_effects);
  effects["assumption"] = "effects of " + of.formula.group + " are normal";
  out["checks"].push_back(effects);
  out["notes"] = Json::array();
  if (fit->tau_squared == 0.0)
    out["notes"].push_back("the spread between groups is estimated as 0: this is least squares");
  if (fit->groups.size() < 6)
    out["notes"].push_back(
        fmt::format("{} groups say little about the spread between groups", fit->groups.size()));
  Findings found{std::move(out), {}};
  std::vector<RegressionLine> lines;
  if (fit->coefficients.size() == 2)
    lines.push_back({"fixed effects", fit->coefficients[0], fit->coefficients[1],
                     [&](double x) { return half_width(*fit, x); }});
  if (auto figure = predictor_picture(of, problem, lines)) found.figures.push_back(*figure);
  found.figures.push_back(residual_picture(fitted, residuals));
  return found;
}

}  // namespace

namespace methods {
Method lmm_method() {
  return {
      "lmm",
      "Linear mixed model: rows of the same person go together",
      "velocity_m_s ~ trial + (1 + trial | surgeon) + (1 | scenario)",
      "a linear mixed model, fitted by restricted maximum likelihood, with small-sample degrees "
      "of freedom after Satterthwaite or after Kenward and Roger",
      {{"df",
        "degrees of freedom of the tests; kenward-roger: of at most 2000 random effects",
        "satterthwaite",
        {"satterthwaite", "kenward-roger"}}},
      run_lmm,
      true};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
