#include "server/api/schema.hpp"

namespace tractus {
namespace api::schema {
namespace {
constexpr const char* kOptional =
    "x-optional";  // removed by object(): it is a property of the field

core::Json described(const char* type, std::string_view meaning) {
  return {{"type", type}, {"description", meaning}};
}
core::Json measured(const char* type, std::string_view unit, std::string_view meaning) {
  core::Json out = described(type, meaning);
  out["x-unit"] = unit;
  return out;
}
}  // namespace

core::Json object(const std::vector<Field>& fields) {
  core::Json properties = core::Json::object(), required = core::Json::array();
  for (auto [name, field] : fields) {
    if (!field.contains(kOptional)) required.push_back(name);
    field.erase(kOptional);
    properties[name] = std::move(field);
  }
  return {{"type", "object"},
          {"properties", properties},
          {"required", required},
          {"additionalProperties", false}};
}
core::Json text(std::string_view meaning) { return described("string", meaning); }
core::Json one_of(const std::vector<std::string>& values, std::string_view meaning) {
  core::Json out = text(meaning);
  out["enum"] = values;
  return out;
}
core::Json number(std::string_view unit, std::string_view meaning) {
  return measured("number", unit, meaning);
}
core::Json integer(std::string_view unit, std::string_view meaning) {
  return measured("integer", unit, meaning);
}
core::Json truth(std::string_view meaning) { return described("boolean", meaning); }
core::Json array(core::Json items, std::string_view meaning) {
  core::Json out = described("array", meaning);
  out["items"] = std::move(items);
  return out;
}
core::Json tuple(core::Json items, std::size_t size, std::string_view meaning) {
  core::Json out = array(std::move(items), meaning);
  out["minItems"] = out["maxItems"] = size;
  return out;
}
core::Json map(core::Json values, std::string_view meaning) {
  core::Json out = described("object", meaning);
  out["additionalProperties"] = std::move(values);
  return out;
}
core::Json nullable(core::Json inner) {
  return {{"anyOf", core::Json::array({std::move(inner), core::Json{{"type", "null"}}})}};
}
core::Json any_of(const std::vector<core::Json>& alternatives, std::string_view meaning) {
  return {{"anyOf", alternatives}, {"description", meaning}};
}
core::Json file_format(std::string_view name) {
  return one_of({std::string(name)}, "Name and version of the file format");
}
core::Json optional(core::Json inner) {
  inner[kOptional] = true;
  return inner;
}
core::Json anything(std::string_view meaning) {
  core::Json out = described("object", meaning);
  out["additionalProperties"] = true;
  return out;
}
core::Json ref(std::string_view name) {
  return {{"$ref", "#/components/schemas/" + std::string(name)}};
}

}  // namespace api::schema
}  // namespace tractus
