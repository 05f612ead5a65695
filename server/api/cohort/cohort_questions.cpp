#include "server/api/cohort/cohort_questions.hpp"

#include <fmt/format.h>

#include <set>

#include "assessment/method.hpp"
#include "assessment/plan.hpp"
#include "assessment/snapshot.hpp"
#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/csv.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/cohort/released.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/studies/studies.hpp"
#include "server/api/cohort/export.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::size_t kMostRow_bytes = 1 << 20;
constexpr std::size_t kMaxFormula_bytes = 4096;

/// A plan's file as an object, noted in `tx`.
Result<void> note_object(store::Writing& tx, const std::string& sha256, const std::string& text,
                         std::int64_t now) {
  return store::add_object(tx, sha256, text.size(), now);
}

/// {"method", "formula", "options"} as a plan of one analysis.
Result<Json> unplanned(core::Fields& fields) {
  Json one = {{"id", "question"}, {"method", fields.text("method", 64)}};
  const std::string formula = fields.text_or("formula", "", kMaxFormula_bytes);
  if (const Json* options = fields.member("options", false)) one["options"] = *options;
  TRY(fields.done());
  const auto method = assessment::method_named(one["method"].get<std::string>());
  if (!method) return core::bad_input("body: method: " + method.error().what);
  if (method->formula.empty())
    return core::bad_input("body: method: " + method->id +
                           " analyses no data: run it with tractus stats");
  if (formula.empty())
    return core::bad_input("body: formula: " + method->id + " needs a formula, for example " +
                           method->formula);
  one["formula"] = formula;
  one["question"] = method->summary;
  const Json plan = {{"format", "tractus-plan/1"},
                     {"title", formula},
                     {"question", "Asked without a plan: it may suggest, it confirms nothing."},
                     {"subject", "participant"},
                     {"analyses", Json::array({one})}};
  TRY(assessment::Plan::from_json(plan, "body"));
  return plan;
}

/// The data that an earlier analysis of this plan was of.
Result<void> take_snapshot(Backend& backend, const std::string& sha256, store::AnalysisRun& run) {
  const auto runs = TRY(backend.store.read(
      [&](store::Reading& tx) { return store::analyses_of_plan(tx, *run.plan_id); }));
  for (const auto& before : runs)
    if (before.snapshot == sha256) {
      run.snapshot = before.snapshot;
      run.description = before.description;
      return check_still_released(backend, run.study, sha256);
    }
  return core::bad_input("body: snapshot: no analysis of this plan used the data " +
                         sha256.substr(0, 64));
}

Result<void> of_plan(Backend& backend, core::Fields& fields, store::AnalysisRun& run) {
  const std::string id = fields.text("plan", 64);
  const std::string snapshot = fields.text_or("snapshot", "", 64);
  TRY(fields.done());
  const auto plan =
      TRY(backend.store.read([&](store::Reading& tx) { return store::analysis_plan_of(tx, id); }));
  if (!plan) return core::bad_input("body: plan: there is no plan " + id);
  run.plan_id = id;
  run.plan = plan->plan;
  run.study = plan->study;
  return snapshot.empty() ? Result<void>() : take_snapshot(backend, snapshot, run);
}

Result<void> of_method(Backend& backend, core::Fields& fields, store::AnalysisRun& run) {
  run.study = fields.text_or("study", "", 64);
  const auto plan = TRY(unplanned(fields));
  if (!run.study.empty()) {
    const auto known = TRY(backend.store.read(
        [&](store::Reading& tx) { return store::series_exists(tx, run.study); }));
    if (!known) return core::bad_input("body: study: there is no study " + run.study.substr(0, 32));
  }
  const std::string text = plan.dump();
  const auto kept = TRY(backend.objects.put(core::bytes_of(text)));
  run.plan = kept;
  return backend.store.write(
      [&](store::Writing& tx) { return note_object(tx, run.plan, text, run.made_utc_us); });
}

}  // namespace

Result<store::AnalysisPlan> locked_plan(Backend& backend, const Json& asked,
                                        const std::string& who) {
  core::Fields fields(asked, "body");
  const Json* json = fields.member("plan");
  store::AnalysisPlan out;
  out.study = fields.text_or("study", "", 64);
  const Json* seen = fields.member("data_seen", false);
  if (seen && !seen->is_boolean()) fields.wrong("data_seen", "true or false is expected");
  TRY(fields.done());
  const auto scored =
      backend.store.read([&](store::Reading& tx) { return store::scored_trials(tx, out.study); });
  if (!scored) return core::bad_input("body: " + scored.error().what);
  out.trials_then = *scored;
  out.data_seen = (seen && seen->get<bool>()) || out.trials_then > 0;
  out.id = core::new_id();
  out.made_utc_us = backend.now_utc_us();
  out.made_by = who;
  const auto locked = TRY(assessment::locked(
      *json, "body: /plan", {who, core::utc_text(out.made_utc_us), out.data_seen, ""}));
  out.title = locked["title"].get<std::string>().substr(0, 200);
  const std::string text = locked.dump(2);
  const auto kept = TRY(backend.objects.put(core::bytes_of(text)));
  out.plan = kept;
  TRY(backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(note_object(tx, out.plan, text, out.made_utc_us));
    return store::add_analysis_plan(tx, out);
  }));
  return out;
}

Result<store::AnalysisRun> queued_analysis(Backend& backend, const Json& asked,
                                           const std::string& who) {
  core::Fields fields(asked, "body");
  store::AnalysisRun run;
  run.id = core::new_id();
  run.made_utc_us = backend.now_utc_us();
  run.made_by = who;
  TRY(fields.has("plan") ? of_plan(backend, fields, run) : of_method(backend, fields, run));
  TRY(backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(store::add_analysis(tx, run));
    return store::queue_job(tx, store::JobKind::analysis, run.id, run.made_utc_us);
  }));
  return run;
}

Result<void> check_still_released(Backend& backend, const std::string& study,
                                  const std::string& data) {
  const auto released = TRY(released_trials(backend, study, store::Tier::metrics));
  std::set<std::string, std::less<>> ids;
  for (const auto& trial : released.all()) ids.insert(trial.id);
  auto rows = TRY(core::CsvReader::open(TRY(backend.objects.file(data)), kMostRow_bytes));
  std::vector<std::string_view> cells;
  std::size_t gone = 0;
  TRY(rows.next(cells));  // the header
  while (TRY(rows.next(cells))) gone += !ids.contains(cells.front());
  if (gone == 0) return {};
  return Error{Errc::forbidden, fmt::format("{} trials of these data are no longer released for "
                                            "research: analyse the current data instead",
                                            gone)};
}

Result<http::Response> dictionary_response(Backend& backend, const store::AnalysisRun& run) {
  const auto description = TRY(core::read_json(TRY(backend.objects.file(*run.description))));
  auto response = json_response(assessment::dictionary_of_marked(description));
  response.with("Content-Disposition", "attachment; filename=\"dictionary.json\"");
  return response;
}

}  // namespace api
}  // namespace tractus
