#include "models/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "core/try.hpp"
#include "effects/expression.hpp"

namespace tractus {
namespace models {

using core::Errc;
using core::Error;
using core::Fields;
using core::Json;

namespace {

constexpr std::size_t kMaxFixed = 256;

/// Does a pointer ("/base/pose_offset_m/*") lead to something in `json`? `*` stands for every
/// element of an array.
bool leads_somewhere(const Json& json, std::string_view pointer) {
  if (pointer.empty()) return true;
  if (pointer.front() != '/') return false;
  pointer.remove_prefix(1);
  const auto end = std::min(pointer.find('/'), pointer.size());
  const std::string_view step = pointer.substr(0, end), rest = pointer.substr(end);
  if (json.is_object()) {
    const auto it = json.find(std::string(step));
    return it != json.end() && leads_somewhere(*it, rest);
  }
  if (!json.is_array() || json.empty() || step.empty()) return false;
  if (step == "*")
    return std::ranges::all_of(json, [&](const Json& each) { return leads_somewhere(each, rest); });
  const bool digits =
      step.size() < 6 && std::ranges::all_of(step, [](char c) { return c >= '0' && c <= '9'; });
  if (!digits || (step.size() > 1 && step.front() == '0')) return false;
  const auto index = std::size_t(std::stoul(std::string(step)));
  return index < json.size() && leads_somewhere(json[index], rest);
}

}  // namespace

Error bad(const std::string& where, std::string_view key, const std::string& why) {
  return {Errc::bad_input, fmt::format("{}/{}: {}", where, key, why)};
}

OptionalError read_identity(Fields& fields, std::string_view rig, std::string& name) {
  const std::string& where = fields.where();
  if (const auto format = fields.text_or("format", ""); format != kModelFormat)
    return bad(
        where, "format",
        fmt::format("'{}' is not a format of models; '{}' is expected", format, kModelFormat));
  if (const auto found = fields.text_or("rig", ""); found != rig) {
    const bool other = found == "palpation" || found == "probing";
    return bad(where, "rig",
               fmt::format("'{}' is {}; '{}' is expected", found,
                           other ? "a model of the other rig" : "not a rig", rig));
  }
  name = fields.text("name");
  return std::nullopt;
}

OptionalError read_fixed(Fields& fields, const Json& whole, std::vector<std::string>& fixed) {
  if (!fields.has("fixed")) return std::nullopt;
  const std::string& where = fields.where();
  const Json& list = *fields.member("fixed");
  if (!list.is_array() || list.size() > kMaxFixed)
    return bad(where, "fixed", "an array of JSON pointers is expected, as [\"/base/length_m\"]");
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string key = fmt::format("fixed/{}", k);
    if (!list[k].is_string())
      return bad(where, key, "a JSON pointer is expected, as \"/base/length_m\"");
    const auto pointer = list[k].get<std::string>();
    if (!pointer.starts_with("/base/") || !leads_somewhere(whole, pointer))
      return bad(where, key, fmt::format("'{}' names no parameter of this model's base", pointer));
    fixed.push_back(pointer);
  }
  return std::nullopt;
}

namespace {

/// One parameter's numbers, appended to `values`.
void read_parameter(Fields& fields, const effects::Param& param, std::vector<double>& values) {
  const char* name = param.name.c_str();
  if (!std::isnan(param.if_missing) && !fields.has(name)) {
    fields.skip(name);
    values.insert(values.end(), std::size_t(param.components), param.if_missing);
    return;
  }
  if (param.components == 1) {
    values.push_back(fields.number(name, param.low, param.high));
    return;
  }
  for (const double value : fields.numbers(name, std::size_t(param.components))) {
    if (!(value >= param.low && value <= param.high))
      fields.wrong(name, fmt::format("{} is outside {} … {}", value, param.low, param.high));
    values.push_back(value);
  }
}

core::Result<effects::EffectInstance> read_use(const Json& json, const std::string& where,
                                               FactsOf facts_of) {
  if (!json.is_object() || !json.contains("id") || !json["id"].is_string())
    return Error{Errc::bad_input, where + ": an object with a text \"id\" is expected"};
  Fields fields(json, where);
  effects::EffectInstance use{fields.text("id"), {}};
  if (effects::is_expression(use.id)) {
    const Json* file = fields.member("expression");
    if (!file) return fields.done().error();
    use.definition = file->dump();
  }
  const auto facts = facts_of(use);
  if (!facts && facts.error().code == Errc::not_found)
    return bad(where, "id",
               fmt::format("'{}' is an effect that this version does not know", use.id));
  if (!facts)
    return Error{Errc::bad_input, fmt::format("{}/expression: {}", where, facts.error().what)};
  const Json none = Json::object();
  const Json* given = fields.member("parameters", !facts->params.empty());
  Fields numbers(given ? *given : none, where + "/parameters");
  if (given)
    for (const effects::Param& param : facts->params) read_parameter(numbers, param, use.values);
  TRY(fields.done());
  TRY(numbers.done());
  return use;
}

}  // namespace

OptionalError read_effects(Fields& fields, FactsOf facts_of,
                           std::vector<effects::EffectInstance>& uses) {
  const Json* list = fields.member("effects", false);
  if (!list) return std::nullopt;
  const std::string& where = fields.where();
  if (!list->is_array()) return bad(where, "effects", "an array is expected");
  for (std::size_t k = 0; k < list->size(); ++k) {
    auto use = TRY(read_use((*list)[k], fmt::format("{}/effects/{}", where, k), facts_of));
    if (std::ranges::find(uses, use.id, &effects::EffectInstance::id) != uses.end())
      return bad(where, fmt::format("effects/{}/id", k),
                 fmt::format("'{}' is in the list already", use.id));
    uses.push_back(std::move(use));
  }
  return std::nullopt;
}

Json effects_to_json(const std::vector<effects::EffectInstance>& uses, FactsOf facts_of) {
  Json list = Json::array();
  for (const effects::EffectInstance& use : uses) {
    const auto facts = facts_of(use);
    core::require(facts && use.values.size() == effects::value_count(*facts),
                  "a model's effects are known, with all their numbers");
    Json parameters = Json::object();
    auto next = use.values.begin();
    for (const effects::Param& param : facts->params) {
      if (param.components == 1)
        parameters[param.name] = *next;
      else
        parameters[param.name] = std::vector<double>(next, next + param.components);
      next += param.components;
    }
    Json one = {{"id", use.id}, {"parameters", std::move(parameters)}};
    if (!use.definition.empty()) one["expression"] = core::stored_json(use.definition);
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace models
}  // namespace tractus
