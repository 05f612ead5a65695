#include "cases/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"

namespace tractus {
namespace cases {
namespace {

using core::Errc;
using core::Error;
using core::Fields;
using core::Json;
using math::Vec3;

constexpr const char* kCaseFormat = "tractus-case/1";
constexpr const char* kPlanned = "planned";  // a channel: the bone is whole yet
constexpr const char* kTruthFormat = "tractus-truth/1";
constexpr std::size_t kMaxParts = 64;
constexpr double kFar_m = 100.0;  // a volume lies within this of its origin

Json json_of(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }

Vec3 vector(Fields& fields, const char* key) {
  const auto numbers = fields.numbers(key, 3);
  const Vec3 v(numbers[0], numbers[1], numbers[2]);
  if (!(v.norm() <= kFar_m)) fields.wrong(key, fmt::format("lies over {} m away", kFar_m));
  return v;
}

Vec3 direction(Fields& fields, const char* key) {
  const Vec3 v = vector(fields, key);
  if (std::abs(v.norm() - 1.0) > 1e-9) fields.wrong(key, "a unit vector is expected");
  return v;
}

void check_format(Fields& fields, const char* expected) {
  if (const auto format = fields.text("format"); format != expected)
    fields.wrong("format", fmt::format("'{}' is not known; '{}' is expected", format, expected));
}

core::Result<volume::Tract> read_tract(const Json& json, const std::string& where) {
  Fields fields(json, where);
  volume::Tract tract;
  tract.entry_m = vector(fields, "entry_m");
  tract.axis = direction(fields, "axis");
  tract.length_m = fields.number("length_m", 1e-4, 1.0);
  tract.radius_m = fields.number("radius_m", 1e-5, 0.1);
  tract.medial = direction(fields, "medial");
  tract.superior = direction(fields, "superior");
  const auto square = [](const Vec3& a, const Vec3& b) { return std::abs(a.dot(b)) < 1e-9; };
  if (!square(tract.medial, tract.axis))
    fields.wrong("medial", "must be perpendicular to the axis");
  if (!square(tract.superior, tract.axis) || !square(tract.superior, tract.medial))
    fields.wrong("superior", "must be perpendicular to the axis and to medial");
  TRY(fields.done());
  return tract;
}

/// Letters, digits, '.', '_' and '-', and not a name that means something else.
bool is_part_name(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
           c == '_' || c == '-';
  };
  return !name.empty() && name.size() <= 64 && name.front() != '.' &&
         std::ranges::all_of(name, plain) && name != "case.json" && name != "case.sig";
}

core::Result<Part> read_part(const Json& json, const std::string& where) {
  Fields fields(json, where);
  Part part;
  part.name = fields.text("name", 64);
  part.sha256 = fields.text("sha256", 64);
  part.size_bytes = std::uint64_t(fields.integer("size_bytes", 0, 1l << 42));
  if (const Json* secret = fields.member("secret")) {
    if (secret->is_boolean())
      part.secret = secret->get<bool>();
    else
      fields.wrong("secret", "true or false is expected");
  }
  if (!is_part_name(part.name))
    fields.wrong("name", fmt::format("'{}' is not the name of a part", part.name));
  if (!core::is_sha256(part.sha256)) fields.wrong("sha256", "64 characters 0-9a-f are expected");
  TRY(fields.done());
  return part;
}

core::Result<std::vector<Part>> read_parts(const Json& list, const std::string& where) {
  if (!list.is_array() || list.size() > kMaxParts)
    return Error{Errc::bad_input,
                 fmt::format("{}: an array of at most {} parts is expected", where, kMaxParts)};
  std::vector<Part> parts;
  for (std::size_t k = 0; k < list.size(); ++k) {
    auto part = TRY(read_part(list[k], fmt::format("{}/{}", where, k)));
    if (std::ranges::any_of(parts, [&](const Part& other) { return other.name == part.name; }))
      return Error{Errc::bad_input,
                   fmt::format("{}/{}/name: '{}' is there twice", where, k, part.name)};
    parts.push_back(std::move(part));
  }
  const auto has = [&](const char* name, bool secret) {
    return std::ranges::any_of(
        parts, [&](const Part& part) { return part.name == name && part.secret == secret; });
  };
  if (!has(kVolumePart, false))
    return Error{Errc::bad_input,
                 fmt::format("{}: an open part '{}' is expected", where, kVolumePart)};
  if (!has(kTruthPart, true))
    return Error{Errc::bad_input,
                 fmt::format("{}: a secret part '{}' is expected", where, kTruthPart)};
  return parts;
}

}  // namespace

Json Case::to_json() const {
  Json list = Json::array();
  for (const Part& part : parts)
    list.push_back({{"name", part.name},
                    {"sha256", part.sha256},
                    {"size_bytes", part.size_bytes},
                    {"secret", part.secret}});
  Json json = {{"format", kCaseFormat},
               {"title", title},
               {"source", source},
               {"made_utc_us", made_utc_us},
               {"tract",
                {{"entry_m", json_of(tract.entry_m)},
                 {"axis", json_of(tract.axis)},
                 {"length_m", tract.length_m},
                 {"radius_m", tract.radius_m},
                 {"medial", json_of(tract.medial)},
                 {"superior", json_of(tract.superior)}}},
               {"model", model.to_json()},
               {"parts", std::move(list)}};
  if (planned) json["channel"] = kPlanned;
  if (preparation != volume::Preparation::published)
    json["preparation"] = volume::name(preparation);
  if (certified) json["certified"] = *certified;
  return json;
}

core::Result<Case> Case::from_json(const Json& json, const std::string& where) {
  Fields fields(json, where);
  Case made;
  check_format(fields, kCaseFormat);
  made.title = fields.text("title");
  made.source = fields.text("source");
  made.made_utc_us = fields.integer("made_utc_us", 0, 1l << 60);
  const Json *tract = fields.member("tract"), *model = fields.member("model"),
             *parts = fields.member("parts");
  made.planned = fields.has("channel");
  if (made.planned && fields.text("channel") != kPlanned)
    fields.wrong("channel", "\"planned\" is expected, or no such field: then it is drilled");
  made.preparation = fields.word_or("preparation", volume::Preparation::published);
  if (const Json* certified = fields.member("certified", false)) {
    if (certified->is_boolean())
      made.certified = certified->get<bool>();
    else
      fields.wrong("certified", "true or false is expected");
  }
  TRY(fields.done());
  auto tract_read = TRY(read_tract(*tract, where + "/tract"));
  auto model_read = TRY(models::PalpationModel::from_json(*model, where + "/model"));
  auto parts_read = TRY(read_parts(*parts, where + "/parts"));
  made.tract = tract_read;
  made.model = std::move(model_read);
  made.parts = std::move(parts_read);
  return made;
}

Json Truth::to_json() const {
  Json json = {{"format", kTruthFormat}};
  json["breached"] = breached ? Json(std::string(volume::name(*breached))) : Json();
  json["breach_m"] = breach_m ? json_of(*breach_m) : Json();
  json["breach_depth_m"] = breach_depth_m;
  json["wall_thickness_m"] = wall_thickness_m;
  json["salt"] = salt_hex;
  return json;
}

core::Result<Truth> Truth::from_json(const Json& json, const std::string& where) {
  Fields fields(json, where);
  Truth truth;
  check_format(fields, kTruthFormat);
  const Json* breached = fields.member("breached");
  if (breached && !breached->is_null()) {
    const auto text = fields.text("breached");
    truth.breached = core::from_name<volume::Wall>(text);
    if (!truth.breached) fields.wrong("breached", fmt::format("'{}' is not a wall", text));
  }
  const Json* at = fields.member("breach_m");
  if (at && !at->is_null()) truth.breach_m = vector(fields, "breach_m");
  if (truth.breached.has_value() != truth.breach_m.has_value())
    fields.wrong("breach_m", "a place is expected with a breached wall, and only then");
  truth.breach_depth_m = fields.number("breach_depth_m", 0.0, 1.0);
  truth.wall_thickness_m = fields.number("wall_thickness_m", 0.0, 1.0);
  truth.salt_hex = fields.text("salt", 64);
  if (!core::is_sha256(truth.salt_hex)) fields.wrong("salt", "64 characters 0-9a-f are expected");
  TRY(fields.done());
  return truth;
}

}  // namespace cases
}  // namespace tractus
