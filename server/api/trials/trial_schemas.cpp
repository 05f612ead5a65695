#include "server/api/schema.hpp"
#include "server/api/trials/trial_json.hpp"

namespace tractus {
namespace api {
namespace {
using namespace schema;

const std::vector<std::string> kWalls{"medial", "lateral", "superior", "inferior", "anterior"};

core::Json point(std::string_view meaning) { return tuple(number("m", ""), 3, meaning); }
core::Json direction(std::string_view meaning) { return tuple(number("1", ""), 3, meaning); }

std::vector<Field> summary_fields() {
  return {
      {"id", text("32 hexadecimal characters")},
      {"case_id", text("SHA-256 of case.json")},
      {"case_title", text("for people")},
      {"station", text("its name")},
      {"operator_name", text("who palpated; a simulated hand says so")},
      {"simulated", truth("a simulated device stood in for hand and machine")},
      {"started_utc_us", integer("us", "since 1970, UTC")},
      {"duration_s", number("s", "first to last sample")},
      {"samples", integer("1", "recorded ticks")},
      {"state", one_of({"assessing", "assessed", "failed"}, "of the scores")},
      {"correct", nullable(truth("the answer against the truth; null when either is missing"))}};
}

core::Json trial_schema() {
  std::vector<Field> fields = summary_fields();
  const std::vector<Field> more{
      {"rig", one_of({"palpation", "probing"}, "which simulator")},
      {"device", text("sim-lambda6, lambda6, sim-rig, rig, …")},
      {"rate_Hz", number("Hz", "of the loop")},
      {"complete", truth("the trial was ended, not interrupted")},
      {"failure", nullable(text("why the scores failed"))},
      {"late_ticks", integer("1", "woke more than a quarter period late")},
      {"not_converged", integer("1", "ticks without equilibrium")},
      {"skipped_ticks", integer("1", "gaps in the count of ticks")},
      {"clock_offset_s",
       nullable(number("s", "server's clock less the station's when it was handed over"))},
      {"clock_error_s", nullable(number("s", "bound of the offset's error"))},
      {"events", array(ref("TrialEvent"), "in order of time")},
      {"answer", nullable(ref("Answer"))},
      {"truth", nullable(ref("Truth"))},
      {"metrics", array(ref("Score"), "empty until assessed")},
      {"tract", nullable(ref("Tract"))},
      {"scenario", nullable(ref("ProbingScenario"))},
      {"study", nullable(ref("StudyPlace"))},
      {"coverage", nullable(ref("Coverage"))},
      {"probe",
       anything(
           "length_m, radius_m, points, point_spacing_m, pose_offset_m of the model that ran")}};
  fields.insert(fields.end(), more.begin(), more.end());
  return object(fields);
}

core::Json truth_schema() {
  return object({{"breached", nullable(one_of(kWalls, "the wall with the hole; null: none"))},
                 {"breach_m", nullable(point("centre of the hole, in V; null also where another "
                                             "trial drilled it"))},
                 {"breach_depth_m", number("m", "how far the tool went beyond the bone")},
                 {"wall_thickness_m", nullable(number("m",
                                                      "of the bone there before it gave way; "
                                                      "null: another trial drilled it"))}});
}

core::Json tract_schema() {
  return object({{"entry_m", point("centre of the mouth, in V")},
                 {"axis", direction("unit vector into the bone, in V")},
                 {"length_m", number("m", "")},
                 {"radius_m", number("m", "")},
                 {"medial", direction("unit vector, in V")},
                 {"superior", direction("unit vector, in V")}});
}

core::Json scenario_schema() {
  const core::Json layer = object({{"start_m", number("m", "depth from the entry")},
                                   {"thickness_m", number("m", "")},
                                   {"stiffness_N_per_m", number("N/m", "K")},
                                   {"damping_Ns_per_m", number("N·s/m", "D")}});
  const core::Json wall =
      object({{"position_m", number("m", "where it gives way, from the entry")},
              {"resistance_interval_m", number("m", "before it, resistance grows over this")},
              {"breach_interval_m", number("m", "soft tissue behind it")}});
  return object({{"id", text("of the scenario's version")},
                 {"name", text("for people")},
                 {"travel_m", number("m", "depth of the probe stop")},
                 {"layers", array(layer, "of bone, by depth")},
                 {"walls", array(wall, "by depth; none: nothing is breached")}});
}

core::Json score_schema() {
  auto fields = metric_fields();
  fields.emplace_back("value",
                      nullable(number("its unit", "null when this trial has no such score")));
  fields.emplace_back("note", text("reason for a missing value, or a remark; else empty"));
  return object(fields);
}

}  // namespace

std::vector<schema::Field> metric_fields() {
  return {
      {"id", text("identifier of the metric; never changes")},
      {"label", text("name of the metric on pages")},
      {"unit", text("unit as printed: N, s, 1")},
      {"definition", text("definition in one sentence")},
      {"source", text("paper and table, or own definition")},
      {"shown_as", one_of({"number", "share", "correct_or_incorrect"},
                          "how pages write the value: with its unit, as a percentage, as correct "
                          "(1) or incorrect (0)")},
      {"cell", nullable(object({{"row", text("quantity: Transverse force")},
                                {"symbol", text("symbol of the quantity: F_xy")},
                                {"column", text("statistic: Mean, SD, Max")}}))}};
}

std::vector<NamedSchema> trial_schemas() {
  return {
      {"TrialSummary", object(summary_fields())},
      {"TrialList", object({{"trials", array(ref("TrialSummary"), "newest first")},
                            {"more", truth("older ones exist")}})},
      {"Trial", trial_schema()},
      {"TrialEvent", object({{"t_s", number("s", "since the trial's start")},
                             {"kind", text("start, answer, end, fault, interrupted")},
                             {"detail", anything("by kind")}})},
      {"Answer", object({{"breach", truth("was one felt?")},
                         {"wall", nullable(one_of(kWalls, "where"))},
                         {"confidence", nullable(number("1", "0 … 1"))},
                         {"depth_m", nullable(number("m", "probing: where it was felt"))}})},
      {"ProbingScenario", scenario_schema()},
      {"StudyPlace",
       object({{"id", text("the study's")},
               {"title", text("for people")},
               {"participant", text("a pseudonym")},
               {"number", integer("1", "of the place in their order, from 1")},
               {"state", one_of({"arriving", "counts", "invalid", "surplus"},
                                "surplus: its place in the order had a trial already")},
               {"reason", text("of not counting")}})},
      {"Truth", truth_schema()},
      {"Score", score_schema()},
      {"Tract", tract_schema()},
      {"Coverage",
       object({{"depth_bins", integer("1", "along the axis")},
               {"angle_bins",
                integer("1", "round it; bin 0 is centred on medial, a quarter turn is superior")},
               {"samples", array(integer("1", ""), "[depth][angle], samples that touched")}})}};
}

std::vector<NamedSchema> curve_schemas() {
  const core::Json seconds = array(number("s", ""), "since the trial's start");
  return {
      {"Envelope",
       object({{"min", array(number("the channel's", ""), "of the samples behind each point")},
               {"max", array(number("the channel's", ""), "likewise")}})},
      {"TrialSignals",
       object({{"t_s", seconds},
               {"channels", map(ref("Envelope"), "by name, which ends in the unit")},
               {"from_s", number("s", "of the first sample shown")},
               {"to_s", number("s", "of the last sample shown")},
               {"samples_per_point", integer("1", "1: every sample; min equals max")}})},
      {"TrialPath",
       object({{"t_s", seconds},
               {"tip_m", array(point(""), "tip of the bent probe, in V")},
               {"force_N", array(number("N", ""), "magnitude of the model's force")}})},
      {"TrialForceDepth",
       object({{"t_s", seconds},
               {"depth_m", array(number("m", ""), "of the tip, from the entry")},
               {"force_N", array(number("N", ""), "push of the hand, positive into the bone")},
               {"mode", array(one_of({"holding", "bone", "resistance", "breach", "stopped"}, ""),
                              "what the controller was doing")}})}};
}

}  // namespace api
}  // namespace tractus
