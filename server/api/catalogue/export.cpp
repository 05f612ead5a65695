/// Research takes its data from here: tables and arrays by pseudonym.
#include "server/api/export.hpp"

#include "db/store/trials.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

http::Response csv_response(std::string csv, const char* name) {
  http::Response response{.status = 200, .headers = {}, .body = std::move(csv)};
  response.with("Content-Type", "text/csv; charset=utf-8")
      .with("Content-Disposition", std::string("attachment; filename=\"") + name + "\"")
      .with("Cache-Control", "no-store");
  return response;
}

std::string study_of_call(const Call& call) { return call.has("study") ? call.text("study") : ""; }

Result<http::Response> export_trials(const Call& call) {
  auto trials = trials_to_export(call.backend, study_of_call(call));
  if (!trials) return trials.error();
  return csv_response(trials_csv(*trials, Pseudonyms(call.backend.secrets)), "trials.csv");
}

Result<http::Response> export_scores(const Call& call) {
  auto trials = trials_to_export(call.backend, study_of_call(call));
  if (!trials) return trials.error();
  return csv_response(scores_csv(*trials, Pseudonyms(call.backend.secrets)), "scores.csv");
}

Result<http::Response> export_dictionary(const Call&) {
  return csv_response(dictionary_csv(), "dictionary.csv");
}

/// Only the key can tell which trial a pseudonym is: so the key is tried on all of them.
Result<http::Response> export_samples(const Call& call) {
  auto trials = trials_to_export(call.backend, "");
  if (!trials) return trials.error();
  const Pseudonyms names(call.backend.secrets);
  for (const auto& trial : *trials) {
    if (names.trial(trial.summary.id) != call.text("trial")) continue;
    auto record = call.backend.store.read(
        [&](store::Reading& tx) { return store::trial_of(tx, trial.summary.id); });
    if (!record) return record.error();
    auto array =
        samples_npy(call.backend.objects.path_of((*record)->sha256), call.number("rate_Hz"));
    if (!array) return array.error();
    http::Response response{.status = 200, .headers = {}, .body = std::move(*array)};
    response.with("Content-Type", "application/octet-stream")
        .with("Content-Disposition", "attachment; filename=\"samples.npy\"")
        .with("Cache-Control", "no-store");
    return response;
  }
  return Error{Errc::not_found, "no trial " + call.text("trial").substr(0, 32)};
}

RouteInfo route(std::string tail, std::string id, std::string summary,
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
                        .meaning = "trials of this study or assignment alone",
                        .required = false,
                        .fallback = std::nullopt};
  RouteInfo trials = route("trials.csv", "exportTrials",
                           "Trials as a tidy table, one row each, by pseudonym", export_trials);
  trials.parameters = {study};
  RouteInfo scores =
      route("scores.csv", "exportScores", "Scores as a tidy table, one row each", export_scores);
  scores.parameters = {study};
  RouteInfo dictionary =
      route("dictionary.csv", "exportDictionary",
            "Every column of the tables and arrays: type, unit, what it is", export_dictionary);
  RouteInfo samples =
      route("trials/{trial}/samples.npy", "exportSamples",
            "A trial's samples as an array of doubles (NumPy's .npy)", export_samples);
  samples.parameters = {path_text("trial", "as in trials.csv"),
                        {.in = Parameter::In::query,
                         .name = "rate_Hz",
                         .kind = Parameter::Kind::number,
                         .unit = "Hz",
                         .meaning = "rows a second; 0: every sample",
                         .low = 0,
                         .high = 10'000,
                         .fallback = "100"}};
  return {trials, scores, dictionary, samples};
}

}  // namespace api
