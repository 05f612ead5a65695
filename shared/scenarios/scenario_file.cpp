// The file of a scenario, and the tuned ones that ship.
#include <fmt/format.h>

#include <limits>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "scenarios/scenario.hpp"
#include "scenarios/tuned.hpp"

namespace tractus {
namespace scenarios {
namespace {

using core::Errc;
using core::Error;
using core::Fields;
using core::Json;
using core::Result;

constexpr std::string_view kFormat = "tractus-scenario/1";

/// `Scenario::check` knows the ranges; here a number has only to be one.
double number(Fields& fields, const char* key, std::optional<double> fallback = std::nullopt) {
  constexpr double kAny = std::numeric_limits<double>::max();
  return fallback ? fields.number_or(key, *fallback, -kAny, kAny) : fields.number(key, -kAny, kAny);
}

Result<void> read_bone(const Json& json, const std::string& where, Bone& bone) {
  Fields fields(json, where + "/bone");
  bone = {number(fields, "stiffness_N_per_m"), number(fields, "damping_Ns_per_m"),
          number(fields, "equilibrium_m"), number(fields, "interval_m")};
  return fields.done();
}

Result<void> read_breach(const Json& json, const std::string& where, Breach& breach) {
  Fields fields(json, where + "/breach");
  breach = {number(fields, "resistance_interval_m"), number(fields, "resistance_factor_per_m"),
            number(fields, "breach_interval_m"), number(fields, "breach_damping_Ns_per_m")};
  return fields.done();
}

Result<void> read_rotary(const Json& json, const std::string& where, laws::RotaryStage& rotary) {
  Fields fields(json, where + "/rotary");
  rotary = {number(fields, "viscous_Nms_per_rad"), number(fields, "detent_Nm"),
            number(fields, "detent_pitch_rad")};
  return fields.done();
}

Result<void> read_origin(const Json& json, const std::string& where, Origin& origin) {
  Fields fields(json, where + "/origin");
  origin = {fields.text("who", 256), fields.text("when", 64), fields.text_or("parent", "", 64)};
  if (!origin.parent.empty() && !core::is_sha256(origin.parent))
    fields.wrong("parent", "64 characters 0-9a-f are expected");
  return fields.done();
}

Result<void> read_stretches(const Json& list, const std::string& where,
                            std::vector<DensityRegion>& out) {
  if (!list.is_array() || list.size() > 4096)
    return Error{Errc::bad_input, where + "/layers: an array of layers is expected"};
  for (std::size_t k = 0; k < list.size(); ++k) {
    Fields fields(list[k], fmt::format("{}/layers/{}", where, k));
    out.push_back(
        {number(fields, "start_m"), number(fields, "thickness_m"), number(fields, "density")});
    TRY(fields.done());
  }
  return {};
}

Result<void> read_walls(const Json& list, const std::string& where, std::vector<double>& out) {
  const Error bad{Errc::bad_input, where + "/walls_m: an array of depths is expected"};
  if (!list.is_array() || list.size() > 4096) return bad;
  for (const Json& wall : list) {
    if (!wall.is_number()) return bad;
    out.push_back(wall.get<double>());
  }
  return {};
}

/// The parts that are objects or lists, those of them that are there.
Result<void> read_parts(Fields& fields, Scenario& s) {
  const std::string& where = fields.where();
  if (const Json* json = fields.member("bone")) TRY(read_bone(*json, where, s.bone));
  if (const Json* json = fields.member("breach", !s.walls_m.empty()))
    TRY(read_breach(*json, where, s.breach));
  if (const Json* json = fields.member("layers", false))
    TRY(read_stretches(*json, where, s.layers));
  if (const Json* json = fields.member("rotary", false)) TRY(read_rotary(*json, where, s.rotary));
  if (const Json* json = fields.member("origin")) TRY(read_origin(*json, where, s.origin));
  return {};
}

}  // namespace

Result<Scenario> Scenario::from_json(const Json& json, const std::string& where) {
  Fields fields(json, where);
  if (!json.is_object()) return fields.done().error();
  Scenario s;
  if (const auto format = fields.text("format"); format != kFormat)
    fields.wrong("format", fmt::format("'{}' is not a format of scenarios; '{}' is expected",
                                       format, kFormat));
  s.name = fields.text("name", 256);
  s.kind = fields.word<Kind>("kind");
  s.density = number(fields, "density", 1.0);
  s.travel_m = number(fields, "travel_m");
  if (const Json* walls = fields.member("walls_m", false))
    TRY(read_walls(*walls, where, s.walls_m));
  TRY(read_parts(fields, s));
  TRY(fields.done());
  if (auto ok = s.expanded(); !ok) return Error{Errc::bad_input, where + ok.error().what};
  return s;
}

Result<Scenario> Scenario::read(const std::filesystem::path& path) {
  auto json = TRY(core::read_json(path));
  return from_json(json, path.string() + ": ");
}

Json Scenario::to_json() const {
  Json stretches = Json::array();
  for (const DensityRegion& stretch : layers)
    stretches.push_back({{"start_m", stretch.start_m},
                         {"thickness_m", stretch.thickness_m},
                         {"density", stretch.density}});
  return {{"format", kFormat},
          {"name", name},
          {"kind", scenarios::name(kind)},
          {"bone",
           {{"stiffness_N_per_m", bone.stiffness_N_per_m},
            {"damping_Ns_per_m", bone.damping_Ns_per_m},
            {"equilibrium_m", bone.equilibrium_m},
            {"interval_m", bone.interval_m}}},
          {"breach",
           {{"resistance_interval_m", breach.resistance_interval_m},
            {"resistance_factor_per_m", breach.resistance_factor_per_m},
            {"breach_interval_m", breach.breach_interval_m},
            {"breach_damping_Ns_per_m", breach.breach_damping_Ns_per_m}}},
          {"walls_m", walls_m},
          {"density", density},
          {"layers", std::move(stretches)},
          {"travel_m", travel_m},
          {"rotary",
           {{"viscous_Nms_per_rad", rotary.viscous_Nms_per_rad},
            {"detent_Nm", rotary.detent_Nm},
            {"detent_pitch_rad", rotary.detent_pitch_rad}}},
          {"origin", {{"who", origin.who}, {"when", origin.when}, {"parent", origin.parent}}}};
}

std::string Scenario::id() const {
  return core::sha256(
      core::bytes_of(to_json().dump(-1, ' ', true, Json::error_handler_t::replace)));
}

Result<Scenario> tuned(Kind kind) {
  const std::string file = fmt::format("tuned/{}.json", name(kind));
  auto json = TRY(core::parse_json(tuned_text(name(kind)), file));
  return Scenario::from_json(json, file + ": ");
}

}  // namespace scenarios
}  // namespace tractus
