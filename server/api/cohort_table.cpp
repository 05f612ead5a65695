#include "server/api/cohort_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "assessment/method.hpp"
#include "core/bytes.hpp"
#include "db/store/cohort.hpp"
#include "metrics/metric.hpp"

namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::int64_t kMaxTrials = 20'000;
constexpr std::size_t kMaxFormula_bytes = 4096;

/// Without what would end a cell or a row, or be a formula to a spreadsheet; in quotes where it has
/// a comma.
std::string cell(std::string text) {
  if (!text.empty() && std::string("=+-@").find(text.front()) != std::string::npos)
    text.insert(text.begin(), '\'');
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
    if (c == '"') c = '\'';
  }
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

std::string cell(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

std::string row_of(const store::CohortTrial& trial, const std::vector<std::string>& metrics) {
  const auto& s = trial.summary;
  const bool in_study = !trial.study.empty();
  std::string out =
      fmt::format("{},{},{},{},{},{},{},{},{},{}", cell(s.id),
                  cell(in_study ? trial.participant : s.operator_name), cell(trial.study),
                  in_study ? std::to_string(trial.number) : "", cell(trial.level),
                  cell(trial.experience_years), cell(s.case_title), cell(trial.rig),
                  s.simulated ? 1 : 0, s.correct ? (*s.correct ? "1" : "0") : "");
  for (const auto& id : metrics) {
    const auto at = trial.metrics.find(id);
    out += ',' + (at == trial.metrics.end() ? "" : cell(std::optional(at->second)));
  }
  return out + '\n';
}

/// Metrics that any trial has, in the order of a trial's page; those of another version last.
std::vector<std::string> metrics_of(const std::vector<store::CohortTrial>& trials) {
  std::set<std::string> there;
  for (const auto& trial : trials)
    for (const auto& [id, _] : trial.metrics) there.insert(id);
  std::vector<std::string> out;
  for (const auto& info : metrics::all())
    if (there.erase(info.id) > 0) out.push_back(info.id);
  out.insert(out.end(), there.begin(), there.end());
  return out;
}

/// The trials that make a row; the others are counted.
std::vector<store::CohortTrial> counting(std::vector<store::CohortTrial> trials, CohortTable& out) {
  std::erase_if(trials, [&](const store::CohortTrial& trial) {
    const bool counts = trial.complete && (trial.study.empty() || trial.place == "counts");
    const bool scored = trial.summary.state == "assessed";
    if (!counts) ++out.invalid;
    if (counts && !scored) ++out.unscored;
    return !counts || !scored;
  });
  return trials;
}

Result<std::map<std::string, std::string>> options_of(const Json* json) {
  std::map<std::string, std::string> out;
  if (!json) return out;
  if (!json->is_object()) return Error{Errc::bad_input, "body: /options: should be an object"};
  for (const auto& [key, value] : json->items()) {
    if (!value.is_string() && !value.is_number())
      return Error{Errc::bad_input, "body: /options/" + key + ": should be a text or a number"};
    out.emplace(key, value.is_string() ? value.get<std::string>() : value.dump());
  }
  return out;
}

struct Asked {
  assessment::Method method;
  std::string formula, study;
  std::map<std::string, std::string> options;
};

Result<Asked> asked_from(const Json& json) {
  core::Fields fields(json, "body");
  const std::string method = fields.text("method", 64);
  Asked out;
  out.formula = fields.text_or("formula", "", kMaxFormula_bytes);
  out.study = fields.text_or("study", "", 64);
  auto options = options_of(fields.member("options", false));
  if (auto done = fields.done(); !done) return done.error();
  if (!options) return options.error();
  out.options = std::move(*options);
  auto known = assessment::method_named(method);
  if (!known) return Error{Errc::bad_input, "body: method: " + known.error().what};
  out.method = std::move(*known);
  if (out.method.formula.empty())
    return Error{Errc::bad_input, "body: method: " + method + " is of no data"};
  if (out.formula.empty())
    return Error{Errc::bad_input,
                 "body: formula: " + method + " needs one, as " + out.method.formula};
  return out;
}

}  // namespace

Result<CohortTable> cohort_table(Backend& backend, const std::string& study) {
  using Trials = std::vector<store::CohortTrial>;
  auto found = backend.store.read([&](store::Reading& tx) -> Result<Trials> {
    if (!study.empty()) {
      auto known = store::study_of(tx, study);
      if (!known) return known.error();
      if (!*known) return Error{Errc::bad_input, "study: there is no study " + study.substr(0, 32)};
    }
    return store::cohort_trials(tx, study, kMaxTrials);
  });
  if (!found) return found.error();
  CohortTable out;
  const auto trials = counting(std::move(*found), out);
  const auto metrics = metrics_of(trials);
  out.csv = "trial,participant,study,number,level,experience_years,case,rig,simulated,correct";
  for (const auto& id : metrics) out.csv += ',' + cell(id);
  out.csv += '\n';
  for (const auto& trial : trials) out.csv += row_of(trial, metrics);
  out.rows = trials.size();
  out.simulated = static_cast<std::size_t>(
      std::ranges::count_if(trials, [](const auto& trial) { return trial.summary.simulated; }));
  out.sha256 = core::sha256(core::bytes_of(out.csv));
  return out;
}

Result<Json> cohort_analysis(Backend& backend, const Json& asked) {
  const auto wanted = asked_from(asked);
  if (!wanted) return wanted.error();
  const auto made = cohort_table(backend, wanted->study);
  if (!made) return made.error();
  const auto bytes = core::bytes_of(made->csv);
  const auto table = assessment::Table::parse(core::Bytes(bytes.begin(), bytes.end()), "cohort", {},
                                              assessment::Missing::keep);
  if (!table) return table.error();
  auto found = assessment::run(wanted->method, *table, wanted->formula, wanted->options,
                               assessment::Missing::drop);
  if (!found) return found.error();
  return Json{{"method", wanted->method.id},
              {"formula", wanted->formula},
              {"study", wanted->study.empty() ? Json() : Json(wanted->study)},
              {"rows", made->rows},
              {"rows_simulated", made->simulated},
              {"left_out", {{"invalid", made->invalid}, {"unscored", made->unscored}}},
              {"sha256", made->sha256},
              {"report", std::move(found->report)}};
}

}  // namespace api
