#include "assessment/analyse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "assessment/methods_text.hpp"
#include "assessment/pictures.hpp"
#include "core/try.hpp"

namespace tractus {
namespace assessment {
namespace {

using core::Json;

struct Run {
  Json entry;
  std::vector<plot::Figure> figures;
};

core::Result<Findings> found_by(const PlannedAnalysis& one, const Table& table,
                                const core::Progress& progress) {
  const auto method = TRY(method_named(one.method));
  if (method.formula.empty()) return run(method, one.options, progress);
  if (!one.filter) return run(method, table, one.formula, one.options, Missing::drop, progress);
  const auto keeps = TRY(one.filter->rows_of(table));
  return run(method, table.filtered([&](std::size_t row) { return bool(keeps[row]); }), one.formula,
             one.options, Missing::drop, progress);
}

/// Errors: cancelled. What else goes wrong is part of the result.
core::Result<Run> run_one(const PlannedAnalysis& one, const Table& table,
                          const core::Progress& progress) {
  Run out{{{"id", one.id},
           {"question", one.question},
           {"family", one.family},
           {"method", one.method},
           {"formula", one.formula},
           {"where", one.where},
           {"options", one.options}},
          {}};
  auto found = found_by(one, table, progress);
  if (!found && found.error().code == core::Errc::cancelled) return found.error();
  if (!found) {
    out.entry["error"] = found.error().what;
    return out;
  }
  // Where the file lies is no part of the result.
  found->report.erase("file");
  out.entry["report"] = std::move(found->report);
  out.entry["figures"] = Json::array();
  for (const auto& figure : found->figures) out.entry["figures"].push_back(figure_json(figure));
  out.figures = std::move(found->figures);
  return out;
}

/// Why each row is left out; "" for those that stay.
core::Result<std::vector<std::string>> exclusions_of(const Plan& plan, const Table& table,
                                                     Json& counted) {
  std::vector<std::string> because(table.rows());
  for (const auto& exclusion : plan.exclusions) {
    const auto meets = TRY(exclusion.filter.rows_of(table));
    std::size_t rows = 0;
    for (std::size_t i = 0; i < because.size(); ++i)
      if (meets[i] && because[i].empty()) {
        because[i] = exclusion.reason;
        ++rows;
      }
    counted.push_back({{"where", exclusion.where}, {"reason", exclusion.reason}, {"rows", rows}});
  }
  if (std::ranges::none_of(because, [](const auto& why) { return why.empty(); }))
    return core::Error{core::Errc::bad_input, table.name() + ": the exclusions leave no row"};
  return because;
}

/// The tests an analysis brings to its family: those of its term, or all; one of p = 1 where it
/// could not be done.
Json tests_of(const PlannedAnalysis& one, const Json& entry) {
  Json out = Json::array();
  if (entry.contains("report") && entry["report"].contains("tests"))
    for (const auto& test : entry["report"]["tests"])
      if (one.term.empty() || test["term"] == one.term) {
        Json row = {{"analysis", one.id}};
        row.update(test);
        out.push_back(std::move(row));
      }
  if (out.empty())
    out.push_back(
        {{"analysis", one.id},
         {"term", one.term},
         {"p", 1.0},
         {"note", entry.contains("error") ? "could not be done: counts as p = 1"
                                          : "gives no test of this term: counts as p = 1"}});
  return out;
}

Json family_of(const Plan& plan, const std::string& name, const Json& analyses) {
  Json tests = Json::array();
  for (std::size_t i = 0; i < plan.analyses.size(); ++i)
    if (plan.analyses[i].family == name)
      for (auto& test : tests_of(plan.analyses[i], analyses[i])) tests.push_back(test);
  std::vector<double> p;
  for (const auto& test : tests) {
    const double one = test["p"].is_number() ? test["p"].get<double>() : 1.0;
    p.push_back(std::isfinite(one) ? one : 1.0);
  }
  const auto how = adjustment_named(plan.correction);
  const auto adjusted = how ? statistics::adjusted(p, *how) : p;
  for (std::size_t i = 0; i < tests.size(); ++i) {
    tests[i]["p_adjusted"] = adjusted[i];
    tests[i]["holds"] = adjusted[i] <= plan.alpha;
  }
  return {{"name", name}, {"correction", plan.correction}, {"alpha", plan.alpha}, {"tests", tests}};
}

Json families_of(const Plan& plan, const Json& analyses) {
  Json out = Json::array();
  std::set<std::string> done{""};
  for (const auto& one : plan.analyses)
    if (done.insert(one.family).second) out.push_back(family_of(plan, one.family, analyses));
  return out;
}

/// Our number at a place of an analysis' report; null when there is none.
Json number_at(const Json& analyses, const std::string& id, const std::string& at) {
  for (const auto& entry : analyses) {
    if (entry["id"] != id || !entry.contains("report")) continue;
    const Json::json_pointer pointer =
        at.starts_with('/') ? Json::json_pointer(at) : Json::json_pointer();
    if (!at.empty() && entry["report"].contains(pointer) && entry["report"][pointer].is_number())
      return entry["report"][pointer];
  }
  return nullptr;
}

Json published_of(const Plan& plan, const Json& analyses) {
  Json out = Json::array();
  for (const auto& one : plan.published) {
    Json row = {{"where", one.where}, {"says", one.says}};
    if (one.printed) {
      const Json ours = number_at(analyses, one.analysis, one.at);
      row["printed"] = *one.printed;
      row["computed"] = ours;
      row["agrees"] = ours.is_number() &&
                      std::abs(ours.get<double>() - *one.printed) <= one.within * (1.0 + 1e-9);
    }
    std::string remark = one.remark;
    for (std::size_t k = 0; k < one.numbers.size(); ++k) {
      const Json ours = number_at(analyses, one.numbers[k].first, one.numbers[k].second);
      const std::string mark = fmt::format("{{{}}}", k);
      const std::string value =
          ours.is_number() ? fmt::format("{:.4g}", ours.get<double>()) : "(not computed)";
      for (auto at = remark.find(mark); at != std::string::npos; at = remark.find(mark))
        remark.replace(at, mark.size(), value);
    }
    row["remark"] = remark;
    out.push_back(std::move(row));
  }
  return out;
}

std::size_t subjects_in(const Plan& plan, const Table& table) {
  return plan.subject.empty() || !table.has(plan.subject) ? 0
                                                          : levels_of(table, plan.subject).size();
}

Json head_of(const Plan& plan) {
  Json out = {{"title", plan.title},       {"question", plan.question},
              {"endpoint", plan.endpoint}, {"subject", plan.subject},
              {"alpha", plan.alpha},       {"correction", plan.correction},
              {"sha256", plan.sha256}};
  if (plan.lock)
    out["lock"] = {
        {"who", plan.lock->who}, {"utc", plan.lock->utc}, {"data_seen", plan.lock->data_seen}};
  return out;
}

}  // namespace

core::Result<Analysed> analyse(const Plan& plan, const Table& table, const Provenance& provenance,
                               const core::Progress& progress) {
  Json counted = Json::array();
  auto because = TRY(exclusions_of(plan, table, counted));
  const Table used = table.filtered([&](std::size_t row) { return because[row].empty(); });
  Analysed out{{{"format", "tractus-result/1"},
                {"plan", head_of(plan)},
                {"data",
                 {{"name", provenance.name},
                  {"sha256", provenance.sha256},
                  {"frozen_utc", provenance.frozen_utc},
                  {"source", provenance.source},
                  {"simulated", provenance.simulated},
                  {"rows", table.rows()},
                  {"rows_used", used.rows()},
                  {"subjects", subjects_in(plan, used)},
                  {"exclusions", counted}}},
                {"analyses", Json::array()}},
               {},
               std::move(because)};
  const double each = 1.0 / double(plan.analyses.size());
  for (const auto& one : plan.analyses) {
    const double before = each * double(out.figures.size());
    if (progress && !progress(before)) return core::Error{core::Errc::cancelled, "stopped"};
    auto run = TRY(run_one(
        one, used, [&](double share) { return !progress || progress(before + each * share); }));
    out.result["analyses"].push_back(std::move(run.entry));
    out.figures.push_back(std::move(run.figures));
  }
  out.result["families"] = families_of(plan, out.result["analyses"]);
  out.result["published"] = published_of(plan, out.result["analyses"]);
  out.result["methods"] = methods_sentences(plan, out.result);
  out.result["results"] = results_sentences(out.result);
  return out;
}

}  // namespace assessment
}  // namespace tractus
