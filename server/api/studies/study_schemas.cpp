#include "server/api/schema.hpp"
#include "server/api/studies/study_json.hpp"
#include "study/order.hpp"

namespace tractus {
namespace api {
namespace {
using namespace schema;

std::vector<Field> study_fields() {
  return {
      {"id", text("Id of the study, 1 to 32 of the characters a-z, 0-9 and -")},
      {"title", text("Title of the study")},
      {"state",
       one_of<store::StudyState>("State of the study; paused: stations receive no trials of it")},
      {"ordering",
       one_of<study::Ordering>("Order of the scenarios: random, or balanced by Williams squares")},
      {"repeats", integer("1", "Number of repeats of each scenario")},
      {"on_invalid", one_of<store::Repetition>("When an invalid trial is repeated")},
      {"made_utc_us", integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
      {"made_by", text("Name of the account that created the study")}};
}

core::Json progress_field(std::string_view meaning) { return integer("1", meaning); }

core::Json study_trial_schema() {
  return object(
      {{"id", text("Id of the trial, 32 hexadecimal characters")},
       {"state",
        one_of<store::StudyTrialState>(
            "arriving: the upload is not complete; counts: the trial counts; invalid: it was "
            "marked invalid; surplus: its place in the order already had a trial")},
       {"reason", text("Reason why the trial does not count; empty if it counts")},
       {"station", text("Name of the station")},
       {"changed_utc_us",
        integer("us", "Time of the last change of state, in microseconds since 1970-01-01 UTC")},
       {"started_utc_us", nullable(integer("us",
                                           "Start of the trial, in microseconds since 1970-01-01 "
                                           "UTC; null until the upload is complete"))},
       {"duration_s", nullable(number("s",
                                      "Time from the first to the last sample, in seconds; null "
                                      "until the upload is complete"))},
       {"samples", nullable(integer("1", "Number of samples; null until the upload is complete"))},
       {"sha256", nullable(text("SHA-256 of the trial file; null until the upload is complete"))},
       {"assessment", nullable(one_of<store::AssessmentState>(
                          "State of the assessment that computes the scores; null "
                          "until the upload is complete"))},
       {"correct", nullable(truth("True if the answer agrees with the truth; null if either is "
                                  "missing, or while the participant still has trials to do"))}});
}

core::Json participant_schema() {
  return object(
      {{"name", text("Pseudonym of the participant")},
       {"state",
        one_of<store::StudyState>(
            "State of the participant; paused: stations receive no trials of the participant")},
       {"level", text("Level of training, for example resident or fellow; may be empty")},
       {"experience_years",
        nullable(number("a", "Surgical experience, in years; null if it is not known"))},
       {"simulated", truth("True if the participant is a simulated surgeon")},
       {"at_station",
        truth("True if a station has taken trials of the participant that are still to be done")},
       {"last_station", nullable(text("Name of the station that last uploaded a trial of the "
                                      "participant; null if there is none"))},
       {"done", progress_field("Number of trials that count")},
       {"planned", progress_field("Number of trials that count or are still to be done")},
       {"judged", progress_field("Number of trials that count and have an answer and a truth; 0 "
                                 "while the participant still has trials to do")},
       {"recognised", progress_field("Number of these trials with a correct answer; 0 while the "
                                     "participant still has trials to do")},
       {"slots", array(ref("StudySlot"), "Slots of the participant, in their order")}});
}

core::Json with(std::vector<Field> fields, const std::vector<Field>& more) {
  fields.insert(fields.end(), more.begin(), more.end());
  return object(fields);
}

}  // namespace

std::vector<NamedSchema> study_schemas() {
  return {
      {"StudySummary",
       with(study_fields(), {{"participants", progress_field("Number of enrolled participants")},
                             {"done", progress_field("Number of trials that count")},
                             {"planned", progress_field("Number of planned trials")}})},
      {"StudyList", object({{"studies", array(ref("StudySummary"), "Studies, newest first")}})},
      {"Study",
       with(study_fields(),
            {{"seed",
              nullable(integer("1", "Seed of the random orders; null until all trials are done"))},
             {"scenarios",
              array(ref("StudyScenario"), "Scenarios, in the order in which the study lists them")},
             {"participants",
              array(ref("StudyParticipant"), "Participants, in the order of their enrolment")}})},
      {"StudyScenario", object({{"case_id", text("Id of the scenario's version")},
                                {"title", text("Name of the scenario")}})},
      {"StudyParticipant", participant_schema()},
      {"StudySlot",
       object({{"number",
                progress_field("Number of the slot in the participant's order, counted from 1")},
               {"state",
                one_of<store::SlotState>("State of the slot; taken: a station has received it")},
               {"repeat_of",
                nullable(progress_field(
                    "Number of the slot that this slot repeats; null if it repeats none"))},
               {"scenario",
                nullable(text(
                    "Name of the scenario; null while the participant still has trials to do"))},
               {"trials", array(ref("StudyTrial"),
                                "Trials of the slot, sorted by the time of their last change; "
                                "without those that are rated blind")}})},
      {"StudyTrial", study_trial_schema()}};
}

std::vector<NamedSchema> study_deed_schemas() {
  return {
      {"NewParticipant",
       object(
           {{"name", text("Pseudonym of the participant, 1 to 32 letters, digits, - and _")},
            {"level", optional(text("Level of training, for example resident or fellow"))},
            {"experience_years", optional(number("a", "Surgical experience, in years"))},
            {"simulated",
             optional(truth("True if the participant is a simulated surgeon; default false"))}})},
      {"NewStudy",
       object({{"id", text("Id of the study, 1 to 32 of the characters a-z, 0-9 and -")},
               {"title", text("Title of the study")},
               {"scenarios", array(ref("ScenarioOrTuned"), "Scenarios of the study, 1 to 16")},
               {"repeats", integer("1", "Number of repeats of each scenario, 1 to 20")},
               {"ordering", optional(one_of<study::Ordering>(
                                "Order of the scenarios: random, or balanced by Williams "
                                "squares; default random"))},
               {"on_invalid", optional(one_of<store::Repetition>(
                                  "When an invalid trial is repeated; default at_end"))},
               {"seed",
                optional(integer(
                    "1", "Seed of the random orders; if it is missing, the server draws one"))},
               {"participants",
                array(ref("NewParticipant"), "Participants of the study; may be empty")}})},
      {"StudyEvent",
       object({{"at_utc_us",
                integer("us", "Time of the change, in microseconds since 1970-01-01 UTC")},
               {"who", text("Name of the account or station that made the change")},
               {"what",
                text("Kind of the change, for example made, enrolled, taken, recorded or invalid")},
               {"participant",
                nullable(text("Pseudonym of the participant; null if the change concerns none"))},
               {"trial_id", nullable(text("Id of the trial; null if the change concerns none, or "
                                          "while the trial is rated blind"))},
               {"reason", text("Reason for the change; empty if none was given")}})},
      {"StudyEvents", object({{"events", array(ref("StudyEvent"), "Changes, newest first")}})}};
}

}  // namespace api
}  // namespace tractus
