#include "server/api/cohort/export.hpp"

#include <fmt/format.h>

#include <array>

#include "core/csv.hpp"
#include "core/try.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/trials/ratings.hpp"
#include "metrics/metric.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

std::string cell(std::string_view text) { return core::csv_person_cell(text); }

std::string cell(const std::optional<double>& number) {
  return number ? fmt::format("{}", *number) : "";
}

struct Column {
  const char *table, *column, *type, *unit, *meaning;
};
constexpr std::array kColumns{
    Column{"summary", "participant", "text", "", "pseudonym of the person, or of the machine"},
    Column{"summary", "study", "text", "", "id of the study or assignment; empty if there is none"},
    Column{"summary", "rig", "text", "", "palpation or probing"},
    Column{"summary", "level", "text", "", "level of training, as the study states it"},
    Column{"summary", "experience_years", "number", "a",
           "surgical experience in years, as the study states it"},
    Column{"summary", "simulated", "truth", "",
           "1 if a simulated hand or machine did the trials, else 0"},
    Column{"summary", "trials", "integer", "1",
           "number of trials of the participant in the study on the rig"},
    Column{"summary", "answered", "integer", "1", "number of these trials with an answer"},
    Column{"summary", "correct", "integer", "1", "number of these trials with the correct answer"},
    Column{"trials", "trial", "text", "", "pseudonym of the trial, the same in every export"},
    Column{"trials", "participant", "text", "", "pseudonym of the person, or of the machine"},
    Column{"trials", "study", "text", "", "id of the study or assignment; empty if there is none"},
    Column{"trials", "number", "integer", "1",
           "place of the trial in the participant's order, counted from 1"},
    Column{"trials", "level", "text", "", "level of training, as the study states it"},
    Column{"trials", "experience_years", "number", "a",
           "surgical experience in years, as the study states it"},
    Column{"trials", "case", "text", "", "title of the case or scenario"},
    Column{"trials", "rig", "text", "", "palpation or probing"},
    Column{"trials", "simulated", "truth", "",
           "1 if a simulated hand or machine did the trial, else 0"},
    Column{"trials", "days", "number", "d",
           "days since the participant's first trial on this server"},
    Column{"trials", "duration_s", "number", "s",
           "time from the first to the last sample, in seconds"},
    Column{"trials", "samples", "integer", "1", "number of samples in the trial's file"},
    Column{"trials", "complete", "truth", "", "1 if the trial was ended, 0 if it was interrupted"},
    Column{"trials", "counts", "truth", "",
           "1 if the trial counts for its study, else 0; empty if it belongs to no study"},
    Column{"trials", "correct", "truth", "",
           "1 if the answer agrees with the truth, else 0; empty if there is no answer"},
    Column{"scores", "trial", "text", "", "pseudonym of the trial, the same in every export"},
    Column{"scores", "score", "text", "", "id of the score; the scores are defined below"},
    Column{"scores", "value", "number", "by score", "value of the score"},
    Column{"scores", "unit", "text", "", "unit of the value"},
};
constexpr std::array kPalpation{
    Column{"palpation", "t_s", "number", "s", "time since the start of the trial"},
    Column{"palpation", "px_m", "number", "m",
           "x of the handle's origin in the volume's frame (LPS)"},
    Column{"palpation", "py_m", "number", "m",
           "y of the handle's origin in the volume's frame (LPS)"},
    Column{"palpation", "pz_m", "number", "m",
           "z of the handle's origin in the volume's frame (LPS)"},
    Column{"palpation", "qw", "number", "1",
           "w of the handle's orientation quaternion in the volume's frame"},
    Column{"palpation", "qx", "number", "1",
           "x of the handle's orientation quaternion in the volume's frame"},
    Column{"palpation", "qy", "number", "1",
           "y of the handle's orientation quaternion in the volume's frame"},
    Column{"palpation", "qz", "number", "1",
           "z of the handle's orientation quaternion in the volume's frame"},
    Column{"palpation", "fx_N", "number", "N",
           "x of the force of the bone on the probe, in the handle's frame"},
    Column{"palpation", "fy_N", "number", "N",
           "y of the force of the bone on the probe, in the handle's frame"},
    Column{"palpation", "fz_N", "number", "N",
           "z of the force of the bone on the probe, in the handle's frame"},
    Column{"palpation", "tx_Nm", "number", "N m",
           "x of the torque of the bone on the probe about the handle's origin, in the handle's "
           "frame"},
    Column{"palpation", "ty_Nm", "number", "N m",
           "y of the torque of the bone on the probe about the handle's origin, in the handle's "
           "frame"},
    Column{"palpation", "tz_Nm", "number", "N m",
           "z of the torque of the bone on the probe about the handle's origin, in the handle's "
           "frame"},
    Column{"palpation", "flags", "integer", "1",
           "flag bits of the format tractus-trial/2, for example late or limited"},
};
constexpr std::array kProbing{
    Column{"probing", "t_s", "number", "s", "time since the start of the trial"},
    Column{"probing", "x_m", "number", "m",
           "depth of the tip from the entry, positive into the bone"},
    Column{"probing", "theta_rad", "number", "rad", "angle of rotation about x, unwrapped"},
    Column{"probing", "fz_N", "number", "N",
           "pushing force of the hand along x, positive into the bone"},
    Column{"probing", "tz_Nm", "number", "N m", "torque of the hand about x"},
    Column{"probing", "speed_m_s", "number", "m/s", "speed of the tip, as the actuator reports it"},
    Column{"probing", "mode", "integer", "1",
           "mode of the controller, as the format tractus-trial/2 defines it"},
    Column{"probing", "flags", "integer", "1",
           "flag bits of the format tractus-trial/2, for example late or limited"},
};

