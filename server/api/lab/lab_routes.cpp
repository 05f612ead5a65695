/// The model lab's stock: versions of models, measurement sets as zips, the catalogue of effects.
#include <fmt/format.h>

#include <array>
#include <fstream>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/lab/lab.hpp"
#include "lab/io/case.hpp"
#include "lab/io/catalogue.hpp"
#include "models/probing_model.hpp"
#include "server/api/backend.hpp"
#include "server/api/lab/lab_json.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxModel_bytes = 1 << 20, kMaxSet_bytes = 256 << 20,
                        kMaxEffect_bytes = 64 << 10;
constexpr std::size_t kMaxNote = 2000, kMaxName = 200;  // letters

Result<http::Response> list_models(const Call& call) {
  const auto models =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::all_models(tx); }));
  Json list = Json::array();
  for (const auto& model : models) list.push_back(model_json(model));
  return json_response({{"models", list}});
}

Result<void> check_parent(store::Reading& tx, const store::ModelVersion& version) {
  if (!version.parent) return {};
  const auto parent = TRY(store::model_of(tx, *version.parent));
  if (!parent) return absent("model", *version.parent);
  if (parent->rig != version.rig)
    return Error{Errc::bad_input,
                 fmt::format("parent: a model of the {} rig, but this one is of the {} rig",
                             parent->rig, version.rig)};
  return {};
}

Result<http::Response> add_model(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  const auto model = TRY(models::model_from_json(json, "body: "));
  store::ModelVersion version;
  version.id = core::new_id();
  version.name = std::visit([](const auto& m) { return m.name; }, model);
  version.rig = std::holds_alternative<models::ProbingModel>(model) ? "probing" : "palpation";
  if (!call.text("parent").empty()) version.parent = call.text("parent");
  version.note = call.text("note").substr(0, kMaxNote);
  version.made_utc_us = call.backend.now_utc_us();
  version.made_by = call.caller.name;
  const auto sha256 = TRY(call.backend.objects.put(core::bytes_of(call.request.body)));
  version.sha256 = sha256;
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(check_parent(tx, version));
    if (auto noted =
            store::add_object(tx, version.sha256, call.request.body.size(), version.made_utc_us);
        !noted)
      return noted;
    return store::add_model(tx, version);
  }));
  return json_response(model_json(version), 201);
}

Result<http::Response> model_file(const Call& call) {
  const auto model = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::model_of(tx, call.text("id")); }));
  if (!model) return absent("model", call.text("id"));
  return http::file_response(call.backend.objects.path_of(model->sha256), call.request,
                             "application/json");
}

Result<http::Response> list_sets(const Call& call) {
  const auto sets = TRY(
      call.backend.store.read([](store::Reading& tx) { return store::all_measurement_sets(tx); }));
  Json list = Json::array();
  for (const auto& set : sets) list.push_back(set_json(set));
  return json_response({{"measurements", list}});
}

/// Read whole; what is wrong is told before anything is kept.
Result<lab_io::SetFacts> checked(const std::filesystem::path& zip) {
  std::array<char, 2> first{};
  std::ifstream(zip, std::ios::binary).read(first.data(), first.size());
  if (std::string_view(first.data(), first.size()) != "PK")
    return Error{Errc::bad_input,
                 "the body is not a zip; a zip of a folder with set.json is expected"};
  return lab_io::facts_of_set(zip);
}

Result<http::Response> add_set(const Call& call) {
  auto scratch = TRY(core::ScratchFolder::make(call.backend.scratch->folder() / "set"));
  const auto zip = TRY(body_in(call, scratch.path(), "measurements.zip"));
  const auto facts = TRY(checked(zip));
  const auto sha256 = TRY(store::file_sha256(zip));
  TRY(call.backend.objects.copy_in(zip, sha256));
  const std::uint64_t size_bytes = std::filesystem::file_size(zip);
  const store::MeasurementSet set{sha256,
                                  call.text("name").substr(0, kMaxName),
                                  call.backend.now_utc_us(),
                                  call.caller.name,
                                  facts.rig,
                                  facts.simulated,
                                  facts.trials,
                                  facts.samples};
  auto kept = TRY(call.backend.store.write(
      [&](store::Writing& tx) -> Result<std::optional<store::MeasurementSet>> {
        TRY(store::add_object(tx, set.id, size_bytes, set.made_utc_us));
        TRY(store::add_measurement_set(tx, set));
        return store::measurement_set_of(tx, set.id);
      }));
  return json_response(set_json(kept.value()), 201);
}

Result<http::Response> list_effects(const Call& call) {
  const std::string& rig = call.text("rig");
  if (rig != "probing" && rig != "palpation")
    return Error{Errc::bad_input, "rig: probing or palpation is expected"};
  return json_response(lab_io::catalogue_json(rig));
}

