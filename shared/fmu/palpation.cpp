#include "fmu/palpation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/bytes.hpp"
#include "core/require.hpp"
#include "core/try.hpp"
#include "effects/palpation_effect.hpp"

namespace tractus {
namespace fmu {
namespace {

using core::Errc;
using core::Error;
using core::Fields;
using core::Json;
using core::Result;
using math::Vec3;

static_assert(std::endian::native == std::endian::little, "opacities are carried as they are");
constexpr const char* kFieldFormat = "tractus-field/1";

/// A number of the base, with what it means.
struct BaseMeaning {
  const char *name, *unit, *meaning;
};
constexpr std::array<BaseMeaning, 7> kBaseNumbers{{
    {"force_factor_Nm", "N·m", "c_f, from the field to the force on a contact point"},
    {"force_scale", "", "s_f, of the force that is felt"},
    {"torque_scale", "", "s_t, of the torque that is felt"},
    {"point_spacing_m", "m", "from contact point to contact point, along the shank"},
    {"youngs_modulus_Pa", "N/m²", "E, stiffness of the shank's material"},
    {"length_m", "m", "L, from the handle's origin to the tip"},
    {"radius_m", "m", "r, of the shank"},
}};

/// Three variables, "px_m" of "p{}_m".
void add_vector(const char* pattern, Causality causality, const char* unit, const char* meaning,
                std::vector<Variable>& out) {
  for (const char axis : {'x', 'y', 'z'})
    out.push_back({fmt::format(fmt::runtime(pattern), axis), causality, unit, meaning});
}

std::vector<Variable> palpation_motion_and_forces() {
  using enum Causality;
  std::vector<Variable> out;
  add_vector("p{}_m", input, "m",
             "position of the handle's origin in V, the volume's frame (of a CT: LPS)", out);
  for (const char part : {'w', 'x', 'y', 'z'})
    out.push_back({fmt::format("q{}", part), input, "",
                   "orientation of the handle's frame H in V, unit quaternion: p_V = p + q p_H q*; "
                   "z of H points along the shank to the tip",
                   part == 'w' ? 1.0 : 0.0});
  add_vector("v{}_m_s", input, "m/s", "velocity of the handle's origin, in V", out);
  add_vector("omega_{}_rad_s", input, "rad/s", "angular velocity of the handle, in V", out);
  add_vector("a{}_m_s2", input, "m/s²", "acceleration of the handle's origin, in V", out);
  add_vector("alpha_{}_rad_s2", input, "rad/s²", "angular acceleration of the handle, in V", out);
  add_vector("f{}_N", output, "N", "force of the bone on the probe, in H", out);
  add_vector("t{}_Nm", output, "N·m",
             "torque of the bone on the probe about the handle's origin, in H", out);
  for (const char axis : {'x', 'y'})
    out.push_back({fmt::format("deflection_{}_m", axis), output, "m",
                   "deflection of the tip from the unbent shank, in H"});
  out.push_back({"converged", output, "", "1 where the shank's equilibrium was reached, else 0"});
  return out;
}

void add_components(const std::string& name, const Json& numbers, const char* unit,
                    const char* meaning, const std::string& pointer, std::vector<Variable>& out) {
  Variable v{name, Causality::parameter, unit, meaning};
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    v.name = fmt::format("{}[{}]", name, i + 1);
    v.start = numbers[i].get<double>();
    if (!pointer.empty()) v.pointer = fmt::format("{}/{}", pointer, i);
    out.push_back(v);
  }
}

Vec3 three(std::span<const double> values, PalpationPlace from) {
  return Vec3(values[std::size_t(from)], values[std::size_t(from) + 1],
              values[std::size_t(from) + 2]);
}

Json array_of(const Vec3& v) { return Json::array({v.x(), v.y(), v.z()}); }
Vec3 vector_of(const std::vector<double>& v, std::size_t from = 0) {
  return Vec3(v[from], v[from + 1], v[from + 2]);
}

/// Three whole numbers; a wrong one is noted in `fields`.
std::array<int, 3> indices(Fields& fields, const char* key, int high) {
  std::array<int, 3> out{};
  const auto numbers = fields.numbers(key, 3);
  for (std::size_t a = 0; a < 3; ++a) {
    if (numbers[a] >= 0 && numbers[a] <= high && numbers[a] == std::floor(numbers[a]))
      out[a] = int(numbers[a]);
    else
      fields.wrong(key, fmt::format("{}: a whole number in 0 … {} is expected", numbers[a], high));
  }
  return out;
}

constexpr int kMostAlong = 1 << 20;

Result<volume::Geometry> read_geometry(const Json& json, const std::string& where) {
  Fields fields(json, where);
  volume::Geometry g;
  g.dims = indices(fields, "dims", kMostAlong);
  g.spacing_m = vector_of(fields.numbers("spacing_m", 3));
  g.origin_m = vector_of(fields.numbers("origin_m", 3));
  const auto directions = fields.numbers("directions", 9);
  for (int axis = 0; axis < 3; ++axis)
    g.directions.col(axis) = vector_of(directions, std::size_t(3 * axis));
  TRY(fields.done());
  return g;
}

}  // namespace

std::vector<Variable> variables(const models::PalpationModel& model, const Vec3& down) {
  auto out = palpation_motion_and_forces();
  core::require(out.size() == std::size_t(PalpationPlace::down), "places are the variables'");
  add_components("down", array_of(down), "", "direction of gravity in V, of any length", "", out);
  const Json base = model.to_json()["base"];
  for (const BaseMeaning& n : kBaseNumbers)
    out.push_back({std::string("base.") + n.name, Causality::parameter, n.unit, n.meaning,
                   base[n.name].get<double>(), -std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity(), std::string("/base/") + n.name});
  add_components("base.pose_offset_m", base["pose_offset_m"], "m",
                 "added to the handle's position, in V", "/base/pose_offset_m", out);
  for (std::size_t k = 0; k < model.effects.size(); ++k) {
    const auto facts = effects::palpation_facts(model.effects[k]);
    core::require(bool(facts), "a model's effects were checked as it was read");
    if (facts->free_per_trial) continue;  // no model knows it, and no replay adds it
    const std::size_t first = out.size();
    add_effect(model.effects[k], *facts, k, out);
    if (facts->is_delay) out[first].low = 0.0;  // the motion to come is not known
  }
  return out;
}

Result<PalpationNumbers> with_parameters(const models::PalpationModel& model,
                                         std::span<const Variable> variables,
                                         std::span<const double> values) {
  const Vec3 down = three(values, PalpationPlace::down);
  if (!(down.norm() > 0.0 && std::isfinite(down.norm())))
    return Error{Errc::out_of_range, "down: (0, 0, 0), a direction is expected"};
  auto changed = TRY(models::PalpationModel::from_json(
      with_values(model.to_json(), variables, values), "parameters: "));
  for (const effects::EffectInstance& use : changed.effects) {
    const auto facts = TRY(effects::palpation_facts(use));
    if (facts.is_delay && use.values[0] < 0.0)
      return Error{Errc::out_of_range,
                   fmt::format("{}: a delay of {} s: an FMU does not know the motion to come; at "
                               "least 0 is expected",
                               use.id, use.values[0])};
  }
  // One that has unit length to rounding stays as it is, so that forces are those of a replay to the last bit.
  const bool unit = std::abs(down.squaredNorm() - 1.0) < 1e-14;
  return PalpationNumbers{std::move(changed), unit ? down : Vec3(down.normalized())};
}

std::string carried_text(models::PalpationModel model) {
  model.volume.clear();
  return model.to_json().dump(1) + "\n";
}

core::ByteView opacity_bytes(const CarriedField& field) {
  return std::as_bytes(std::span(field.part.opacity));
}

std::string field_text(const CarriedField& field) {
  const volume::Geometry& g = field.part.geometry;
  Json directions = Json::array();  // of i, then j, then k
  for (int axis = 0; axis < 3; ++axis)
    for (int c = 0; c < 3; ++c) directions.push_back(g.directions(c, axis));
  const Json json = {{"format", kFieldFormat},
                     {"volume",
                      {{"dims", g.dims},
                       {"spacing_m", array_of(g.spacing_m)},
                       {"origin_m", array_of(g.origin_m)},
                       {"directions", directions}}},
                     {"begin", field.part.box.begin},
                     {"end", field.part.box.end},
                     {"down", array_of(field.down)},
                     {"opacity_sha256", core::sha256(opacity_bytes(field))}};
  return json.dump(1) + "\n";
}

Result<CarriedField> read_field(std::string_view text, core::ByteView opacities,
                                const std::string& where) {
  const Json json = TRY(core::parse_json(text, where));
  Fields fields(json, where);
  CarriedField out;
  if (fields.text("format") != kFieldFormat)
    return Error{Errc::bad_input, fmt::format("{}format: {} is expected", where, kFieldFormat)};
  const Json* geometry = fields.member("volume");
  out.part.box = {indices(fields, "begin", kMostAlong), indices(fields, "end", kMostAlong)};
  out.down = vector_of(fields.numbers("down", 3));
  const std::string digest = fields.text("opacity_sha256");
  TRY(fields.done());
  out.part.geometry = TRY(read_geometry(*geometry, where + "/volume"));
  if (core::sha256(opacities) != digest)
    return Error{
        Errc::corrupt,
        fmt::format("{}opacity_sha256: the {} bytes of opacities are not those of the export",
                    where, opacities.size())};
  out.part.opacity.resize(opacities.size() / sizeof(float));
  std::memcpy(out.part.opacity.data(), opacities.data(), opacities.size());
  return out;
}

}  // namespace fmu
}  // namespace tractus
