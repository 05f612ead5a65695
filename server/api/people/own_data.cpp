#include "server/api/people/own_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/clock.hpp"
#include "core/csv.hpp"
#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/finding/saved_views.hpp"
#include "db/store/people/consent.hpp"
#include "db/store/people/invitations.hpp"
#include "db/store/people/own_records.hpp"
#include "db/store/people/people.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/trials/debriefs.hpp"
#include "db/store/trials/ratings.hpp"
#include "db/store/trials/trials.hpp"
#include "lab/io/zip_file.hpp"
#include "metrics/metric.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/trials/trial_json.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kTables_bytes = 64u << 20;  ///< room for what is no recording
constexpr std::int64_t kMostTrials = 1'000'000;

/// A trial of the person whose results the person may see.
struct OwnTrial {
  store::TrialRecord record;
  std::vector<store::ScoreRecord> scores;
  std::vector<store::Comment> comments;
  std::vector<store::RatingRequest> requests;
  std::vector<store::Rating> ratings;
  std::uint64_t file_bytes = 0;
};

struct OwnData {
  std::vector<OwnTrial> trials;  ///< oldest first
  std::uint64_t held_back = 0;   ///< trials whose results are not released
  std::vector<std::pair<std::string, std::string>> files;  ///< name and content
};

std::string line_of(const std::vector<std::string>& cells) {
  std::string out;
  for (const std::string& cell : cells)
    out += (out.empty() ? "" : ",") + core::csv_person_cell(cell);
  return out + "\r\n";
}

Result<OwnTrial> own_trial(store::Reading& tx, const std::string& id) {
  OwnTrial out;
  auto record = TRY(store::trial_of(tx, id));
  core::require(record.has_value(), "a listed trial is there");
  out.record = std::move(*record);
  out.scores = TRY(store::scores_of(tx, id));
  out.comments = TRY(store::comments_of(tx, id));
  out.requests = TRY(store::rating_requests(tx, id));
  out.ratings = TRY(store::ratings_of(tx, id));
  out.file_bytes = TRY(store::object_size_bytes(tx, out.record.sha256));
  return out;
}

Json score_json(const store::ScoreRecord& score) {
  const auto known = metrics::all();
  const auto info = std::ranges::find(known, score.metric_id, &metrics::MetricInfo::id);
  return {{"metric", score.metric_id},
          {"value", score.value ? Json(*score.value) : Json()},
          {"unit", info == known.end() ? "" : std::string(info->unit)},
          {"note", score.note}};
}

/// Of the ratings that hold, of requests that are complete: as the trial's page shows them.
Json ratings_json(const OwnTrial& trial) {
  Json out = Json::array();
  for (const store::RatingRequest& request : trial.requests) {
    if (!request.complete()) continue;
    for (std::size_t i = 0; i < trial.ratings.size(); ++i) {
      const store::Rating& one = trial.ratings[i];
      const bool superseded = i + 1 < trial.ratings.size() &&
                              trial.ratings[i + 1].rubric_id == one.rubric_id &&
                              trial.ratings[i + 1].rater_id == one.rater_id;
      if (one.rubric_id != request.rubric_id || superseded) continue;
      out.push_back({{"rubric", one.rubric_id},
                     {"version", request.version},
                     {"by", one.rater},
                     {"scores", one.scores},
                     {"comment", one.comment},
                     {"made_utc_us", one.made_utc_us}});
    }
  }
  return out;
}

Json own_trial_json(const OwnTrial& trial) {
  const store::TrialRecord& record = trial.record;
  const Json events = core::stored_json(record.events);
  Json scores = Json::array(), comments = Json::array();
  for (const auto& score : trial.scores) scores.push_back(score_json(score));
  for (const auto& comment : trial.comments)
    comments.push_back({{"at_s", comment.at_s ? Json(*comment.at_s) : Json()},
                        {"text", comment.text},
                        {"by", comment.by_name},
                        {"made_utc_us", comment.made_utc_us}});
  return {{"id", record.summary.id},
          {"case", record.summary.case_title},
          {"station", record.summary.station},
          {"started_utc_us", record.summary.started_utc_us},
          {"duration_s", record.summary.duration_s},
          {"header", core::stored_json(record.header)},
          {"events", events},
          {"answer", answer_json(events)},
          {"correct", record.summary.correct ? Json(*record.summary.correct) : Json()},
          {"scores", scores},
          {"comments", comments},
          {"ratings", ratings_json(trial)}};
}

std::string trials_table(const std::vector<OwnTrial>& trials) {
  std::string out =
      line_of({"trial", "started", "duration_s", "case", "station", "complete", "correct"});
  for (const OwnTrial& one : trials) {
    const auto& s = one.record.summary;
    out += line_of({s.id, core::utc_text(s.started_utc_us), fmt::format("{}", s.duration_s),
                    s.case_title, s.station, one.record.complete ? "yes" : "no",
                    s.correct ? (*s.correct ? "yes" : "no") : ""});
  }
  return out;
}

