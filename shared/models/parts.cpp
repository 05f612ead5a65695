#include "models/parts.hpp"

#include <fmt/format.h>

#include <algorithm>

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

Fault read_identity(Fields& fields, std::string_view rig, std::string& name) {
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

Fault read_fixed(Fields& fields, const Json& whole, std::vector<std::string>& fixed) {
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

Fault read_effects(Fields& fields) {
  const Json* list = fields.member("effects", false);
  if (!list || (list->is_array() && list->empty())) return std::nullopt;
  const std::string& where = fields.where();
  if (!list->is_array()) return bad(where, "effects", "an array is expected");
  const Json& first = (*list)[0];
  if (!first.is_object() || !first.contains("id") || !first["id"].is_string())
    return bad(where, "effects/0", "an object with a text \"id\" is expected");
  return bad(where, "effects/0/id",
             fmt::format("'{}' is an effect that this version does not know",
                         first["id"].get<std::string>()));
}

}  // namespace models