Result<http::Response> check_effect(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  const auto effect = lab_io::own_effect_json({json, ""});
  return json_response({{"ok", bool(effect)},
                        {"error", effect ? std::string() : effect.error().what},
                        {"effect", effect ? *effect : Json()}});
}

std::vector<NamedSchema> set_schemas() {
  using namespace schema;
  return {
      {"Measurements", object({{"id", text("SHA-256 of the zip")},
                               {"name", text("for people")},
                               {"rig", nullable(one_of({"probing", "palpation"}, "that it is of"))},
                               {"simulated", nullable(truth("the set says that it is simulated"))},
                               {"trials", nullable(integer("1", "in it"))},
                               {"samples", nullable(integer("1", "in all trials"))},
                               {"size_bytes", integer("B", "of the zip")},
                               {"made_utc_us", integer("us", "since 1970, UTC")},
                               {"made_by", text("who")}})}};
}

std::vector<NamedSchema> effect_schemas() {
  using namespace schema;
  const Json parameter = object({{"name", text("as in model files")},
                                 {"unit", text("SI")},
                                 {"meaning", text("one sentence")},
                                 {"components", integer("1", "numbers of that name")},
                                 {"initial", number("its own", "where a fit begins")},
                                 {"low", number("its own", "least")},
                                 {"high", number("its own", "most")},
                                 {"off", nullable(number("its own", "where the effect vanishes"))},
                                 {"if_missing", nullable(number("its own", "if a file lacks it"))},
                                 {"logarithmic", truth("searched in its logarithm")}});
  const Json state = object(
      {{"name", text("in a formula")}, {"unit", text("SI")}, {"meaning", text("one sentence")}});
  return {
      {"Effect", object({{"id", text("in model files")},
                         {"rig", one_of({"probing", "palpation"}, "that it is of")},
                         {"kind", one_of({"force", "structure", "measurement"}, "what it acts on")},
                         {"summary", text("one line")},
                         {"equation", text("plain text")},
                         {"source", text("key of the bibliography, or own")},
                         {"needs", array(text("a column"), "that the recording must have")},
                         {"contains", array(text("an effect"), "simpler ones it has as a limit")},
                         {"free_per_trial", truth("its course differs from trial to trial")},
                         {"passive", truth("gives back no more work than it got")},
                         {"parameters", array(parameter, "its numbers")}})},
      {"EffectList", object({{"effects", array(ref("Effect"), "the rig's catalogue")},
                             {"adds_to", text("what a formula of one's own adds to")},
                             {"adds_unit", text("the unit that it must have")},
                             {"states", array(state, "what it may name")}})}};
}

}  // namespace

std::vector<RouteInfo> lab_routes() {
  using namespace schema;
  RouteInfo models = lab_route("GET", "models", "models", "Versions of models, newest first",
                               "ModelList", list_models);
  models.schemas = {
      {"ModelList", object({{"models", array(ref("ModelVersion"), "newest first")}})}};
  RouteInfo sets = lab_route("GET", "measurements", "measurementSets",
                             "Measurement sets, newest first", "MeasurementsList", list_sets);
  sets.schemas = {
      {"MeasurementsList", object({{"measurements", array(ref("Measurements"), "newest first")}})}};
  RouteInfo keep_set = taking(
      lab_route("POST", "measurements", "addMeasurements",
                "Read a measurement set whole and keep it: a zip of a folder with set.json; the "
                "same bytes are the same set",
                "Measurements", add_set),
      kBytes, kMaxSet_bytes, set_schemas());
  Parameter name = optional_text("name", "for people");
  name.required = true;
  name.fallback = std::nullopt;
  keep_set.parameters = {name};
  keep_set.body_to_file = true;
  RouteInfo keep_model =
      taking(lab_route("POST", "models", "addModel", "Keep a model as a new version",
                       "ModelVersion", add_model),
             "ModelFile", kMaxModel_bytes, lab_model_schemas());
  keep_model.parameters = {optional_text("parent", "the version it was made from"),
                           optional_text("note", "why, for people")};
  RouteInfo effects =
      lab_route("GET", "effects", "effects", "The catalogue of physical effects of a rig",
                "EffectList", list_effects);
  effects.parameters = {optional_text("rig", "probing or palpation")};
  effects.schemas = effect_schemas();
  return {models,
          keep_model,
          lab_route("GET", "models/{id}", "modelFile", "A version's file, byte for byte",
                    "ModelFile", model_file),
          sets,
          keep_set,
          effects,
          taking(lab_route("POST", "effects/check", "checkEffect",
                           "Is an effect of one's own well formed, do its units fit?",
                           "EffectCheck", check_effect),
                 "EffectFile", kMaxEffect_bytes,
                 {{"EffectFile", anything("tractus-effect/1")},
                  {"EffectCheck", object({{"ok", truth("it may be used")},
                                          {"error", text("what is wrong; else empty")},
                                          {"effect", nullable(ref("Effect"))}})}})};
}

}  // namespace api
}  // namespace tractus