std::string scores_table(const std::vector<OwnTrial>& trials) {
  std::string out = line_of({"trial", "metric", "value", "unit", "note"});
  for (const OwnTrial& one : trials)
    for (const auto& score : one.scores) {
      const Json json = score_json(score);
      out += line_of({one.record.summary.id, score.metric_id,
                      score.value ? fmt::format("{}", *score.value) : "",
                      json["unit"].get<std::string>(), score.note});
    }
  return out;
}

Json account_data(const store::Account& person, const std::vector<store::Cohort>& cohorts,
                  const std::vector<store::Invitation>& invitations,
                  const std::vector<store::SavedView>& views) {
  Json out = account_json(person);
  out["language"] = core::or_null(person.language);
  for (const char* list : {"cohorts", "invitations", "saved_views"}) out[list] = Json::array();
  for (const auto& one : cohorts) out["cohorts"].push_back(one.name);
  for (const auto& one : invitations) out["invitations"].push_back(one.cohort_name);
  for (const auto& one : views)
    out["saved_views"].push_back(
        {{"page", core::name(one.page)}, {"name", one.name}, {"search", one.search}});
  return out;
}

Json consents_data(const std::vector<store::Consent>& consents) {
  Json out = Json::array();
  for (const store::Consent& one : consents)
    out.push_back({{"study", one.study_id.empty() ? Json() : Json(one.study_id)},
                   {"tier", core::name(one.tier)},
                   {"basis", one.basis},
                   {"noted_utc_us", one.noted_utc_us}});
  return out;
}

Json assignments_data(const std::vector<store::Assignment>& assignments) {
  Json out = Json::array();
  for (const store::Assignment& one : assignments)
    out.push_back({{"id", one.study.id},
                   {"title", one.study.title},
                   {"due_utc_us", one.due_utc_us ? Json(*one.due_utc_us) : Json()},
                   {"results", core::name(one.release)},
                   {"done", one.done},
                   {"planned", one.planned}});
  return out;
}

Result<std::string> sign_ins_table(store::Reading& tx, const store::Account& person) {
  std::string out = line_of({"kind", "first", "last", "from", "what"});
  const auto sessions = TRY(store::session_times(tx, person.id));
  for (const auto& one : sessions)
    out += line_of(
        {"session", core::utc_text(one.made_utc_us), core::utc_text(one.seen_utc_us), "", ""});
  const auto origins = TRY(store::sign_in_origins(tx, person.id));
  for (const auto& one : origins)
    out +=
        line_of({"network of sign-ins", "", core::utc_text(one.seen_utc_us), one.origin, one.kind});
  const auto acts = TRY(store::own_acts(tx, person.name));
  for (const auto& one : acts)
    out += line_of(
        {"act", core::utc_text(one.at_utc_us), core::utc_text(one.at_utc_us), one.peer, one.what});
  return out;
}

/// Number of the person's trials, whether their results are released or not.
Result<std::uint64_t> trials_done(store::Reading& tx, const std::string& account_id) {
  const auto rows =
      TRY(tx.query("select count(*) from trial_entries where account_id = ?", {account_id}));
  return rows.front().count(0);
}

Result<OwnData> read_own(Backend& backend, const store::Account& person) {
  return backend.store.read([&](store::Reading& tx) -> Result<OwnData> {
    OwnData out;
    auto listed = TRY(store::trials_before(tx, std::numeric_limits<std::int64_t>::max(),
                                           kMostTrials, {.seen_by = person.id}));
    std::ranges::reverse(listed);
    for (const auto& one : listed) out.trials.push_back(TRY(own_trial(tx, one.id)));
    const std::uint64_t all = TRY(trials_done(tx, person.id));
    out.held_back = all - std::min<std::uint64_t>(all, out.trials.size());
    const auto cohorts = TRY(store::cohorts_of(tx, person.id));
    const auto invitations = TRY(store::invitations_for(tx, person.name));
    const auto views = TRY(store::saved_views_of(tx, person.id));
    const auto consents = TRY(store::consents_of(tx, person.id));
    const auto assignments = TRY(store::assignments_of(tx, {.done_by = person.id}));
    out.files = {{"account.json", account_data(person, cohorts, invitations, views).dump(2) + "\n"},
                 {"consents.json", consents_data(consents).dump(2) + "\n"},
                 {"assignments.json", assignments_data(assignments).dump(2) + "\n"},
                 {"trials.csv", trials_table(out.trials)},
                 {"scores.csv", scores_table(out.trials)},
                 {"sign_ins.csv", TRY(sign_ins_table(tx, person))}};
    return out;
  });
}

