#include "server/api/trials/rating_json.hpp"

#include <algorithm>

#include "core/try.hpp"
#include "db/store/studies/blinding.hpp"
#include "server/api/access.hpp"

namespace tractus::api {

std::vector<Grant> raters() {
  return {Role::admin, Role::director, {Role::faculty, Scope::cohort}};
}

core::Result<bool> sees_trial(store::Reading& tx, const Call& call, const std::string& trial_id) {
  const auto blinded = TRY(store::is_blinded(tx, trial_id));
  if (blinded) return false;
  return relates(tx, call.caller, call.of, Object::trial, trial_id);
}

core::Result<assessment::Rubric> stored_rubric(const store::RubricVersion& of) {
  return assessment::Rubric::from_json(core::stored_json(of.definition), "rubric " + of.id);
}

core::Result<store::RubricVersion> rubric_version(store::Reading& tx, const std::string& id,
                                                  std::int64_t version) {
  const auto versions = TRY(store::rubric_versions(tx, id));
  const auto found = std::ranges::find(versions, version, &store::RubricVersion::version);
  if (found == versions.end()) return absent("version of the rubric", id);
  return *found;
}

core::Result<core::Json> rubric_version_json(const store::RubricVersion& of) {
  const auto rubric = TRY(stored_rubric(of));
  return core::Json{{"id", of.id},          {"version", of.version},
                    {"title", of.title},    {"items", rubric.to_json()["items"]},
                    {"reason", of.reason},  {"made_utc_us", of.made_utc_us},
                    {"made_by", of.made_by}};
}

namespace {

/// An item as the server writes it; a file may lack what has a usual value.
std::vector<schema::Field> rubric_item_fields() {
  using namespace schema;
  return {{"label", text("Name of the item")},
          {"text", text("What is looked at; may be empty")},
          {"low", integer("1", "Low end of the scale, in points; default 1")},
          {"high", integer("1", "High end of the scale, in points; default 5")},
          {"low_text", text("Description of the low end")},
          {"middle_text", text("Description of the middle; may be empty")},
          {"high_text", text("Description of the high end")}};
}

core::Json rubric_file_schema() {
  using namespace schema;
  std::vector<Field> item = rubric_item_fields();
  for (auto& [name, field] : item)
    if (name == "text" || name == "low" || name == "high" || name == "middle_text")
      field = optional(field);
  return object({{"format", file_format("tractus-rubric/1")},
                 {"title", text("Title of the rubric")},
                 {"items", array(object(item), "Items in order, 1 to 30")}});
}

}  // namespace

std::vector<NamedSchema> rubric_schemas() {
  using namespace schema;
  return {
      {"RubricFile", rubric_file_schema()},
      {"RubricItem", object(rubric_item_fields())},
      {"RubricVersion",
       object({{"id", text("Id of the rubric, which never changes")},
               {"version", integer("1", "Number of the version, counted from 1")},
               {"title", text("Title of the rubric")},
               {"items", array(ref("RubricItem"), "Items in order")},
               {"reason", text("Reason of the change; empty if none was given")},
               {"made_utc_us",
                integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
               {"made_by", text("Name of the account that made the version")}})},
      {"RubricList",
       object({{"rubrics", array(ref("RubricVersion"), "All versions, by id, oldest first")}})}};
}

}  // namespace tractus::api
