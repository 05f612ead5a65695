/// Research takes its data from here: tables and arrays by pseudonym.
#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "server/api/cohort/cohort_zip.hpp"
#include "server/api/cohort/export.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/api/service.hpp"
#include "server/api/trials/samples_array.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using store::Tier;

http::Response csv_response(std::string csv, const char* name) {
  http::Response response{.status = 200, .headers = {}, .body = std::move(csv)};
  response.with("Content-Type", "text/csv; charset=utf-8")
      .with("Content-Disposition", std::string("attachment; filename=\"") + name + "\"")
      .with("Cache-Control", "no-store");
  return response;
}

std::string study_of_call(const Call& call) { return call.has("study") ? call.text("study") : ""; }

Result<http::Response> export_summary(const Call& call) {
  auto trials = TRY(released_trials(call.backend, study_of_call(call), Tier::summary));
  return csv_response(summary_csv(trials), "summary.csv");
}

Result<http::Response> table(const Call& call, const char* name,
                             std::string (*csv)(const store::ReleasedTrials&)) {
  auto trials = TRY(released_trials(call.backend, study_of_call(call), Tier::metrics));
  return csv_response(csv(trials), name);
}

Result<http::Response> export_trials(const Call& call) {
  return table(call, "trials.csv", trials_csv);
}

Result<http::Response> export_scores(const Call& call) {
  return table(call, "scores.csv", scores_csv);
}

Result<http::Response> export_dictionary(const Call&) {
  return csv_response(dictionary_csv(), "dictionary.csv");
}

Result<http::Response> samples_of(const Call& call, const std::string& sha256,
                                  std::uint64_t samples) {
  auto file =
      TRY(http::scratch_file(*call.backend.scratch, call.caller.id, samples_npy_bytes(samples)));
  TRY(write_samples_npy(TRY(call.backend.objects.file(sha256)), call.number("rate_Hz"),
                        file->path));
  return scratch_response(std::move(file), "application/octet-stream", "samples.npy");
}

/// A pseudonym can only be computed from a trial, not reversed: so the pseudonyms of all released
/// trials are computed and compared.
Result<http::Response> export_samples(const Call& call) {
  const double rate_Hz = call.number("rate_Hz");
  const bool reduced = rate_Hz > 0.0 && rate_Hz <= kReduced_Hz;
  auto trials = TRY(released_trials(call.backend, "", Tier::metrics));
  for (const store::ReleasedTrial& trial : trials.all()) {
    if (trial.id != call.text("trial")) continue;
    const auto file = TRY(trial.file(reduced ? Tier::reduced : Tier::full));
    return samples_of(call, file, trial.samples);
  }
  return Error{Errc::not_found, "no trial " + call.text("trial").substr(0, 32)};
}

Result<http::Response> export_cohort(const Call& call) {
  const auto tier = core::from_name<Tier>(call.text("tier"));
  if (!tier || *tier == Tier::none)
    return Error{Errc::bad_input, "tier: summary, metrics, reduced or full is expected"};
  return cohort_response(call.backend, {.study = study_of_call(call), .tier = *tier}, call.request,
                         [&backend = call.backend, head = http::RequestHead(call.request)] {
                           return still_allowed(backend, routes(), head);
                         });
}

/// Every export of this table is written into the audit trail.
Result<http::Response> export_key(const Call& call) {
  auto csv = TRY(key_csv(call.backend));
  const store::AuditedAction act{.who = call.caller.name,
                                 .role = std::string(name(call.caller.role)),
                                 .peer = call.request.peer,
                                 .what = "exportKey",
                                 .at_utc_us = call.backend.now_utc_us()};
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::add_act(tx, call.backend.store.audit_key(), act); }));
  return csv_response(std::move(csv), "key.csv");
}

RouteInfo export_route(std::string tail, std::string id, std::string summary,
                       Result<http::Response> (*handle)(const Call&)) {
  return {.method = "GET",
          .path = "/api/v1/export/" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::researcher},
          .parameters = {},
          .body = "",
          .answer = kBytes,
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> export_routes() {
  const Parameter study{.in = Parameter::In::query,
                        .name = "study",
                        .kind = Parameter::Kind::text,
                        .unit = "",
                        .meaning = "Only trials of the study or assignment with this id",
                        .required = false,
                        .fallback = std::nullopt};
  RouteInfo trials =
      export_route("trials.csv", "exportTrials",
                   "Export the released trials as a CSV table, one row per trial, with "
                   "pseudonyms in place of names",
                   export_trials);
  trials.parameters = {study};
  RouteInfo scores = export_route(
      "scores.csv", "exportScores",
      "Export the scores of the released trials as a CSV table, one row per score", export_scores);
  scores.parameters = {study};
  RouteInfo dictionary =
      export_route("dictionary.csv", "exportDictionary",
                   "Export the data dictionary: type, unit and meaning of every column "
                   "of the exported tables and arrays",
                   export_dictionary);
  RouteInfo samples =
      export_route("trials/{trial}/samples.npy", "exportSamples",
                   "Export the samples of one trial as an array of doubles in NumPy's .npy format",
                   export_samples);
  samples.parameters = {path_text("trial", "Pseudonym of the trial, from trials.csv"),
                        {.in = Parameter::In::query,
                         .name = "rate_Hz",
                         .kind = Parameter::Kind::number,
                         .unit = "Hz",
                         .meaning = "Number of rows per second, in Hz; 0: every sample",
                         .low = 0,
                         .high = 10'000,
                         .fallback = "100"}};
  RouteInfo summary = export_route(
      "summary.csv", "exportSummary",
      "Export the number of trials per person, study and rig as a CSV table", export_summary);
  summary.parameters = {study};
  RouteInfo cohort = export_route(
      "cohort.zip", "exportCohort",
      "Export a zip with tables, data dictionary and, for participants who "
      "consented to it, samples, of any size; it ends before its announced length if "
      "a consent is withdrawn meanwhile; the header If-Range with its ETag, and Range, "
      "resume it",
      export_cohort);
  cohort.lane = http::Lane::computing;
  cohort.parameters = {study,
                       {.in = Parameter::In::query,
                        .name = "tier",
                        .kind = Parameter::Kind::text,
                        .unit = "",
                        .meaning = "Consent tier up to which data are exported: summary, metrics, "
                                   "reduced (samples at 100 Hz) or full",
                        .required = false,
                        .fallback = "metrics"}};
  RouteInfo key =
      export_route("key.csv", "exportKey",
                   "Export the table that links pseudonyms with people; every export of this "
                   "table is written into the audit trail",
                   export_key);
  key.who = {Role::admin};
  return {summary, trials, scores, dictionary, samples, cohort, key};
}

}  // namespace api
}  // namespace tractus
