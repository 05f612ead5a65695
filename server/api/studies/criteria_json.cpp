#include "server/api/studies/criteria_json.hpp"

namespace tractus::api {

core::Json requirements_json(const assessment::Criteria& of) {
  core::Json out = of.to_json()["requirements"];
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i]["text"] = assessment::text_of(of.requirements[i]);
  return out;
}

namespace {

/// What a requirement states, in files and in answers.
std::vector<schema::Field> requirement_fields() {
  using namespace schema;
  return {
      {"kind", one_of<assessment::RequirementKind>("Kind of the requirement")},
      {"metric", optional(text("Id of the metric; only of kind metric"))},
      {"side", optional(one_of<assessment::Side>("Side of the bound that passes"))},
      {"bound", optional(number("1", "Bound, in the metric's unit"))},
      {"times", optional(integer("1", "Number of values that must keep the bound"))},
      {"last", optional(integer("1", "Number of latest trials that are looked at; 0: all"))},
      {"share", optional(number("1",
                                "Least share of correct answers, 0 to 1; only of kind "
                                "recognition"))},
      {"level", optional(number("1", "Level of the interval whose low end is compared, 0 to 1"))},
      {"adequate", optional(number("1",
                                   "Acceptable failure rate, 0 to 1; only of kind "
                                   "lc_cusum"))},
      {"inadequate", optional(number("1", "Unacceptable failure rate, 0 to 1"))}};
}

}  // namespace

core::Json requirement_schema() {
  using namespace schema;
  auto fields = requirement_fields();
  fields.emplace_back("basis",
                      text("Where the bound comes from, in words; empty if nothing was noted"));
  fields.emplace_back("text", text("The requirement in words"));
  return object(fields);
}

core::Json criteria_file_schema() {
  using namespace schema;
  auto fields = requirement_fields();
  fields.emplace_back("basis", optional(text("Where the bound comes from, in words")));
  return object({{"format", file_format("tractus-criteria/1")},
                 {"requirements", array(object(fields), "Requirements, one to twelve")}});
}

core::Json judged_requirement_schema() {
  using namespace schema;
  return object({{"met", truth("True if the requirement was met")},
                 {"required", text("The requirement in words")},
                 {"found", text("What the trials show, in words")}});
}

std::vector<schema::Field> verdict_fields() {
  using namespace schema;
  return {{"passed", truth("True if all requirements were met at once after some trial")},
          {"passed_at", nullable(integer("1",
                                         "Number of that trial among the person's trials, "
                                         "counted from 1; null if not passed"))},
          {"holds_now", truth("True if all requirements are met after the last trial")},
          {"trials", integer("1", "Number of the person's trials that count")},
          {"requirements", array(ref("JudgedRequirement"),
                                 "Requirements at the trial with which the person passed, or "
                                 "after the last one")}};
}

}  // namespace tractus::api
