#include "metrics/metric.hpp"
#include "server/api/finding/list_request.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/trial_json.hpp"
#include "trial/trial.hpp"

namespace tractus {
namespace api {
namespace {
using namespace schema;

core::Json point(std::string_view meaning) {
  return tuple(number("m", "One coordinate x, y or z, in metres"), 3, meaning);
}
core::Json direction(std::string_view meaning) {
  return tuple(number("1", "One component x, y or z"), 3, meaning);
}

std::vector<Field> summary_fields() {
  return {
      {"id", text("Id of the trial, 32 hexadecimal characters")},
      {"case_id", text("Id of the case or of the scenario's version")},
      {"case_title", text("Title of the case or scenario")},
      {"station", text("Name of the station")},
      {"operator_name",
       text("Name of the person who did the trial; for a simulated hand a name that states so; "
            "empty while the trial is rated blind")},
      {"person", text("Name of the account to which the trial was assigned; empty if it belongs to "
                      "no assignment, or while the trial is rated blind")},
      {"simulated", truth("True if a simulated device replaced hand and machine")},
      {"started_utc_us", integer("us", "Start of the trial, in microseconds since 1970-01-01 UTC")},
      {"duration_s", number("s", "Time from the first to the last sample, in seconds")},
      {"samples", integer("1", "Number of recorded samples")},
      {"state", one_of<store::AssessmentState>("State of the assessment that computes the scores")},
      {"correct", nullable(truth("True if the answer agrees with the truth; null if the answer or "
                                 "the truth is missing"))}};
}

core::Json trial_schema() {
  std::vector<Field> fields = summary_fields();
  const std::vector<Field> more{
      {"rig", one_of<trial::Rig>("Rig on which the trial ran")},
      {"device", text("Name of the device, for example sim-lambda6, lambda6, sim-rig or rig")},
      {"rate_Hz", number("Hz", "Rate of the haptic loop, in Hz")},
      {"complete", truth("True if the trial was ended, false if it was interrupted")},
      {"failure", nullable(text("Reason why the assessment failed; null if it did not fail"))},
      {"late_ticks",
       integer("1", "Number of ticks that started more than a quarter of a period late")},
      {"not_converged", integer("1", "Number of ticks in which the model found no equilibrium")},
      {"skipped_ticks", integer("1", "Number of ticks that were skipped")},
      {"clock_offset_s", nullable(number("s",
                                         "Server's clock minus the station's clock at the upload, "
                                         "in seconds; null if the station did not measure it"))},
      {"clock_error_s", nullable(number("s",
                                        "Bound of the error of clock_offset_s, in seconds; null if "
                                        "the station did not measure it"))},
      {"events", array(ref("TrialEvent"), "Events of the trial, in order of time")},
      {"answer", nullable(ref("Answer"))},
      {"truth", nullable(ref("Truth"))},
      {"metrics", array(ref("Score"), "Scores of the trial; empty until the trial is assessed")},
      {"tract", nullable(ref("Tract"))},
      {"scenario", nullable(ref("ProbingScenario"))},
      {"study", nullable(ref("StudyPlace"))},
      {"coverage", nullable(ref("Coverage"))},
      {"probe", ref("TrialProbe")}};
  fields.insert(fields.end(), more.begin(), more.end());
  return object(fields);
}

core::Json truth_schema() {
  return object(
      {{"breached",
        nullable(one_of<volume::Wall>("Wall with the breach; null if there is no breach"))},
       {"breach_m",
        nullable(point("Centre of the breach in the volume's frame (LPS), in metres; null if there "
                       "is no breach or if a trainee drilled the channel"))},
       {"breach_depth_m", number("m", "Distance that the drill went beyond the bone, in metres")},
       {"wall_thickness_m",
        nullable(number("m",
                        "Thickness of the bone at the breach before drilling, in metres; null if "
                        "there is no breach or if a trainee drilled the channel"))}});
}

core::Json tract_schema() {
  return object(
      {{"entry_m", point("Centre of the tract's entry in the volume's frame (LPS), in metres")},
       {"axis",
        direction("Unit vector along the tract into the bone, in the volume's frame (LPS)")},
       {"length_m", number("m", "Length of the tract, in metres")},
       {"radius_m", number("m", "Radius of the tract, in metres")},
       {"medial", direction("Unit vector towards the medial wall, in the volume's frame (LPS)")},
       {"superior",
        direction("Unit vector towards the superior wall, in the volume's frame (LPS)")}});
}

core::Json scenario_schema() {
  const core::Json layer =
      object({{"start_m",
               number("m", "Depth at which the layer begins, measured from the entry, in metres")},
              {"thickness_m", number("m", "Thickness of the layer, in metres")},
              {"stiffness_N_per_m", number("N/m", "Stiffness K of the layer, in N/m")},
              {"damping_Ns_per_m", number("N·s/m", "Damping D of the layer, in N·s/m")}});
  const core::Json wall =
      object({{"position_m",
               number("m", "Depth at which the wall breaks, measured from the entry, in metres")},
              {"resistance_interval_m",
               number("m", "Distance before the wall over which the resistance grows, in metres")},
              {"breach_interval_m",
               number("m", "Thickness of the soft tissue behind the wall, in metres")}});
  return object(
      {{"id", text("Id of the scenario's version")},
       {"name", text("Name of the scenario")},
       {"travel_m", number("m", "Depth of the probe stop, in metres")},
       {"layers", array(layer, "Layers of bone, sorted by depth")},
       {"walls",
        array(wall, "Walls that can breach, sorted by depth; empty if there is no breach")}});
}

core::Json score_schema() {
  auto fields = metric_fields();
  fields.emplace_back("value",
                      nullable(number("its unit",
                                      "Value of the score, in the unit that the field unit states; "
                                      "null if the trial has no such score")));
  fields.emplace_back(
      "note", text("Reason for a missing value, or a remark on the value; empty if there is none"));
  return object(fields);
}

}  // namespace

std::vector<schema::Field> metric_fields() {
  return {{"id", text("Id of the metric, which never changes")},
          {"label", text("Name of the metric on pages")},
          {"unit", text("Unit of the metric, for example N, s or 1")},
          {"definition", text("Definition of the metric, one sentence")},
          {"source", text("Source of the definition: paper and table, or own definition")},
          {"shown_as", one_of<metrics::ShownAs>(
                           "How pages show the value: number = with its unit, share = as a "
                           "percentage, correct_or_incorrect = as correct (1) or incorrect (0)")},
          {"cell", nullable(object({{"row", text("Quantity, for example Transverse force")},
                                    {"symbol", text("Symbol of the quantity, for example F_xy")},
                                    {"column", text("Statistic, for example Mean, SD or Max")}}))}};
}

std::vector<NamedSchema> trial_schemas() {
  std::vector<Field> list = page_fields();
  list.emplace_back("trials", array(ref("TrialSummary"), "Trials in the order asked for"));
  list.emplace_back("more", truth("True if trials follow those of the answer"));
  return {
      {"TrialSummary", object(summary_fields())},
      {"TrialList", object(list)},
      {"Trial", trial_schema()},
      {"TrialProbe",
       object(
           {{"length_m", optional(number("m", "Palpation: length of the free shank"))},
            {"radius_m", optional(number("m", "Palpation: radius of the shank"))},
            {"points", optional(integer("1", "Palpation: points of contact on the shank"))},
            {"point_spacing_m",
             optional(number("m", "Palpation: distance between two points of contact"))},
            {"pose_offset_m",
             optional(point("Palpation: added to the recorded position, in the volume's frame"))},
            {"travel_m", optional(number("m",
                                         "Probing: travel of the linear drive; absent in "
                                         "blind trials"))}})},
      {"TrialEvent",
       object({{"t_s", number("s", "Time of the event, in seconds since the start of the trial")},
               {"kind",
                text("Kind of the event, for example start, answer, end, fault or interrupted")},
               {"detail", anything("Details of the event, which depend on its kind")}})},
      {"Answer",
       object({{"breach", truth("True if the trainee answered that there is a breach")},
               {"wall", nullable(one_of<volume::Wall>(
                            "Wall of the breach; null if the answer names none"))},
               {"confidence",
                nullable(number(
                    "1", "Confidence in the answer, 0 to 1; null if the trainee gave none"))},
               {"depth_m", nullable(number("m",
                                           "Probing: depth of the breach in the answer, in metres; "
                                           "null if the answer names none"))}})},
      {"ProbingScenario", scenario_schema()},
      {"StudyPlace",
       object({{"id", text("Id of the study or assignment")},
               {"title", text("Title of the study or assignment")},
               {"participant", text("Pseudonym of the participant")},
               {"number",
                integer("1",
                        "Number of the trial's place in the participant's order, counted from 1")},
               {"state",
                one_of<store::StudyTrialState>(
                    "arriving: the upload is not complete; counts: the trial counts; invalid: it "
                    "was marked invalid; surplus: its place in the order already had a trial")},
               {"reason", text("Reason why the trial does not count; empty if it counts")}})},
      {"Truth", truth_schema()},
      {"Score", score_schema()},
      {"Tract", tract_schema()},
      {"Coverage",
       object(
           {{"depth_bins", integer("1", "Number of bins along the axis of the tract")},
            {"angle_bins", integer("1",
                                   "Number of bins around the axis; bin 0 is centred on the medial "
                                   "direction, and superior is a quarter turn further")},
            {"samples",
             array(integer("1", "Number of samples in one bin"),
                   "Number of samples with contact in each bin, in the order [depth][angle]")}})}};
}

std::vector<NamedSchema> curve_schemas() {
  const core::Json seconds = array(number("s", "Time since the start of the trial, in seconds"),
                                   "Time of each point, in seconds since the start of the trial");
  return {
      {"Envelope",
       object({{"min", array(number("the channel's", "Smallest value of the point's samples"),
                             "Smallest value at each point")},
               {"max", array(number("the channel's", "Largest value of the point's samples"),
                             "Largest value at each point")}})},
      {"TrialSignals",
       object(
           {{"t_s", seconds},
            {"channels", map(ref("Envelope"), "Channels by name; each name ends with the unit")},
            {"from_s", number("s",
                              "Time of the first sample in the answer, in seconds since the start "
                              "of the trial")},
            {"to_s",
             number(
                 "s",
                 "Time of the last sample in the answer, in seconds since the start of the trial")},
            {"samples_per_point", integer("1",
                                          "Number of samples that each point summarises; 1: every "
                                          "sample, and min equals max")}})},
      {"TrialPath",
       object({{"t_s", seconds},
               {"tip_m", array(point("Position of the tip in the volume's frame (LPS), in metres"),
                               "Position of the tip of the bent probe at each time")},
               {"force_N", array(number("N", "Magnitude of the force, in newtons"),
                                 "Magnitude of the model's force at each time")}})},
      {"TrialForceDepth",
       object({{"t_s", seconds},
               {"depth_m", array(number("m", "Depth of the tip, in metres"),
                                 "Depth of the tip from the entry at each time")},
               {"force_N", array(number("N", "Pushing force of the hand, in newtons"),
                                 "Pushing force of the hand at each time, positive into the bone")},
               {"mode", array(one_of<core::ProbingMode>("Mode of the controller"),
                              "Mode of the controller at each time")}})}};
}

}  // namespace api
}  // namespace tractus
