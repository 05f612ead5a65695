#include "server/api/cases/tract_plan.hpp"

#include <cmath>

namespace tractus {
namespace api {
namespace {

using core::Json;

Json numbers(const math::Vec3& p) { return Json::array({p.x(), p.y(), p.z()}); }

Json tract_of(const volume::Tract& tract) {
  return {{"entry_m", numbers(tract.entry_m)}, {"axis", numbers(tract.axis)},
          {"length_m", tract.length_m},        {"radius_m", tract.radius_m},
          {"medial", numbers(tract.medial)},   {"superior", numbers(tract.superior)}};
}

/// One wall along the tract: null where it cannot be found.
Json wall_json(const volume::WallFinder& finder, const volume::Tract& tract, volume::Wall wall,
               const core::Result<volume::WallFound>& thinnest) {
  Json depths = Json::array(), inner = Json::array(), thickness = Json::array();
  const auto add = [&](double at_m) {
    const auto found = finder.wall_at(tract, wall, at_m);
    depths.push_back(at_m);
    inner.push_back(found ? Json(found->inner_m) : Json());
    thickness.push_back(found ? Json(found->thickness_m()) : Json());
  };
  if (wall == volume::Wall::anterior)
    add(tract.length_m);
  else
    for (double at = 0.0; at <= tract.length_m; at += kWallStep_m) add(at);
  return {{"wall", volume::name(wall)},
          {"depth_m", depths},
          {"inner_m", inner},
          {"thickness_m", thickness},
          {"thinnest", thinnest ? Json{{"at_m", thinnest->at_m},
                                       {"inner_m", thinnest->inner_m},
                                       {"thickness_m", thinnest->thickness_m()}}
                                : Json()}};
}

/// To a tenth of a millimetre: it is looked at.
Json envelope_json(const volume::OuterFace& face) {
  if (face.points_m.empty()) return Json();
  Json points = Json::array();
  const auto rounded = [](double x_m) { return std::round(x_m * 1e4) / 1e4; };
  for (const auto& p : face.points_m)
    points.push_back({rounded(p.x()), rounded(p.y()), rounded(p.z())});
  return {{"around", face.around}, {"points_m", std::move(points)}};
}

Json calibration_json(const volume::Calibration& found) {
  return {{"air_HU", core::or_null(found.air)},
          {"fat_HU", core::or_null(found.fat)},
          {"soft_tissue_HU", core::or_null(found.soft_tissue)},
          {"cancellous_HU", core::or_null(found.cancellous)},
          {"cortical_HU", core::or_null(found.cortical)},
          {"cortex_m", core::or_null(found.cortex_m)}};
}

/// No tract, and of filled bone the outer face that was found all the same: it shows what to mark.
Json refused_json(const volume::Volume& ct, const volume::TransferFunction& transfer,
                  const cases::CarvingPlan& plan, const std::string& problem) {
  Json out = no_tract_json(plan, problem);
  if (plan.preparation != volume::Preparation::filled) return out;
  const auto tract = cases::planned_tract(ct, transfer, plan);
  if (!tract) return out;
  const auto face = volume::outer_face_about(ct, *tract, plan.envelope_marks);
  if (face) out["envelope"] = envelope_json(*face);
  return out;
}

Json breach_json(const volume::Breach& breach) {
  return {
      {"wall", volume::name(breach.wall.wall)}, {"at_m", breach.wall.at_m},
      {"breach_m", numbers(breach.centre_m)},   {"from_m", numbers(breach.from_m)},
      {"tip_m", numbers(breach.tip_m)},         {"depth_m", breach.depth_m},
      {"inner_m", breach.wall.inner_m},         {"wall_thickness_m", breach.wall.thickness_m()}};
}

}  // namespace

Json no_tract_json(const cases::CarvingPlan& plan, const std::string& problem) {
  return {{"length_m", (plan.target_m - plan.entry_m).norm()},
          {"side", Json()},
          {"tract", Json()},
          {"walls", Json::array()},
          {"breach", Json()},
          {"problems", Json::array({problem})},
          {"warnings", Json::array()},
          {"envelope", Json()},
          {"calibration", Json()}};
}

Json tract_json(const volume::Volume& ct, const volume::TransferFunction& transfer,
                cases::CarvingPlan plan) {
  const auto asked = std::exchange(plan.breach, std::nullopt);
  const auto found = cases::place_in_bone(ct, transfer, plan);
  if (!found) return refused_json(ct, transfer, plan, found.error().what);
  const auto& [placed, bone] = *found;
  Json out = no_tract_json(plan, "");
  out["problems"] = Json::array();
  if (placed.envelope) {
    out["warnings"] = placed.calibration.warnings;
    out["calibration"] = calibration_json(placed.calibration);
    out["envelope"] = envelope_json(placed.envelope->outer_face());
  }
  out["side"] = placed.left_side() ? "left" : "right";
  out["tract"] = tract_of(placed.tract);
  const volume::WallFinder finder(bone, transfer);
  for (std::size_t k = 0; k < volume::kWalls.size(); ++k)
    out["walls"].push_back(wall_json(finder, placed.tract, volume::kWalls[k], placed.walls[k]));
  if (!asked) return out;
  const auto breach = volume::place_breach(bone, transfer, placed.tract, *asked);
  if (breach)
    out["breach"] = breach_json(*breach);
  else
    out["problems"].push_back(breach.error().what);
  return out;
}

}  // namespace api
}  // namespace tractus
