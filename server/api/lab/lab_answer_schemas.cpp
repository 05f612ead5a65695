/// Schemas of the lab's answers, field for field as lab/report/answer.cpp writes them.
#include "server/api/lab/lab_json.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using namespace schema;
using core::Json;

const char* const kChannelUnit = "the channel's";

Json figure(std::string_view meaning) { return nullable(number(kChannelUnit, meaning)); }
Json share(std::string_view meaning) { return nullable(number("1", meaning)); }
Json series(std::string_view unit, std::string_view meaning) {
  return array(nullable(number(unit, meaning)), meaning);
}

Json distribution_schema() {
  return object({{"mean", figure("mean")},
                 {"sd", figure("standard deviation")},
                 {"p05", figure("5th percentile")},
                 {"p50", figure("median")},
                 {"p95", figure("95th percentile")},
                 {"edges", series(kChannelUnit, "edges of the histogram's bins")},
                 {"shares", series("1", "share of the samples in each bin")}});
}

Json spectrum_schema() {
  return object({{"frequency_Hz", series("Hz", "frequency of each line")},
                 {"measured", series(kChannelUnit, "amplitude of the measurement")},
                 {"simulated", series(kChannelUnit, "amplitude of the simulation")},
                 {"residual", series(kChannelUnit, "amplitude of the residual")}});
}

Json channel_schema() {
  return object({{"name", text("name of the channel: fz_N")},
                 {"rmse", figure("root mean square of the residual")},
                 {"r2", share("coefficient of determination")},
                 {"noise_floor", figure("root mean square error that a true model would have")},
                 {"explained", share("share of the variance above the noise that is explained")},
                 {"bias", optional(figure("mean of the residual"))},
                 {"measured", optional(ref("Distribution"))},
                 {"simulated", optional(ref("Distribution"))},
                 {"residual", optional(ref("Distribution"))},
                 {"spectrum", optional(ref("Spectrum"))}});
}

Json region_schema() {
  return object({{"region", text("condition on the signals: depth_m > 0.02")},
                 {"words", text("the condition in words")},
                 {"share_of_error", number("1", "share of the squared error in the region")},
                 {"share_of_time", number("1", "share of the samples in the region")},
                 {"rmse", figure("root mean square error in the region")},
                 {"mean", series(kChannelUnit, "mean residual of each channel")}});
}

Json comparison_schema() {
  const Json trial =
      object({{"id", text("identifier of the trial in the set")},
              {"rmse", figure("root mean square error of the judged channel")},
              {"channels", map(figure("root mean square error"), "error of each channel by name")},
              {"duration_s", number("s", "duration of the trial")}});
  const Json phase = object(
      {{"phase", text("phase of the motion")},
       {"rmse", figure("root mean square error in the phase")},
       {"share_of_error", number("1", "share of the squared error")},
       {"share_of_time", number("1", "share of the samples")},
       {"judged_share", optional(number("1", "share of the phase's samples that are judged"))}});
  const Json judgement =
      object({{"judgement", text("judged, or the reason for which samples are left out")},
              {"share", number("1", "share of the samples")}});
  return object(
      {{"format", text("tractus-comparison/1")},
       {"primary", text("name of the judged channel")},
       {"channels", array(channel_schema(), "comparison of each channel")},
       {"trials", array(trial, "comparison of each trial")},
       {"where", array(region_schema(), "regions that hold the error, largest share first")},
       {"where_method", text("how the regions were found and their figures estimated")},
       {"phases", array(phase, "comparison of each phase of the motion")},
       {"judgements",
        optional(
            array(judgement, "which samples the errors are of, and why the others are not"))}});
}

/// One number, or one for each component.
Json one_or_many(std::string_view meaning) {
  return any_of({figure(meaning), series("the parameter's", meaning)}, meaning);
}

Json parameters_schema() {
  return map(object({{"value", one_or_many("estimate")}, {"sd", one_or_many("standard error")}}),
             "estimates by name of the parameter");
}

Json estimates_schema() {
  return array(object({{"name", text("pointer into the model file: /layers/0/K_N_per_m")},
                       {"value", nullable(number("the parameter's", "estimate"))},
                       {"sd", nullable(number("the parameter's", "standard error"))},
                       {"informed", truth("true: the measurements determine the parameter")},
                       {"at_bound", truth("true: the estimate lies at a bound of its range")}}),
               "estimates of all free parameters");
}

Json fitted_trials_schema() {
  return array(
      object({{"id", text("identifier of the trial in the set")},
              {"rmse", figure("root mean square error after the fit")},
              {"held_out_rmse", figure("root mean square error of the fit to the other trials")}}),
      "error of each trial");
}

