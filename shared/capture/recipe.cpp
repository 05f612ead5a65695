#include "capture/recipe.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "trial/measurement_set.hpp"

namespace tractus {
namespace capture {
namespace {
using core::Fields;
using core::Json;

/// What is wrong with a member that is an object, under its own pointer.
void pass_on(Fields& outer, const std::string& key, const Fields& inner) {
  const auto done = inner.done();
  if (done) return;
  std::string what = done.error().what;
  if (what.starts_with(inner.where())) what.erase(0, inner.where().size());
  const auto colon = what.find(": ");
  if (colon == std::string::npos) return outer.wrong(key.c_str(), what);
  outer.wrong((key + what.substr(0, colon)).c_str(), what.substr(colon + 2));
}

/// {"p_m":[…],"q":[w,x,y,z]}; either may be missing.
math::Pose pose_of(Fields& outer, const char* key) {
  math::Pose out;
  const Json* at = outer.member(key, false);
  if (!at) return out;
  Fields fields(*at, outer.where() + "/" + key);
  if (fields.has("p_m")) {
    const auto p = fields.numbers("p_m", 3);
    if (p.size() == 3) out.p = {p[0], p[1], p[2]};
  }
  if (fields.has("q")) {
    const auto q = fields.numbers("q", 4);
    if (q.size() == 4) out.q = {q[0], q[1], q[2], q[3]};
    if (std::abs(out.q.norm() - 1.0) > 0.01)
      fields.wrong("q", "a quaternion w, x, y, z of unit length is expected");
    else
      out.q.normalize();
  }
  pass_on(outer, key, fields);
  return out;
}

Carrier carrier_of(Fields& outer, const char* key, const char* frame) {
  Carrier out;
  const Json* at = outer.member(key);
  if (!at) return out;
  Fields fields(*at, outer.where() + "/" + key);
  out.body = fields.text("body", 256);
  out.X_BF = pose_of(fields, frame);
  if (const Json* markers = fields.member("markers_m", false); markers && markers->is_object())
    for (const auto& [name, p] : markers->items()) {
      if (!p.is_array() || p.size() != 3 || !p[0].is_number() || !p[1].is_number() ||
          !p[2].is_number()) {
        fields.wrong("markers_m", fmt::format("'{}': three numbers are expected", name));
        continue;
      }
      out.shape[name] = {p[0].get<double>(), p[1].get<double>(), p[2].get<double>()};
    }
  pass_on(outer, key, fields);
  return out;
}

ForceChannels channels_of(Fields& in) {
  ForceChannels out;
  const Json* names = in.member("channels", false);
  if (names && names->is_array())
    for (const Json& name : *names)
      if (name.is_string()) out.push_back(name.get<std::string>());
  if (out.size() != 6)
    in.wrong("channels", "six names of analog channels are expected: forces, then torques");
  return out;
}

std::filesystem::path within(Fields& fields, const char* key) {
  const std::filesystem::path path = fields.text(key, 1024);
  for (const auto& part : path)
    if (part == "..") fields.wrong(key, "leaves the recipe's folder");
  if (path.is_absolute()) fields.wrong(key, "a path relative to the recipe is expected");
  return path;
}

std::optional<double> maybe(Fields& fields, const char* key) {
  if (!fields.has(key)) return std::nullopt;
  return fields.number(key, -1e7, 1e7);
}

core::Result<Recording> recording_of(const Json& json, const std::string& where) {
  Fields fields(json, where);
  Recording out;
  out.id = fields.text("id", 128);
  out.operator_name = fields.text_or("operator", "");
  out.notes = fields.text_or("notes", "");
  out.motion = within(fields, "motion");
  out.force = within(fields, "force");
  out.rate_Hz = fields.number_or("rate_Hz", 0.0, 0.0, 1e4);
  out.offset_s = maybe(fields, "offset_s");
  out.from_s = maybe(fields, "from_s");
  out.to_s = maybe(fields, "to_s");
  if (out.id.empty()) fields.wrong("id", "is empty");
  TRY(fields.done());
  return out;
}
}  // namespace

core::Result<Recipe> Recipe::read(const std::filesystem::path& file) {
  auto json = TRY(core::read_json(file));
  Fields fields(json, file.string() + ": ");
  Recipe out;
  out.folder = file.parent_path();
  if (fields.text("format") != "tractus-assembly/1")
    fields.wrong("format", "tractus-assembly/1 is expected");
  if (fields.text("rig") != "palpation") fields.wrong("rig", "palpation is expected");
  if (fields.has("volume")) out.volume = within(fields, "volume");
  out.tool = carrier_of(fields, "tool", "X_BH");
  if (fields.has("bone")) out.bone = carrier_of(fields, "bone", "X_BV");
  if (const Json* sensor = fields.member("sensor", false)) {
    Fields in(*sensor, fields.where() + "/sensor");
    out.sensor.X_HS = pose_of(in, "X_HS");
    const std::string says = in.text_or("says", "on_probe");
    if (says != "on_probe" && says != "by_probe")
      in.wrong("says", "on_probe (what the bone does to the probe) or by_probe is expected");
    out.sensor.by_probe = says == "by_probe";
    if (in.has("channels")) out.sensor.channels = channels_of(in);
    pass_on(fields, "sensor", in);
  }
  out.taps = int(fields.integer_or("taps", 5, 3, 20));
  out.tip_z_m = fields.number_or("tip_z_m", out.tip_z_m, 0.0, 2.0);
  out.tare_s = fields.number_or("tare_s", out.tare_s, 0.05, 60.0);
  for (const char* key : trial::kStatedFields)
    if (const Json* said = fields.member(key, false)) out.stated[key] = *said;
  const Json* trials = fields.member("trials");
  if (trials && (!trials->is_array() || trials->empty()))
    fields.wrong("trials", "an array of recordings is expected");
  TRY(fields.done());
  for (std::size_t k = 0; k < trials->size(); ++k) {
    auto one = TRY(recording_of((*trials)[k], fmt::format("{}/trials/{}", fields.where(), k)));
    if (std::ranges::find(out.recordings, one.id, &Recording::id) != out.recordings.end())
      return core::Error{core::Errc::bad_input, fmt::format("{}/trials/{}/id: '{}' is there twice",
                                                            fields.where(), k, one.id)};
    out.recordings.push_back(std::move(one));
  }
  return out;
}

}  // namespace capture
}  // namespace tractus
