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

Json or_null(const std::optional<std::string>& text) { return text ? Json(*text) : Json(); }

/// {"add": […], "own": […]} as it was asked.
Json wish_of(const store::LabRun& run) {
  Json wish = core::stored_json(run.wish);
  if (!wish.is_object()) wish = Json::object();
  for (const char* key : {"add", "own"})
    if (!wish.contains(key)) wish[key] = Json::array();
  return wish;
}

/// What a run found; an older release kept a diagnosis alone.
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

core::Error absent(const char* what, const std::string& id) {
  return {core::Errc::not_found, fmt::format("no {} {} here", what, id.substr(0, 64))};
}

Json model_json(const store::ModelVersion& m) {
  return {{"id", m.id},
          {"name", m.name},
          {"rig", m.rig},
          {"note", m.note},
          {"parent", or_null(m.parent)},
          {"run", or_null(m.run)},
          {"made_utc_us", m.made_utc_us},
          {"made_by", m.made_by}};
}

Json set_json(const store::MeasurementSet& set) {
  return {{"id", set.id},
          {"name", set.name},
          {"rig", or_null(set.rig)},
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
           {"kind", run.kind},
           {"model", run.model_id},
           {"against", or_null(run.against_id)},
           {"measurements", run.set_id},
           {"add", wish["add"]},
           {"own", own},
           {"state", run.state},
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
    auto kept = TRY(core::read_json(call.backend.objects.path_of(*run.result)));
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
  return {{"ModelFile", anything("tractus-model/1")},
          {"ModelVersion", object({{"id", text("of this version, which never changes")},
                                   {"name", text("for people")},
                                   {"rig", one_of({"probing", "palpation"}, "that it is of")},
                                   {"note", text("why, in its maker's words")},
                                   {"parent", nullable(text("the version it was made from"))},
                                   {"run", nullable(text("of the lab that made it"))},
                                   {"made_utc_us", integer("us", "since 1970, UTC")},
                                   {"made_by", text("who")}})}};
}

std::vector<NamedSchema> lab_run_schemas() {
  using namespace schema;
  std::vector<NamedSchema> out = lab_answer_schemas();
  out.push_back(
      {"LabRun",
       object({{"id", text("of this run")},
               {"kind", one_of({"diagnosis", "comparison", "fit"}, "what was asked")},
               {"model", text("the version that is judged")},
               {"against", nullable(text("of a comparison: the other version"))},
               {"measurements", text("the set that judges")},
               {"add", array(text("id of an effect"), "of a fit: those added by hand")},
               {"own", array(text("expression:NAME"), "the user's own effects")},
               {"state",
                one_of({"queued", "running", "done", "failed", "cancelled"}, "how it stands")},
               {"share", number("1", "of the work done")},
               {"phase", text("what it is at, in words")},
               {"error", text("why it failed; else empty")},
               {"made_utc_us", integer("us", "since 1970, UTC")},
               {"made_by", text("who")},
               {"ranking",
                nullable(array(ref("RankedEffect"), "early, before effects are tried together"))},
               {"model_ready", truth("the better model can be fetched and published")},
               {"version", nullable(text("that was published from it"))},
               {"diagnosis", nullable(ref("Diagnosis"))},
               {"fit", nullable(ref("Fit"))},
               {"comparisons", nullable(object({{"before", ref("Comparison")},
                                                {"after", nullable(ref("Comparison"))}}))},
               {"tract_map", nullable(ref("TractMap"))}})});
  return out;
}

}  // namespace api
}  // namespace tractus