Json diagnosis_schema() {
  const Json effect = object({{"id", text("identifier of the effect")},
                              {"probability", share("probability that the effect is missing")},
                              {"parameters", parameters_schema()}});
  const Json step =
      object({{"model", text("the model after this step, in words")},
              {"rmse", figure("root mean square error of the step's model")},
              {"held_out_rmse", figure("the same on trials that were not fitted")},
              {"noise_floor", optional(figure("error that a true model would have"))}});
  const Json settle = object(
      {{"between", array(text("identifier of an effect"), "effects that it would distinguish")},
       {"recording", text("the recording to make")},
       {"expected_gain",
        nullable(
            number("1", "expected rise of the true structure's probability; null: not simulated"))},
       {"programs",
        optional(array(
            object({{"name", text("name of the recording")},
                    {"recording", text("the recording to make")},
                    {"duration_s", number("s", "duration of its repetitions")},
                    {"expected_gain", nullable(number("1", "expected rise of the probability"))},
                    {"program", ref("MotionProgram")}}),
            "recordings that were simulated, best first"))}});
  const Json base = object({{"rmse", figure("root mean square error of the supplied model")},
                            {"held_out_rmse", figure("the same on trials that were not fitted")},
                            {"noise_floor", figure("error that a true model would have")}});
  const Json hypotheses = optional(array(
      object({{"effects", array(text("identifier of an effect"), "none: nothing is missing")},
              {"probability", share("its probability among all that were fitted")},
              {"weight", share("before structures no better than a simpler one were left out")}}),
      "structures that are left, most probable first"));
  const Json torque = object(
      {{"primary", text("name of the judged channel: tz_Nm")},
       {"verdict", text("the verdict on the torque alone")},
       {"headline", text("that verdict as a sentence")},
       {"detail", text("a sentence with its figures")},
       {"probability", nullable(share("probability of that answer; null: undecided"))},
       {"base", base},
       {"effects", array(effect, "effects that are missing about the probe's axis")},
       {"ranking", array(ref("RankedEffect"), "candidates about the axis, most probable first")},
       {"steps", array(step, "fall of the torque's error as the effects are added")},
       {"hypotheses", hypotheses},
       {"rest_explained", optional(share("share of the residual that recorded signals explain"))}});
  return object(
      {{"format", text("tractus-diagnosis/1")},
       {"verdict", one_of({"complete", "missing", "partly", "unexplained", "undecided"},
                          "complete: the model is at the noise floor; missing: the effects below "
                          "bring it there; partly: they explain a part; unexplained: none does; "
                          "undecided: the noise hides what might be missing")},
       {"headline", optional(text("the verdict as a sentence"))},
       {"detail", optional(text("a sentence with the figures of the verdict"))},
       {"probability", nullable(share("probability of this answer; null: undecided"))},
       {"base", base},
       {"effects", array(effect, "effects that are missing")},
       {"ranking", array(ref("RankedEffect"), "all candidates, most probable first")},
       {"steps", array(step, "fall of the error as the effects are added")},
       {"confounded", array(tuple(text("identifier of an effect"), 2, "two effects"),
                            "pairs of effects that the recording cannot distinguish")},
       {"hypotheses", hypotheses},
       {"settle", nullable(settle)},
       {"torque", optional(torque)},
       {"depends_on", text("signal on which an unexplained residual depends; else empty")},
       {"rest_explained", share("share of the residual that the signal explains")},
       {"law_explained", optional(share("share of the residual that laws of physics explain"))},
       {"held_out", text("how trials were held out")},
       {"parameters", estimates_schema()},
       {"trials", fitted_trials_schema()},
       {"notes", array(text("one sentence"), "remarks on the answer")}});
}

Json fit_schema() {
  const Json effect =
      object({{"id", text("identifier of the effect")}, {"parameters", parameters_schema()}});
  const Json correlation =
      object({{"between", array(text("pointer of a parameter"), "the two parameters")},
              {"correlation", nullable(number("1", "correlation of their estimates"))}});
  return object(
      {{"format", text("tractus-fit/1")},
       {"base", object({{"rmse", figure("root mean square error of the supplied model")},
                        {"noise_floor", figure("error that a true model would have")}})},
       {"rmse", figure("root mean square error after the fit")},
       {"held_out_rmse", figure("the same on trials that were not fitted")},
       {"noise_floor", figure("error that a true model would have")},
       {"converged", truth("true: the solver converged")},
       {"held_out", text("how trials were held out")},
       {"effects", array(effect, "estimates of the model's effects")},
       {"parameters", estimates_schema()},
       {"correlations", array(correlation, "pairs of parameters correlated by more than 0.9")},
       {"trials", fitted_trials_schema()},
       {"remarks", array(text("one sentence"), "remarks on the fit")}});
}

Json tract_map_schema() {
  const Json point = tuple(number("m", "coordinate in the volume"), 3, "x, y, z");
  const Json direction = tuple(number("1", "component"), 3, "x, y, z");
  const Json table = array(series(kChannelUnit, "one row of angles"), "one row for each depth");
  const Json shares = array(series("1", "one row of angles"), "one row for each depth");
  return object({{"depth_m", array(number("m", "depth"), "borders of the cells along the tract")},
                 {"angle_rad", array(number("rad", "angle"), "borders of the cells around it")},
                 {"rmse", table},
                 {"share", shares},
                 {"tract", optional(nullable(object({{"entry_m", point},
                                                     {"axis", direction},
                                                     {"length_m", number("m", "length")}})))}});
}

}  // namespace

std::vector<NamedSchema> lab_answer_schemas() {
  const Json ranked = object(
      {{"id", text("identifier of the effect")},
       {"probability", share("probability that the effect is missing")},
       {"held_out_rmse", figure("error on held-out trials with the effect added")},
       {"note", optional(text("reason why the effect was not tried"))},
       {"own", optional(truth("true: an effect that a user wrote"))},
       {"detection_limits",
        optional(array(object({{"parameter", text("strength of the effect")},
                               {"value", nullable(number("the parameter's", "least value seen"))},
                               {"text", text("that in words, with its unit")}}),
                       "the least values at which an effect that is not named would have been; a "
                       "value of null: not within its range"))}});
  return {{"Distribution", distribution_schema()},
          {"Spectrum", spectrum_schema()},
          {"RankedEffect", ranked},
          {"Comparison", comparison_schema()},
          {"Diagnosis", diagnosis_schema()},
          {"Fit", fit_schema()},
          {"TractMap", tract_map_schema()}};
}

}  // namespace api
}  // namespace tractus
