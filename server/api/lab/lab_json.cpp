#include "server/api/lab/lab_json.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

/// {"add": […], "own": […]} of the request.
Json wish_of(const store::LabRun& run) {
  Json wish = core::stored_json(run.wish);
  if (!wish.is_object()) wish = Json::object();
  for (const char* key : {"add", "own"})
    if (!wish.contains(key)) wish[key] = Json::array();
  return wish;
}

/// The results of a run; an older release stored only the diagnosis.
Json found_json(Json kept) {
  Json out{
      {"diagnosis", nullptr}, {"fit", nullptr}, {"comparisons", nullptr}, {"tract_map", nullptr}};
  if (kept.contains("verdict"))
    out["diagnosis"] = std::move(kept);
  else
    out.update(kept);
  return out;
}

}  // namespace

Json model_json(const store::ModelVersion& m) {
  return {{"id", m.id},
          {"name", m.name},
          {"rig", m.rig},
          {"note", m.note},
          {"parent", core::or_null(m.parent)},
          {"run", core::or_null(m.run)},
          {"made_utc_us", m.made_utc_us},
          {"made_by", m.made_by}};
}

Json set_json(const store::MeasurementSet& set) {
  return {{"id", set.id},
          {"name", set.name},
          {"rig", core::or_null(set.rig)},
          {"simulated", set.simulated ? Json(*set.simulated) : Json()},
          {"trials", set.rig ? Json(set.trials) : Json()},
          {"samples", set.rig ? Json(set.samples) : Json()},
          {"size_bytes", set.size_bytes},
          {"made_utc_us", set.made_utc_us},
          {"made_by", set.made_by}};
}

Json own_effects(const store::LabRun& run) { return wish_of(run)["own"]; }

Json run_json(const store::LabRun& run, const std::optional<store::ModelVersion>& published) {
  const Json wish = wish_of(run);
  Json own = Json::array();
  for (const Json& effect : wish["own"]) own.push_back(effect.value("id", ""));
  Json out{{"id", run.id},
           {"kind", name(run.kind)},
           {"model", run.model_id},
           {"against", core::or_null(run.against_id)},
           {"measurements", run.set_id},
           {"add", wish["add"]},
           {"own", own},
           {"state", name(run.state)},
           {"share", run.share},
           {"phase", run.phase},
           {"error", run.error},
           {"made_utc_us", run.made_utc_us},
           {"made_by", run.made_by},
           {"ranking", nullptr},
           {"model_ready", run.model.has_value()},
           {"version", published ? Json(published->id) : Json()}};
  out.update(found_json(Json::object()));
  return out;
}

Result<Json> whole_run_json(const Call& call, const store::LabRun& run) {
  const auto published = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::model_made_by(tx, run.id); }));
  Json out = run_json(run, published);
  if (run.ranking) out["ranking"] = core::stored_json(*run.ranking);
  if (run.result) {
    auto kept = TRY(core::read_json(TRY(call.backend.objects.file(*run.result))));
    out.update(found_json(std::move(kept)));
  }
  return out;
}

RouteInfo lab_route(std::string method, std::string tail, std::string id, std::string summary,
                    std::string answer, Result<http::Response> (*handle)(const Call&)) {
  return research_route(std::move(method), "lab/" + tail, std::move(id), std::move(summary),
                        std::move(answer), handle);
}

Parameter optional_text(std::string name, std::string meaning) {
  return {.in = Parameter::In::query,
          .name = std::move(name),
          .kind = Parameter::Kind::text,
          .unit = "",
          .meaning = std::move(meaning),
          .required = false,
          .fallback = ""};
}

std::vector<NamedSchema> lab_model_schemas() {
  using namespace schema;
  std::vector<NamedSchema> out = lab_file_schemas();
  out.push_back(
      {"ModelVersion",
       object({{"id", text("Id of the version, which never changes")},
               {"name", text("Name of the model")},
               {"rig", one_of({"probing", "palpation"}, "Rig for which the model was made")},
               {"note", text("Note about the purpose of the version; empty if there is none")},
               {"parent",
                nullable(text(
                    "Id of the version from which this version was made; null if there is none"))},
               {"run", nullable(text(
                           "Id of the lab run that made the version; null for an uploaded model"))},
               {"made_utc_us",
                integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
               {"made_by", text("Name of the account that created the version")}})});
  return out;
}

std::vector<NamedSchema> lab_run_schemas() {
  using namespace schema;
  std::vector<NamedSchema> out = lab_answer_schemas();
  out.push_back(
      {"LabRun",
       object(
           {{"id", text("Id of the run")},
            {"kind", one_of<store::LabRunKind>("Kind of the run")},
            {"model", text("Id of the model version that is compared with the measurements")},
            {"against",
             nullable(
                 text("Id of the second model version of a comparison; null if there is none"))},
            {"measurements", text("Id of the measurement set")},
            {"add", array(text("Id of an effect"), "Effects that the user added to a fit")},
            {"own", array(text("Id of a user effect, expression:NAME"), "User effects of the run")},
            {"state", one_of<store::LabRunState>("State of the run")},
            {"share", number("1", "Completed share of the work, 0 to 1")},
            {"phase", text("Current step of the work in words")},
            {"error", text("Reason for the failure; empty if the run did not fail")},
            {"made_utc_us",
             integer("us", "Time of the request, in microseconds since 1970-01-01 UTC")},
            {"made_by", text("Name of the account that started the run")},
            {"ranking", nullable(array(ref("RankedEffect"),
                                       "Early ranking of the effects, before effects are tried "
                                       "together; null until it is known"))},
            {"model_ready", truth("True if the run made a model, which can be read and published")},
            {"version", nullable(text("Id of the model version that was published from the run; "
                                      "null if there is none"))},
            {"diagnosis", nullable(ref("Diagnosis"))},
            {"fit", nullable(ref("Fit"))},
            {"comparisons", nullable(object({{"before", ref("Comparison")},
                                             {"after", nullable(ref("Comparison"))}}))},
            {"tract_map", nullable(ref("TractMap"))}})});
  return out;
}

}  // namespace api
}  // namespace tractus
