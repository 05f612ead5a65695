/// Schemas of the lab's files, member for member as shared/models, shared/effects/expression.cpp
/// and shared/trial/motion_program.cpp read and write them.
#include "server/api/lab/lab_json.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using namespace schema;
using core::Json;

Json model_effect_schema() {
  const Json value = any_of({number("the parameter's", "Value of a scalar parameter"),
                             array(number("the parameter's", "Value of a component"),
                                   "Values of a parameter with several components")},
                            "Value of the parameter, or one for each component");
  return object({{"id", text("Id of the effect")},
                 {"parameters", optional(map(value, "Values by name of the parameter"))},
                 {"expression", optional(ref("EffectFile"))}});
}

/// The members that the models of both rigs have.
std::vector<Field> model_fields(const char* rig, Json base) {
  return {{"format", file_format("tractus-model/1")},
          {"rig", one_of({rig}, "Rig of the model")},
          {"name", text("Name of the model")},
          {"base", std::move(base)},
          {"fixed", optional(array(text("JSON pointer, for example /base/length_m"),
                                   "Parameters of the base that a fit leaves alone"))},
          {"effects", optional(array(ref("ModelEffect"), "Effects of the model, in order"))}};
}

Json palpation_base_schema() {
  return object(
      {{"force_factor_Nm", optional(number("N m", "Force factor of the field"))},
       {"force_scale", optional(number("1", "Factor of the shown force"))},
       {"torque_scale", optional(number("1", "Factor of the shown torque"))},
       {"points", optional(integer("1", "Number of points of contact on the shank"))},
       {"point_spacing_m", optional(number("m", "Distance between two points of contact"))},
       {"youngs_modulus_Pa", optional(number("Pa", "Young's modulus of the shank"))},
       {"length_m", optional(number("m", "Length of the free shank"))},
       {"radius_m", optional(number("m", "Radius of the shank"))},
       {"pose_offset_m", optional(tuple(number("m", "Component along x, y or z"), 3,
                                        "Added to the recorded position, in metres"))},
       {"field", optional(one_of({"paper", "potential"},
                                 "paper: the published vectors, interpolated; potential: the "
                                 "gradient of the interpolated opacity; default paper"))}});
}

Json palpation_model_schema() {
  std::vector<Field> fields = model_fields("palpation", palpation_base_schema());
  fields.emplace_back("volume", optional(text("Path of the volume beside the model file")));
  const Json point = tuple(number("1", "CT value, then opacity"), 2, "CT value and its opacity");
  fields.emplace_back("transfer",
                      optional(array(point, "Opacity by CT value, linear between the points")));
  return object(fields);
}

Json probing_model_schema() {
  const Json layer =
      object({{"start_m", number("m", "Depth at which the layer begins")},
              {"thickness_m", number("m", "Thickness of the layer")},
              {"stiffness_N_per_m", number("N/m", "Stiffness K of the layer")},
              {"damping_Ns_per_m", number("N s/m", "Damping D of the layer")},
              {"equilibrium_m", number("m", "Equilibrium x0, from the layer's start")}});
  const Json rotary = object(
      {{"viscous_Nms_per_rad", optional(number("N m s/rad", "Viscous friction of the stage"))},
       {"detent_Nm", optional(number("N m", "Amplitude of the detent torque"))},
       {"detent_pitch_rad", optional(number("rad", "Angle from one detent to the next"))}});
  return object(
      model_fields("probing", object({{"layers", array(layer, "Layers by depth, without overlap")},
                                      {"rotary", optional(rotary)}})));
}

Json effect_file_schema() {
  const Json parameter = object(
      {{"unit", text("SI unit, for example N*s/m")},
       {"initial", number("its own", "Start value of a fit, in the parameter's unit")},
       {"low", number("its own", "Smallest allowed value, in the parameter's unit")},
       {"high", number("its own", "Largest allowed value, in the parameter's unit")},
       {"meaning", optional(text("Meaning of the parameter, one sentence"))},
       {"logarithmic", optional(truth("True if a fit searches the logarithm; default false"))}});
  return object({{"format", file_format("tractus-effect/1")},
                 {"id", text("expression: and a name of small letters, digits and _")},
                 {"rig", one_of({"probing", "palpation"}, "Rig to which the effect applies")},
                 {"adds_to", text("Quantity to which the formula is added, EffectList.adds_to")},
                 {"formula", text("Formula with parameters and EffectList.states")},
                 {"summary", optional(text("Summary of the effect, one line"))},
                 {"parameters", map(parameter, "Parameters by name, at most 16")}});
}

Json motion_program_schema() {
  const Json move = object({{"to_m", number("m", "Depth of the tip at the end of the move")},
                            {"speed_m_s", number("m/s", "Largest speed on the way")},
                            {"to_rad", number("rad", "Angle at the end of the move")},
                            {"speed_rad_s", number("rad/s", "Largest angular speed on the way")},
                            {"hold_s", number("s", "Pause after the move")}});
  return object({{"format", file_format("tractus-program/1")},
                 {"rig", one_of({"probing"}, "Rig that plays the program")},
                 {"name", text("Name of the program")},
                 {"words", text("What to record, in words")},
                 {"start_m", number("m", "Depth of the tip at the start")},
                 {"start_rad", number("rad", "Angle at the start")},
                 {"acceleration_m_s2", number("m/s²", "Mean acceleration of the linear stage")},
                 {"acceleration_rad_s2", number("rad/s²", "Mean acceleration of the rotary stage")},
                 {"moves", array(move, "Moves, each from where the one before ended")}});
}

}  // namespace

std::vector<NamedSchema> lab_file_schemas() {
  return {{"ModelEffect", model_effect_schema()},
          {"PalpationModelFile", palpation_model_schema()},
          {"ProbingModelFile", probing_model_schema()},
          {"ModelFile", any_of({ref("PalpationModelFile"), ref("ProbingModelFile")},
                               "Model of one of the rigs")},
          {"EffectFile", effect_file_schema()},
          {"MotionProgram", motion_program_schema()}};
}

}  // namespace api
}  // namespace tractus
