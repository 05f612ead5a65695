#include "server/api/cases/case_file_schemas.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "scenarios/scenario.hpp"
#include "server/api/schema.hpp"
#include "volume/fill.hpp"

namespace tractus {
namespace api {
namespace {

using namespace schema;
using core::Json;

Json vector_schema(std::string_view unit, std::string_view meaning) {
  return tuple(number(unit, "Component along x, y or z of the volume's frame"), 3, meaning);
}

Json bone_schema() {
  return object(
      {{"stiffness_N_per_m", number("N/m", "Stiffness K of a layer")},
       {"damping_Ns_per_m", number("N s/m", "Damping D of a layer")},
       {"equilibrium_m", number("m", "Equilibrium x0 from a layer's start, 0 or negative")},
       {"interval_m", number("m", "Thickness L of a layer")}});
}

Json breach_schema() {
  return object({{"resistance_interval_m", number("m", "Bone before the wall over which R_f acts")},
                 {"resistance_factor_per_m", number("1/m", "Growth R_f of the resistance")},
                 {"breach_interval_m", number("m", "Soft tissue behind the wall, L_b")},
                 {"breach_damping_Ns_per_m", number("N s/m", "Damping D_b of the soft tissue")}});
}

Json rotary_schema() {
  return object(
      {{"viscous_Nms_per_rad", number("N m s/rad", "Viscous friction of the rotary stage")},
       {"detent_Nm", number("N m", "Amplitude of the detent torque")},
       {"detent_pitch_rad", number("rad", "Angle from one detent to the next")}});
}

std::vector<Field> scenario_fields() {
  const Json region =
      object({{"start_m", number("m", "Depth at which the region begins")},
              {"thickness_m", number("m", "Thickness of the region")},
              {"density", number("1", "Factor of stiffness and damping in the region")}});
  return {{"format", file_format("tractus-scenario/1")},
          {"name", text("Name for faculty")},
          {"kind", one_of<scenarios::Kind>("Kind of the scenario")},
          {"bone", bone_schema()},
          {"breach", breach_schema()},
          {"walls_m", array(number("m", "Depth of a wall"), "Depths at which a wall breaches")},
          {"density", number("1", "Factor of stiffness and damping of all bone")},
          {"layers", array(region, "Regions of another density, by depth, without overlap")},
          {"travel_m", number("m", "Depth of the probe stop")},
          {"rotary", rotary_schema()},
          {"origin",
           object({{"who", text("Name of the account that wrote the version")},
                   {"when", text("Time of writing, UTC, ISO 8601")},
                   {"parent", text("Id of the version from which it was made; may be empty")}})}};
}

/// A draft may lack what has a usual value, and the origin, which the server writes.
Json scenario_draft() {
  constexpr std::array<std::string_view, 6> kMayBeMissing{"breach", "walls_m", "density",
                                                          "layers", "rotary",  "origin"};
  std::vector<Field> fields = scenario_fields();
  for (auto& [name, field] : fields)
    if (std::ranges::find(kMayBeMissing, name) != kMayBeMissing.end()) field = optional(field);
  return object(fields);
}

}  // namespace

std::vector<NamedSchema> scenario_file_schemas() {
  const Json tuned =
      object({{"tuned", one_of<scenarios::Kind>("A tuned scenario that comes with the program")}});
  return {{"ScenarioFile", object(scenario_fields())},
          {"ScenarioDraft", scenario_draft()},
          {"TunedScenario", tuned},
          {"ScenarioOrTuned", any_of({ref("ScenarioDraft"), ref("TunedScenario")},
                                     "A scenario with its origin, or the name of a tuned one")}};
}

std::vector<NamedSchema> case_file_schemas() {
  return {{"CaseTract",
           object({{"entry_m", vector_schema("m", "Entry of the tract, in metres")},
                   {"axis", vector_schema("1", "Direction of the tract, a unit vector")},
                   {"length_m", number("m", "Length of the tract")},
                   {"radius_m", number("m", "Radius of the tract")},
                   {"medial", vector_schema("1", "Direction to the medial wall, a unit vector")},
                   {"superior", vector_schema("1", "Direction to the superior wall")}})},
          {"CasePart", object({{"name", text("Name of the file in the bundle")},
                               {"sha256", text("SHA-256 of the file")},
                               {"size_bytes", integer("B", "Size of the file, in bytes")},
                               {"secret", truth("True if no station or trainee may read it")}})},
          {"CaseManifest",
           object({{"format", file_format("tractus-case/1")},
                   {"title", text("Title of the case, shown to people")},
                   {"source", text("Origin of the volume and its licence")},
                   {"made_utc_us",
                    integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
                   {"tract", ref("CaseTract")},
                   {"model", ref("PalpationModelFile")},
                   {"parts", array(ref("CasePart"), "Files of the bundle")},
                   {"channel", optional(one_of({"planned"},
                                               "Present if the bone is whole and the "
                                               "trainee drills the channel"))},
                   {"preparation", optional(one_of<volume::Preparation>(
                                       "Preparation of the bone; default published"))},
                   {"certified", optional(truth("True if an ideal observer can tell a breach of "
                                                "every wall; missing if nobody tried"))}})}};
}

}  // namespace api
}  // namespace tractus
