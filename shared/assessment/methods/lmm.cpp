/// Linear mixed model: one random intercept, or any random terms, crossed or nested.
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "assessment/pictures.hpp"
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

constexpr std::size_t kMostLevelsListed = 200;

/// The level of each row: its cells of the grouping's columns, joined.
std::vector<std::string> labels_of(const Table& table, const RandomEffects& effects) {
  std::vector<std::string> out(table.texts(effects.columns[0]).size());
  for (const auto& column : effects.columns) {
    const auto& cells = table.texts(column);
    for (std::size_t i = 0; i < out.size(); ++i)
      out[i] += (&column == &effects.columns[0] ? "" : ":") + std::string(cells[i]);
  }
  return out;
}

core::Result<statistics::RandomTerm> random_term(const Analysis& of, const RandomEffects& effects) {
  statistics::RandomTerm out{
      .group = effects.group(), .labels = labels_of(of.table, effects), .columns = {}, .names = {}};
  const auto rows = std::ssize(out.labels);
  out.columns.resize(rows, std::ssize(effects.slopes) + (effects.intercept ? 1 : 0));
  if (effects.intercept) {
    out.columns.col(0).setOnes();
    out.names.push_back("(Intercept)");
  }
  for (const auto& slope : effects.slopes) {
    TRY(of.table.holds_numbers(slope));
    out.columns.col(std::ssize(out.names)) = TRY(of.table.numbers(slope));
    out.names.push_back(slope);
  }
  return out;
}

/// One row per variance and, of a term with slopes, per correlation.
void add_random_effects(const statistics::MixedModel& fit, Json& out) {
  out["random_effects"] = Json::array();
  for (const auto& part : fit.random)
    for (Eigen::Index r = 0; r < part.covariance.rows(); ++r)
      for (Eigen::Index c = 0; c <= r; ++c) {
        const double own = part.covariance(r, c);
        const double scale = std::sqrt(part.covariance(r, r) * part.covariance(c, c));
        const auto& names = part.names;
        out["random_effects"].push_back(
            {{"group", part.group},
             {"effect", r == c ? names[std::size_t(r)]
                               : names[std::size_t(c)] + " with " + names[std::size_t(r)]},
             {"levels", part.levels.size()},
             {"covariance", own},
             {"standard_deviation", r == c ? Json(std::sqrt(own)) : Json()},
             {"correlation", r != c && scale > 0.0 ? Json(own / scale) : Json()}});
      }
  out["model"] = {{"variance_residual", fit.sigma_squared},
                  {"reml_criterion", fit.criterion},
                  {"parameters", fit.parameters}};
}

void add_predictions(const statistics::MixedModel& fit, Json& out) {
  out["group_effects"] = Json::array();
  for (const auto& part : fit.random) {
    if (part.levels.size() > kMostLevelsListed) continue;
    for (std::size_t level = 0; level < part.levels.size(); ++level)
      for (std::size_t e = 0; e < part.names.size(); ++e)
        out["group_effects"].push_back(
            {{"name", part.levels[level]},
             {"group", part.group},
             {"of", part.names[e]},
             {"effect", part.effects(Eigen::Index(level), Eigen::Index(e))}});
  }
}

Json notes_of(const statistics::MixedModel& fit) {
  Json out = Json::array();
  for (const auto& part : fit.random) {
    if (part.singular)
      out.push_back(
          fmt::format("singular: the data do not support all random effects of {} (a "
                      "variance of 0, or a correlation of 1); a simpler term says the "
                      "same",
                      part.group));
    if (part.levels.size() < 6)
      out.push_back(fmt::format("{} levels of {} say little about the spread between them",
                                part.levels.size(), part.group));
  }
  if (!fit.converged) out.push_back("the criterion's minimum was not reached to all digits");
  return out;
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
  std::vector<statistics::RandomTerm> terms;
  for (const auto& effects : of.formula.random) {
    auto term = TRY(random_term(of, effects));
    terms.push_back(std::move(term));
  }
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
  add_random_effects(*fit, out);
  add_predictions(*fit, out);
  const Vector residuals = residuals_of(problem, terms, *fit);
  out["checks"] = Json::array({normality_check(residuals)});
  out["notes"] = notes_of(*fit);
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
