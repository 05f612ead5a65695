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
  return http::file_response(TRY(call.backend.objects.file(model->sha256)), call.request,
                             "application/json");
}

Result<http::Response> list_sets(const Call& call) {
  const auto sets = TRY(
      call.backend.store.read([](store::Reading& tx) { return store::all_measurement_sets(tx); }));
  Json list = Json::array();
  for (const auto& set : sets) list.push_back(set_json(set));
  return json_response({{"measurements", list}});
}

/// Reads the whole set, so that errors are reported before anything is stored.
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
      {"Measurements",
       object(
           {{"id", text("Id of the measurement set, the SHA-256 of its zip file")},
            {"name", text("Name of the measurement set")},
            {"rig", nullable(one_of({"probing", "palpation"},
                                    "Rig on which the set was measured; null for a set that an "
                                    "older version stored"))},
            {"simulated",
             nullable(truth("True if the set states that its measurements are simulated; null for "
                            "a set that an older version stored"))},
            {"trials",
             nullable(integer(
                 "1", "Number of trials in the set; null for a set that an older version stored"))},
            {"samples",
             nullable(integer(
                 "1",
                 "Number of samples in all trials; null for a set that an older version stored"))},
            {"size_bytes", integer("B", "Size of the zip file, in bytes")},
            {"made_utc_us",
             integer("us", "Time of the upload, in microseconds since 1970-01-01 UTC")},
            {"made_by", text("Name of the account that uploaded the set")}})}};
}

std::vector<NamedSchema> effect_schemas() {
  using namespace schema;
  const Json parameter = object(
      {{"name", text("Name of the parameter in model files")},
       {"unit", text("SI unit of the parameter")},
       {"meaning", text("Meaning of the parameter, one sentence")},
       {"components", integer("1", "Number of components; 1 for a scalar")},
       {"initial", number("its own", "Start value of a fit, in the parameter's unit")},
       {"low", number("its own", "Smallest allowed value, in the parameter's unit")},
       {"high", number("its own", "Largest allowed value, in the parameter's unit")},
       {"off",
        nullable(number(
            "its own",
            "Value at which the effect vanishes, in the parameter's unit; null if there is none"))},
       {"if_missing", nullable(number("its own",
                                      "Value that is used if a model file lacks the parameter, in "
                                      "the parameter's unit; null if the parameter is required"))},
       {"logarithmic", truth("True if a fit searches the logarithm of the parameter")}});
  const Json state = object({{"name", text("Name of the variable in a formula")},
                             {"unit", text("SI unit of the variable")},
                             {"meaning", text("Meaning of the variable, one sentence")}});
  return {
      {"Effect",
       object({{"id", text("Id of the effect in model files")},
               {"rig", one_of({"probing", "palpation"}, "Rig to which the effect applies")},
               {"kind", one_of({"force", "structure", "measurement"},
                               "Part of the model on which the effect acts")},
               {"summary", text("Summary of the effect, one line")},
               {"equation", text("Equation of the effect, plain text")},
               {"source", text("Key of the source in the bibliography, or own")},
               {"needs", array(text("Name of a column"),
                               "Columns that a recording must have for this effect")},
               {"channel", nullable(text("Recorded channel that shows the effect, fz_N or tz_Nm; "
                                         "null on the palpation rig"))},
               {"contains",
                array(text("Id of an effect"), "Simpler effects that are limits of this effect")},
               {"free_per_trial", truth("True if the effect is estimated separately for each "
                                        "trial, for example sensor drift")},
               {"passive", truth("True if the effect never returns more work than it received")},
               {"parameters", array(parameter, "Parameters of the effect")}})},
      {"EffectList",
       object({{"effects", array(ref("Effect"), "Catalogue of the rig's effects")},
               {"adds_to", text("Quantity to which the formula of a user effect is added")},
               {"adds_unit", text("Unit that the formula of a user effect must have")},
               {"states", array(state, "Variables that the formula of a user effect may use")}})}};
}

}  // namespace

std::vector<RouteInfo> lab_routes() {
  using namespace schema;
  RouteInfo models =
      lab_route("GET", "models", "models", "List the versions of models, newest first", "ModelList",
                list_models);
  models.schemas = {
      {"ModelList",
       object({{"models", array(ref("ModelVersion"), "Versions of models, newest first")}})}};
  RouteInfo sets =
      lab_route("GET", "measurements", "measurementSets", "List the measurement sets, newest first",
                "MeasurementsList", list_sets);
  sets.schemas = {
      {"MeasurementsList",
       object({{"measurements", array(ref("Measurements"), "Measurement sets, newest first")}})}};
  RouteInfo keep_set =
      taking(lab_route("POST", "measurements", "addMeasurements",
                       "Upload a measurement set, a zip of a folder with set.json; the server "
                       "checks the whole set; the same bytes again give the same set",
                       "Measurements", add_set),
             kBytes, kMaxSet_bytes, set_schemas());
  Parameter name = optional_text("name", "Name of the measurement set");
  name.required = true;
  name.fallback = std::nullopt;
  keep_set.parameters = {name};
  keep_set.body_to_file = true;
  RouteInfo keep_model =
      taking(lab_route("POST", "models", "addModel", "Store a model as a new version",
                       "ModelVersion", add_model),
             "ModelFile", kMaxModel_bytes, lab_model_schemas());
  keep_model.parameters = {
      optional_text("parent", "Id of the version from which the model was made"),
      optional_text("note", "Note about the purpose of the version, at most 2000 characters")};
  RouteInfo effects =
      lab_route("GET", "effects", "effects", "List the catalogue of physical effects of a rig",
                "EffectList", list_effects);
  effects.parameters = {optional_text("rig", "Rig: probing or palpation")};
  effects.schemas = effect_schemas();
  return {
      models,
      keep_model,
      lab_route("GET", "models/{id}", "modelFile",
                "Read the file of a model version, byte for byte", "ModelFile", model_file),
      sets,
      keep_set,
      effects,
      taking(lab_route("POST", "effects/check", "checkEffect",
                       "Check whether a user effect is well formed and whether its units agree",
                       "EffectCheck", check_effect),
             "EffectFile", kMaxEffect_bytes,
             {{"EffectCheck",
               object({{"ok", truth("True if the effect is valid")},
                       {"error", text("Description of the error; empty if the effect is valid")},
                       {"effect", nullable(ref("Effect"))}})}})};
}

}  // namespace api
}  // namespace tractus