/// What a certificate of a curriculum rests on: as the person's own page shows it.
Result<std::string> certificates(Backend& backend, const store::Account& person) {
  const auto route = std::ranges::find(routes(), std::string("curriculaOfAccount"), &RouteInfo::id);
  core::require(route != routes().end(), "there is a route of a person's curricula");
  const Caller caller{person.role, person.id, person.name, ""};
  const http::Request request{};
  const auto response = TRY(route->handle({.backend = backend,
                                           .request = request,
                                           .caller = caller,
                                           .arguments = {{"id", person.id}},
                                           .of = Scope::own}));
  const auto* text = std::get_if<std::string>(&response.body);
  return (text ? core::stored_json(*text) : Json()).dump(2) + "\n";
}

struct Part {
  std::size_t first = 0, end = 0;  ///< of the trials
  std::uint64_t bytes = 0;
};

std::vector<Part> parts_of(const std::vector<OwnTrial>& trials) {
  std::vector<Part> out{{}};
  for (std::size_t i = 0; i < trials.size(); ++i) {
    if (out.back().bytes > 0 && out.back().bytes + trials[i].file_bytes > kOwnDataPart_bytes)
      out.push_back({i, i, 0});
    out.back().bytes += trials[i].file_bytes;
    out.back().end = i + 1;
  }
  return out;
}

std::string read_me(const store::Account& person, const OwnData& data, std::size_t part,
                    std::size_t parts, std::int64_t now_utc_us) {
  std::string out = fmt::format(
      "Data of {} on this Tractus server, as of {}. Part {} of {}.\n\n"
      "account.json        account, cohorts, invitations into cohorts, saved views\n"
      "consents.json       what research may have of your trials\n"
      "assignments.json    your assignments, and how many of their trials you have done\n"
      "trials.csv          your trials, a row each\n"
      "scores.csv          their scores, a row each, with the unit\n"
      "certificates.json   where you stand in your curricula, and what a certificate rests on\n"
      "sign_ins.csv        sessions, networks from which you signed in, and what you did, from the "
      "audit trail\n"
      "trials/ID.json      one trial: header, events, answer, scores, comments on it, ratings of "
      "it\n"
      "trials/ID.ttrial    its recording as it is stored; `tractus trial` reads it\n\n"
      "Tables and JSON are in the first part; recordings are spread over the parts.\n"
      "Times that end in _utc_us are microseconds since 1970-01-01 UTC.\n",
      person.name, core::utc_text(now_utc_us), part, parts);
  if (data.held_back > 0)
    out += fmt::format(
        "\nNot in here: {} of your trials, whose results those who assigned them have not released "
        "yet.\n",
        data.held_back);
  return out;
}

Result<void> add_recordings(lab_io::ZipFile& zip, const Backend& backend, const OwnData& data,
                            const Part& part) {
  for (std::size_t i = part.first; i < part.end; ++i) {
    const store::TrialRecord& record = data.trials[i].record;
    if (!TRY(backend.objects.size_of(record.sha256)).has_value())
      return Error{Errc::corrupt, "the recording of trial " + record.summary.id + " is missing"};
    TRY(zip.add("trials/" + record.summary.id + ".ttrial",
                TRY(backend.objects.file(record.sha256))));
  }
  return {};
}

}  // namespace

Result<std::shared_ptr<http::ScratchFile>> own_data_zip(Backend& backend, const std::string& client,
                                                        const store::Account& person,
                                                        std::int64_t part) {
  const OwnData data = TRY(read_own(backend, person));
  const auto parts = parts_of(data.trials);
  if (part < 1 || static_cast<std::size_t>(part) > parts.size())
    return Error{Errc::not_found, fmt::format("part: there are {} parts", parts.size())};
  const Part& chosen = parts[static_cast<std::size_t>(part) - 1];
  const std::uint64_t most_bytes = chosen.bytes + chosen.bytes / 64 + kTables_bytes;
  auto file = TRY(http::scratch_file(*backend.scratch, client, most_bytes));
  lab_io::ZipFile zip(file->path, most_bytes);
  TRY(zip.add("README.txt", read_me(person, data, static_cast<std::size_t>(part), parts.size(),
                                    backend.now_utc_us())));
  if (part == 1) {
    for (const auto& [name, content] : data.files) TRY(zip.add(name, content));
    TRY(zip.add("certificates.json", TRY(certificates(backend, person))));
    for (const OwnTrial& trial : data.trials)
      TRY(zip.add("trials/" + trial.record.summary.id + ".json",
                  own_trial_json(trial).dump(2) + "\n"));
  }
  TRY(add_recordings(zip, backend, data, chosen));
  TRY(zip.finish());
  return file;
}

}  // namespace api
}  // namespace tractus
