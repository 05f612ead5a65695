#include "server/jobs/analyse.hpp"

#include <chrono>

#include "assessment/analyse.hpp"
#include "assessment/plan_page.hpp"
#include "assessment/snapshot.hpp"
#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/cohort/analyses.hpp"
#include "server/jobs/cohort_table.hpp"

namespace tractus {
namespace jobs {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::int64_t kMostTrials = 100'000;
constexpr std::uint64_t kMostData_bytes = 512ull << 20;
constexpr std::chrono::milliseconds kBetweenShares{500};  // two notes of the share

Result<store::AnalysisRun> asked_analysis(store::Store& store, const std::string& id) {
  const auto run = TRY(store.read([&](store::Reading& tx) { return store::analysis_of(tx, id); }));
  if (!run) return Error{Errc::not_found, "no analysis " + id.substr(0, 64)};
  return *run;
}

/// Puts a text among the objects and notes it there.
Result<std::string> keep(store::Store& store, const store::Objects& objects,
                         const std::string& text) {
  auto sha256 = TRY(objects.put(core::bytes_of(text)));
  TRY(store.write([&](store::Writing& tx) {
    return store::add_object(tx, sha256, text.size(), core::utc_us());
  }));
  return sha256;
}

std::string text_of(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

/// The snapshot of an earlier run, as it was frozen.
Result<assessment::Snapshot> kept_snapshot(const store::Objects& objects,
                                           const store::AnalysisRun& run) {
  auto description = TRY(core::read_json(TRY(objects.file(*run.description))));
  auto data = TRY(core::read_file(TRY(objects.file(*run.snapshot)), kMostData_bytes));
  if (core::sha256(data) != *run.snapshot)
    return Error{Errc::corrupt, "the frozen data were changed: their SHA-256 differs"};
  auto table = TRY(assessment::Table::parse(data, description["name"].get<std::string>(), {},
                                            assessment::Missing::keep));
  return assessment::Snapshot{std::move(description), std::move(data), std::move(table)};
}

/// The released trials, frozen.
Result<assessment::Snapshot> frozen_now(store::Store& store, const store::Objects& objects,
                                        const std::optional<store::PseudonymKey>& key,
                                        store::AnalysisRun& run) {
  const auto released = TRY(store.read([&](store::Reading& tx) {
    return store::ReleasedTrials::read(tx, key, {.study = run.study, .most = kMostTrials});
  }));
  const CohortTable made = cohort_table(released);
  if (made.rows == 0)
    return Error{Errc::bad_input, "there is no scored trial that is released for research"};
  const auto bytes = core::bytes_of(made.csv);
  auto snapshot = assessment::frozen(
      core::Bytes(bytes.begin(), bytes.end()),
      {.name = run.study.empty() ? "all trials of this server" : "study " + run.study,
       .utc = core::utc_text(core::utc_us()),
       .source = "the server's scored trials",
       .simulated = made.simulated > 0,
       .meanings = made.meanings});
  if (!snapshot) return snapshot.error();
  snapshot->description["rows_simulated"] = made.simulated;
  snapshot->description["left_out"] = {{"invalid", made.invalid},
                                       {"unscored", made.unscored},
                                       {"without_consent", made.without_consent},
                                       {"blind", made.blind}};
  auto data = TRY(keep(store, objects, made.csv));
  auto description = TRY(keep(store, objects, text_of(snapshot->description)));
  run.snapshot = data;
  run.description = description;
  TRY(store.write([&](store::Writing& tx) {
    return store::note_analysis_snapshot(tx, run.id, data, description, core::utc_us());
  }));
  return snapshot;
}

Result<assessment::Plan> plan_of(const store::Objects& objects, const store::AnalysisRun& run) {
  const auto json = TRY(core::read_json(TRY(objects.file(run.plan))));
  auto plan = assessment::Plan::from_json(json, "plan");
  if (!plan) return plan.error();
  if (run.plan_id) TRY(assessment::check_lock(*plan, "plan"));
  return plan;
}

Result<void> record(store::Store& store, const store::Objects& objects, store::AnalysisRun run,
                    const assessment::Snapshot& snapshot, const assessment::Analysed& analysed) {
  auto result = TRY(keep(store, objects, text_of(analysed.result)));
  auto report = TRY(keep(store, objects, assessment::report_page(analysed)));
  auto data =
      TRY(keep(store, objects, assessment::marked(snapshot.table, analysed.excluded_because)));
  run.result = result;
  run.report = report;
  run.data = data;
  return store.write(
      [&](store::Writing& tx) { return store::finish_analysis(tx, run, core::utc_us()); });
}

}  // namespace

Result<void> analyse(store::Store& store, const store::Objects& objects,
                     const std::optional<store::PseudonymKey>& key, const std::string& analysis_id,
                     const std::function<bool()>& ending) {
  auto run = TRY(asked_analysis(store, analysis_id));
  if (run.state != store::AnalysisState::queued && run.state != store::AnalysisState::running)
    return {};
  bool stopped = false;  // by a person
  const auto note = [&](double share) -> Result<void> {
    stopped = !TRY(store.write([&](store::Writing& tx) {
      return store::note_analysis_share(tx, run.id, share, core::utc_us());
    }));
    if (stopped) return Error{Errc::cancelled, "stopped"};
    return {};
  };
  TRY(note(0.0));
  const auto plan = TRY(plan_of(objects, run));
  const auto snapshot =
      TRY(run.snapshot ? kept_snapshot(objects, run) : frozen_now(store, objects, key, run));
  TRY(note(0.2));
  if (ending()) return Error{Errc::cancelled, "stopped"};
  const auto& d = snapshot.description;
  auto next = std::chrono::steady_clock::now();
  const auto analysed =
      TRY(assessment::analyse(plan, snapshot.table,
                              {d["name"], *run.snapshot, d["frozen_utc"], d.value("source", ""),
                               d.value("simulated", false)},
                              [&](double share) {
                                if (ending()) return false;
                                const auto now = std::chrono::steady_clock::now();
                                if (now < next) return true;
                                next = now + kBetweenShares;
                                // A share that could not be noted is noted with the next one.
                                (void)note(0.2 + 0.7 * share);
                                return !stopped;
                              }));
  // A plan goes on where one of its analyses cannot be done; a single question has no answer then.
  if (const auto& first = analysed.result["analyses"][0]; !run.plan_id && first.contains("error"))
    return Error{Errc::bad_input, first["error"].get<std::string>()};
  TRY(note(0.9));
  return record(store, objects, run, snapshot, analysed);
}

}  // namespace jobs
}  // namespace tractus
