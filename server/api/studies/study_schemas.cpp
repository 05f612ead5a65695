#include "server/api/schema.hpp"
#include "server/api/studies/study_json.hpp"

namespace tractus {
namespace api {
namespace {
using namespace schema;

const std::vector<std::string> kStates{"running", "paused"};

std::vector<Field> study_fields() {
  return {{"id", text("a name of a-z, 0-9 and -")},
          {"title", text("for people")},
          {"state", one_of(kStates, "paused: nothing is handed out")},
          {"ordering", one_of({"random", "balanced"}, "shuffled, or by Williams squares")},
          {"repeats", integer("1", "of each scenario")},
          {"on_invalid",
           one_of({"at_end", "at_once", "never"}, "when a trial that does not count is repeated")},
          {"made_utc_us", integer("us", "since 1970, UTC")},
          {"made_by", text("an account")}};
}

core::Json progress_field(std::string_view meaning) { return integer("1", meaning); }

core::Json trial_schema() {
  return object(
      {{"id", text("32 hexadecimal characters")},
       {"state", one_of({"arriving", "counts", "invalid", "surplus"},
                        "surplus: its place in the order had a trial already")},
       {"reason", text("of not counting")},
       {"station", text("its name")},
       {"changed_utc_us", integer("us", "since 1970, UTC")},
       {"started_utc_us", nullable(integer("us", "since 1970, UTC; null while it arrives"))},
       {"duration_s", nullable(number("s", "first to last sample"))},
       {"samples", nullable(integer("1", "on this server"))},
       {"sha256", nullable(text("of the trial file"))},
       {"assessment", nullable(one_of({"assessing", "assessed", "failed"}, "of the scores"))},
       {"correct", nullable(truth("the answer against the truth"))}});
}

core::Json participant_schema() {
  return object({{"name", text("a pseudonym")},
                 {"state", one_of(kStates, "paused: nothing is handed out")},
                 {"level", text("resident, fellow, …")},
                 {"experience_years", nullable(number("a", "in years"))},
                 {"simulated", truth("a simulated surgeon")},
                 {"at_station", truth("a station has trials of theirs to be done")},
                 {"last_station", nullable(text("that brought a trial"))},
                 {"done", progress_field("trials that count")},
                 {"planned", progress_field("that count or are still to be done")},
                 {"judged", progress_field("that count and have an answer and a truth")},
                 {"recognised", progress_field("of those judged, answered rightly")},
                 {"slots", array(ref("StudySlot"), "in their order")}});
}

core::Json with(std::vector<Field> fields, const std::vector<Field>& more) {
  fields.insert(fields.end(), more.begin(), more.end());
  return object(fields);
}

}  // namespace

std::vector<NamedSchema> study_schemas() {
  return {
      {"StudySummary", with(study_fields(), {{"participants", progress_field("enrolled")},
                                             {"done", progress_field("trials that count")},
                                             {"planned", progress_field("in all")}})},
      {"StudyList", object({{"studies", array(ref("StudySummary"), "newest first")}})},
      {"Study", with(study_fields(),
                     {{"seed", nullable(integer("1", "of the orders; null until all is done"))},
                      {"scenarios", array(ref("StudyScenario"), "as they were named")},
                      {"participants", array(ref("StudyParticipant"), "as they were enrolled")}})},
      {"StudyScenario",
       object({{"case_id", text("the scenario version's id")}, {"title", text("its name")}})},
      {"StudyParticipant", participant_schema()},
      {"StudySlot",
       object({{"number", progress_field("in the participant's order, from 1")},
               {"state",
                one_of({"waiting", "taken", "recorded", "invalid"}, "taken: a station has it")},
               {"repeat_of", nullable(progress_field("number of the slot that it repeats"))},
               {"scenario", nullable(text("its name; null until the participant is through"))},
               {"trials", array(ref("StudyTrial"), "by the time they changed")}})},
      {"StudyTrial", trial_schema()}};
}

std::vector<NamedSchema> study_deed_schemas() {
  return {{"NewParticipant", object({{"name", text("a pseudonym of letters, digits, - and _")},
                                     {"level", optional(text("resident, fellow, …"))},
                                     {"experience_years", optional(number("a", "in years"))},
                                     {"simulated", optional(truth("a simulated surgeon"))}})},
          {"NewStudy",
           object({{"id", text("a name of a-z, 0-9 and -")},
                   {"title", text("for people")},
                   {"scenarios",
                    array(anything("tractus-scenario/1, or {\"tuned\": \"hard\"}"), "1 to 16")},
                   {"repeats", integer("1", "of each scenario, 1 to 20")},
                   {"ordering", optional(one_of({"random", "balanced"}, "random if not given"))},
                   {"on_invalid", optional(one_of({"at_end", "at_once", "never"},
                                                  "when a trial that does not count is repeated"))},
                   {"seed", optional(integer("1", "of the orders; drawn if not given"))},
                   {"participants", array(ref("NewParticipant"), "may be empty")}})},
          {"StudyEvent", object({{"at_utc_us", integer("us", "since 1970, UTC")},
                                 {"who", text("account or station")},
                                 {"what", text("made, enrolled, taken, recorded, invalid, …")},
                                 {"participant", nullable(text(""))},
                                 {"trial_id", nullable(text(""))},
                                 {"reason", text("as it was given")}})},
          {"StudyEvents", object({{"events", array(ref("StudyEvent"), "newest first")}})}};
}

}  // namespace api
}  // namespace tractus
