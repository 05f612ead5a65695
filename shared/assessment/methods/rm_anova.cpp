/// Repeated-measures analysis of variance: within factors, and at most one between subjects.
#include "statistics/anova/rm_anova.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "assessment/pictures.hpp"
#include "assessment/report.hpp"
#include "core/try.hpp"
#include "statistics/anova/rm_factorial.hpp"
#include "statistics/summary/p_adjust.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;
using statistics::Vector;

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
      out.push_back({{"pair", cells.names[static_cast<std::size_t>(b)] + "-" +
                                  cells.names[static_cast<std::size_t>(a)]},
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

/// The columns of the formula: those that change within a subject, and the one that does not.
struct Roles {
  std::vector<std::string> within;
  std::string between;
};

core::Result<Roles> roles_of(const Analysis& of) {
  Roles out;
  const auto subjects = levels_of(of.table, of.formula.group);
  const auto who = places_of(of.table, of.formula.group, subjects);
  for (const auto& column : of.formula.factors()) {
    if (column == of.formula.group)
      return core::bad_input("the subject cannot be the levels as well");
    const auto& cells = of.table.texts(column);
    std::vector<std::string_view> first(subjects.size());
    bool constant = true;
    for (std::size_t i = 0; i < cells.size() && constant; ++i) {
      if (first[who[i]].empty()) first[who[i]] = cells[i];
      constant = first[who[i]] == cells[i];
    }
    if (!constant) {
      out.within.push_back(column);
    } else if (out.between.empty()) {
      out.between = column;
    } else {
      return core::bad_input(
          fmt::format("'{}' and '{}' both differ between subjects: rm-anova takes one "
                      "such column, lmm any number",
                      out.between, column));
    }
  }
  if (out.within.empty())
    return core::bad_input(fmt::format("{}: no column of the formula changes within a '{}'",
                                       of.table.name(), of.formula.group));
  // All products are analysed, so all must be asked for: otherwise lmm is meant.
  const std::size_t count = of.formula.factors().size();
  if (of.formula.terms.size() != (1u << count) - 1u)
    return core::bad_input("rm-anova analyses every interaction: join the columns with '*'");
  return out;
}

Json effect_row(const statistics::RmEffect& e, const std::string& name) {
  return {{"effect", name},
          {"F", e.f},
          {"df1", e.df1},
          {"df2", e.df2},
          {"p_greenhouse_geisser", e.p_gg},
          {"epsilon_greenhouse_geisser", e.epsilon_gg},
          {"p_huynh_feldt", e.p_hf},
          {"p_if_spherical", e.p},
          {"mauchly_p", e.mauchly.p},
          {"ss_effect", e.ss},
          {"ss_error", e.ss_error},
          {"partial_eta_squared", e.partial_eta_squared},
          {"generalized_eta_squared", e.generalized_eta_squared}};
}

/// The test to report: F on degrees of freedom shrunk by Greenhouse and Geisser's ε.
Json effect_test(const std::string& term, double f, double df1, double df2, double epsilon,
                 double p, double eta) {
  const double e = std::min(1.0, epsilon), none = std::nan("");
  return Test{term, "F", f, df1 * e, df2 * e, p, "generalised eta squared", eta, none, none}
      .to_json();
}

void add_sphericity(const std::string& name, const statistics::Mauchly& m, double epsilon,
                    Json& out) {
  if (std::isnan(m.w)) return;
  out["checks"].push_back(check_row(
      name + ": sphericity", fmt::format("Mauchly W = {:.4f}, epsilon {:.3f}", m.w, epsilon), m.p,
      "the Greenhouse-Geisser p is the one to report, whatever this says"));
}

core::Result<Findings> factorial(const Analysis& of, const Roles& roles, const Vector& y) {
  const auto cells = TRY(cells_of(of, roles.within, y));
  statistics::RmDesign design{cells.values, {}, {}};
  for (const auto& levels : cells.levels) design.levels.push_back(std::ssize(levels));
  if (!roles.between.empty()) {
    const auto groups = levels_of(of.table, roles.between);
    const auto group = places_of(of.table, roles.between, groups);
    const auto who = places_of(of.table, of.formula.group, cells.subjects);
    design.group.resize(cells.subjects.size());
    for (std::size_t i = 0; i < who.size(); ++i) design.group[who[i]] = group[i];
  }
  const auto effects = statistics::rm_factorial(design);
  if (!effects) return located(of, effects.error());
  Json out = report_head(of, "repeated-measures analysis of variance");
  const Vector means = cells.values.colwise().mean();
  out["cells"] = coefficient_table(cells.names, {{"mean", &means}});
  out["effects"] = out["tests"] = out["checks"] = Json::array();
  for (const auto& e : *effects) {
    std::vector<std::string> parts;
    if (e.with_group) parts.push_back(roles.between);
    for (const auto f : e.within) parts.push_back(roles.within[f]);
    const std::string name = fmt::format("{}", fmt::join(parts, ":"));
    out["effects"].push_back(effect_row(e, name));
    out["tests"].push_back(
        effect_test(name, e.f, e.df1, e.df2, e.epsilon_gg, e.p_gg, e.generalized_eta_squared));
    add_sphericity(name, e.mauchly, e.epsilon_gg, out);
  }
  out["notes"] = {fmt::format("{} subjects{}; type III sums of squares", cells.subjects.size(),
                              roles.between.empty() ? "" : ", '" + roles.between + "' between")};
  return Findings{std::move(out),
                  {profile_picture(cells.names, cells.values, of.formula.response)}};
}

core::Result<Findings> one_factor(const Analysis& of, const std::string& column, const Vector& y) {
  const auto cells = TRY(cells_of(of, {column}, y));
  const auto fit = statistics::rm_anova(cells.values);
  if (!fit) return located(of, fit.error());
  const auto trend = statistics::linear_trend(cells.values);
  Json out = report_head(of, "repeated-measures analysis of variance");
  out["levels"] = coefficient_table(cells.names, {{"mean", &fit->level_means}});
  out["analysis"] = {{"subjects", cells.subjects.size()},
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
  out["pairs"] = pair_table(cells);
  out["linear_trend"] = {
      {"estimate", trend.estimate}, {"t", trend.t}, {"df", trend.df}, {"p", trend.p}};
  out["tests"] = Json::array({effect_test(column, fit->f, fit->df1, fit->df2, fit->epsilon_gg,
                                          fit->p_gg, fit->generalized_eta_squared)});
  out["checks"] = Json::array();
  add_sphericity(column, fit->mauchly, fit->epsilon_gg, out);
  return Findings{std::move(out),
                  {profile_picture(cells.names, cells.values, of.formula.response)}};
}

core::Result<Findings> run_rm_anova(const Analysis& of) {
  if (of.formula.group.empty())
    return core::bad_input("rm-anova needs the subject: add (1|COLUMN) to the formula");
  if (of.formula.terms.empty() || !of.formula.trials.empty() || of.formula.trials_number != 1 ||
      !of.formula.intercept)
    return core::bad_input(
        "rm-anova compares the levels of columns: write y ~ a * b + (1|subject)");
  const auto roles = TRY(roles_of(of));
  const auto y = TRY(of.table.numbers(of.formula.response));
  if (roles.within.size() == 1 && roles.between.empty()) return one_factor(of, roles.within[0], y);
  return factorial(of, roles, y);
}

}  // namespace

namespace methods {
Method rm_anova_method() {
  return {"rm-anova",
          "Analysis of variance of repeated trials: within factors, one between",
          "velocity_m_s ~ scenario * repetition + (1|surgeon)",
          "repeated-measures analysis of variance with Greenhouse and Geisser's correction (type "
          "III sums of squares)",
          {},
          run_rm_anova};
}
}  // namespace methods
}  // namespace assessment
}  // namespace tractus
