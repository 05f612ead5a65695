#include "models/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "core/try.hpp"
#include "effects/palpation_effect.hpp"
#include "models/parts.hpp"

namespace tractus {
namespace models {
namespace {

using core::Errc;
using core::Error;
using core::Fields;
using core::Json;
using core::Result;
using Parameters = laws::PalpationParameters;

constexpr std::array<std::pair<volume::FieldKind, std::string_view>, 2> kFields{
    {{volume::FieldKind::paper, "paper"}, {volume::FieldKind::potential, "potential"}}};
constexpr std::size_t kMaxTransferPoints = 4096;

/// A number of /base: its name, where it is held, and what it may be.
struct BaseNumber {
  const char* key;
  double Parameters::*held;
  double low, high;
};
/// The ranges leave a decade or more around what an instrument can be, and keep out units mistaken
/// (mm, GPa).
constexpr std::array<BaseNumber, 7> kNumbers{{
    {"force_factor_Nm", &Parameters::force_factor_Nm, 0.0, 10.0},
    {"force_scale", &Parameters::force_scale, 0.0, 100.0},
    {"torque_scale", &Parameters::torque_scale, 0.0, 100.0},
    {"point_spacing_m", &Parameters::point_spacing_m, 1e-5, 0.2},
    {"youngs_modulus_Pa", &Parameters::youngs_modulus_Pa, 1e6, 1e13},
    {"length_m", &Parameters::length_m, 1e-3, 1.0},
    {"radius_m", &Parameters::radius_m, 1e-5, 0.05},
}};

OptionalError read_own_identity(Fields& fields, PalpationModel& model) {
  if (auto fault = read_identity(fields, "palpation", model.name)) return fault;
  model.volume = fields.text_or("volume", "");
  return std::nullopt;
}

OptionalError read_transfer(Fields& fields, PalpationModel& model) {
  if (!fields.has("transfer")) return std::nullopt;
  const std::string& where = fields.where();
  const Json& list = *fields.member("transfer");
  if (!list.is_array() || list.size() > kMaxTransferPoints)
    return bad(where, "transfer", "an array of points [CT value, opacity] is expected");
  std::vector<volume::TransferFunction::Point> points;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Json& point = list[k];
    if (!point.is_array() || point.size() != 2 || !point[0].is_number() || !point[1].is_number())
      return bad(where, fmt::format("transfer/{}", k),
                 "two numbers [CT value, opacity] are expected");
    points.push_back({point[0].get<double>(), point[1].get<double>()});
  }
  auto transfer = volume::TransferFunction::make(std::move(points));
  if (!transfer) return Error{transfer.error().code, where + "/" + transfer.error().what};
  model.transfer = std::move(*transfer);
  return std::nullopt;
}

OptionalError read_field_kind(Fields& base, PalpationModel& model) {
  const auto text = base.text_or("field", "paper");
  const auto known =
      std::ranges::find(kFields, std::string_view(text), &decltype(kFields)::value_type::second);
  if (known == kFields.end())
    return bad(base.where(), "field",
               fmt::format("'{}': 'paper' or 'potential' is expected", text));
  model.field = known->first;
  return std::nullopt;
}

OptionalError read_base(Fields& fields, PalpationModel& model) {
  const Json* object = fields.member("base");
  if (!object) return bad(fields.where(), "base", "is missing");
  Fields base(*object, fields.where() + "/base");
  Parameters& p = model.base;
  for (const BaseNumber& number : kNumbers)
    p.*number.held = base.number_or(number.key, p.*number.held, number.low, number.high);
  p.points = int(base.integer_or("points", p.points, 1, laws::kMaxPoints));
  if (base.has("pose_offset_m")) {
    const auto offset = base.numbers("pose_offset_m", 3);
    p.pose_offset_m = {offset[0], offset[1], offset[2]};
  }
  if (auto fault = read_field_kind(base, model)) return fault;
  TRY(base.done());
  if (p.pose_offset_m.norm() > 1.0)
    return bad(base.where(), "pose_offset_m", "is longer than 1 m; metres are expected");
  if (const double reach = (p.points - 1) * p.point_spacing_m; reach >= p.length_m)
    return bad(base.where(), "points",
               fmt::format("{} points {} m apart reach over {} m, the shank has {} m", p.points,
                           p.point_spacing_m, reach, p.length_m));
  return std::nullopt;
}

}  // namespace

core::Result<PalpationModel> PalpationModel::from_json(const Json& json, const std::string& where) {
  Fields fields(json, where);
  if (!json.is_object()) return fields.done().error();
  PalpationModel model;
  if (auto fault = read_own_identity(fields, model)) return *fault;
  if (auto fault = read_transfer(fields, model)) return *fault;
  if (auto fault = read_base(fields, model)) return *fault;
  if (auto fault = read_fixed(fields, model.to_json(), model.fixed)) return *fault;
  if (auto fault = read_effects(fields, effects::palpation_facts, model.effects)) return *fault;
  TRY(fields.done());
  return model;
}

core::Result<PalpationModel> PalpationModel::read(const std::filesystem::path& path) {
  auto json = TRY(core::read_json(path));
  return from_json(json, path.string() + ": ");
}

Json PalpationModel::to_json() const {
  Json json = {{"format", kModelFormat}, {"rig", "palpation"}, {"name", name}};
  if (!volume.empty()) json["volume"] = volume;
  json["transfer"] = Json::array();
  for (const auto& point : transfer.points())
    json["transfer"].push_back(Json::array({point.value, point.opacity}));
  json["base"] = {
      {"force_factor_Nm", base.force_factor_Nm},
      {"force_scale", base.force_scale},
      {"torque_scale", base.torque_scale},
      {"points", base.points},
      {"point_spacing_m", base.point_spacing_m},
      {"youngs_modulus_Pa", base.youngs_modulus_Pa},
      {"length_m", base.length_m},
      {"radius_m", base.radius_m},
      {"pose_offset_m", {base.pose_offset_m.x(), base.pose_offset_m.y(), base.pose_offset_m.z()}},
      {"field", field == volume::FieldKind::paper ? "paper" : "potential"}};
  json["fixed"] = fixed;
  json["effects"] = effects_to_json(effects, effects::palpation_facts);
  return json;
}

}  // namespace models
}  // namespace tractus