std::string csv_header(std::string_view table) {
  std::string out;
  for (const Column& column : kColumns)
    if (column.table == table) out += (out.empty() ? "" : ",") + std::string(column.column);
  return out + "\r\n";
}

}  // namespace

Result<store::ReleasedTrials> released_trials(Backend& backend, const std::string& study,
                                              store::Tier least) {
  return backend.store.read([&](store::Reading& tx) {
    return store::ReleasedTrials::read(tx, backend.pseudonym_key, {.study = study, .least = least});
  });
}

std::string trials_csv(const store::ReleasedTrials& trials) {
  std::string out = csv_header("trials");
  for (const store::ReleasedTrial& t : trials.all()) {
    const bool in_study = !t.study.empty();
    out +=
        fmt::format("{},{},{},{},{},{},{},{},{},{:.4f},{},{},{},{},{}\r\n", t.id,
                    cell(t.participant), cell(t.study), in_study ? std::to_string(t.number) : "",
                    cell(t.level), cell(t.experience_years), cell(t.case_title), trial::name(t.rig),
                    t.simulated ? 1 : 0, t.days, t.duration_s, t.samples, t.complete ? 1 : 0,
                    in_study ? (t.place == store::StudyTrialState::counts ? "1" : "0") : "",
                    t.correct ? (*t.correct ? "1" : "0") : "");
  }
  return out;
}

std::string summary_csv(const store::ReleasedTrials& trials) {
  struct Sum {
    const store::ReleasedTrial* first;
    int trials = 0, answered = 0, correct = 0;
  };
  std::map<std::array<std::string, 3>, Sum> sums;
  for (const store::ReleasedTrial& t : trials.all()) {
    Sum& sum = sums.try_emplace({t.participant, t.study, std::string(trial::name(t.rig))}, Sum{&t})
                   .first->second;
    ++sum.trials;
    sum.answered += t.correct.has_value();
    sum.correct += t.correct.value_or(false);
  }
  std::string out = csv_header("summary");
  for (const auto& [key, sum] : sums)
    out += fmt::format("{},{},{},{},{},{},{},{},{}\r\n", cell(key[0]), cell(key[1]), cell(key[2]),
                       cell(sum.first->level), cell(sum.first->experience_years),
                       sum.first->simulated ? 1 : 0, sum.trials, sum.answered, sum.correct);
  return out;
}

std::string scores_csv(const store::ReleasedTrials& trials) {
  std::map<std::string, std::string> units;
  for (const auto& metric : metrics::all()) units[metric.id] = metric.unit;
  std::string out = "trial,score,value,unit\r\n";
  for (const store::ReleasedTrial& t : trials.all())
    for (const auto& [id, value] : t.metrics)
      out += fmt::format("{},{},{},{}\r\n", t.id, cell(id), value,
                         cell(id.starts_with(store::kRatingScore) ? "1" : units[id]));
  return out;
}

Result<std::string> key_csv(Backend& backend) {
  using Lines = std::map<std::string, std::string>;
  auto lines = TRY(backend.store.read([&](store::Reading& tx) -> Result<Lines> {
    auto people = TRY(store::who_is_who(tx, backend.pseudonym_key));
    std::map<std::string, std::string> accounts;
    auto all = TRY(store::all_accounts(tx));
    for (const auto& account : all) accounts[account.id] = account.name;
    Lines out;
    for (const auto& [pseudonym, person] : people) {
      const auto colon = person.find(':');
      const std::string kind = person.substr(0, colon), id = person.substr(colon + 1);
      const auto account = accounts.find(id);
      const bool known = kind == "account" && account != accounts.end();
      out[pseudonym] = kind + "," + cell(known ? account->second : id);
    }
    return out;
  }));
  std::string out = "participant,kind,name\r\n";
  for (const auto& [pseudonym, rest] : lines) out += pseudonym + "," + rest + "\r\n";
  return out;
}

std::string dictionary_csv() {
  std::string out = "table,column,type,unit,meaning\r\n";
  const auto add = [&](const auto& columns) {
    for (const Column& c : columns)
      out += fmt::format("{},{},{},{},{}\r\n", c.table, c.column, c.type, cell(c.unit),
                         cell(c.meaning));
  };
  add(kColumns);
  for (const auto& metric : metrics::all())
    out += fmt::format("scores,{},number,{},{}\r\n", cell(metric.id), cell(metric.unit),
                       cell(metric.definition));
  out +=
      fmt::format("scores,{}RUBRIC_vVERSION,number,1,{}\r\n", store::kRatingScore,
                  cell("rating by people: mean over the raters of the sum of the items' scores"));
  add(kPalpation);
  add(kProbing);
  return out;
}

}  // namespace api
}  // namespace tractus
