#include "db/store/trials/ratings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "core/json.hpp"
#include "core/try.hpp"
#include "db/store/rows.hpp"
#include "db/store/trials/summary_row.hpp"

namespace tractus {
namespace store {
namespace {

using core::Errc;
using core::Error;

constexpr const char* kRubric =
    "select id, version, title, definition, reason, made_utc_us, made_by from rubrics ";
/// People who have rated by the request `q`.
constexpr const char* kSubmitted =
    "(select count(distinct g.rater_id) from ratings g where g.trial_id = q.trial_id and "
    "g.rubric_id = q.rubric_id)";

core::Result<RubricVersion> rubric_from(const Row& row) {
  return RubricVersion{row.text(0), row.integer(1), row.text(2), row.text(3),
                       row.text(4), row.integer(5), row.text(6)};
}

core::Result<RatingRequest> request_from(const Row& row) {
  return RatingRequest{.trial_id = row.text(0),
                       .rubric_id = row.text(1),
                       .version = row.integer(2),
                       .blind = row.truth(3),
                       .raters = row.integer(4),
                       .made_utc_us = row.integer(5),
                       .made_by = row.text(6),
                       .submitted = row.integer(7)};
}

core::Result<Rating> rating_from(const Row& row) {
  Rating out{.trial_id = row.text(0),
             .rubric_id = row.text(1),
             .rater_id = row.text(2),
             .number = row.integer(3),
             .scores = {},
             .comment = row.text(5),
             .reason = row.text(6),
             .independent = row.truth(7),
             .made_utc_us = row.integer(8),
             .rater = row.text(9)};
  const core::Json scores = core::stored_json(row.text(4));
  for (const core::Json& score : scores) {
    if (!score.is_number_integer())
      return Error{Errc::corrupt, "ratings.scores: whole numbers are expected"};
    out.scores.push_back(score.get<int>());
  }
  return out;
}

core::Result<RatingRequest> request_for(Reading& tx, const Rating& rating) {
  const auto requests = TRY(rating_requests(tx, rating.trial_id));
  for (const RatingRequest& one : requests)
    if (one.rubric_id == rating.rubric_id) return one;
  return Error{Errc::not_found, "this trial is not to be rated by this rubric"};
}

/// How often this rater has rated the trial by this rubric.
core::Result<std::int64_t> ratings_before(Reading& tx, const Rating& rating) {
  const auto rows = TRY(
      tx.query("select count(*) from ratings where trial_id = ? and rubric_id = ? and rater_id = ?",
               {rating.trial_id, rating.rubric_id, rating.rater_id}));
  return rows.front().integer(0);
}

}  // namespace

int Rating::total() const { return std::accumulate(scores.begin(), scores.end(), 0); }

core::Result<std::int64_t> add_rubric(Writing& tx, const RubricVersion& of) {
  const auto before = TRY(rubric_versions(tx, of.id));
  const std::int64_t version = std::int64_t(before.size()) + 1;
  TRY(
      tx.query("insert into rubrics (id, version, title, definition, reason, made_utc_us, made_by) "
               "values (?, ?, ?, ?, ?, ?, ?)",
               {of.id, version, of.title, of.definition, of.reason, of.made_utc_us, of.made_by}));
  return version;
}

core::Result<std::vector<RubricVersion>> rubric_versions(Reading& tx, const std::string& id) {
  return all_of(
      tx.query(std::string(kRubric) + "where ? = '' or id = ? order by id, version", {id, id}),
      rubric_from);
}

core::Result<void> add_rating_request(Writing& tx, const RatingRequest& of) {
  const auto before = TRY(rating_requests(tx, of.trial_id));
  if (std::ranges::find(before, of.rubric_id, &RatingRequest::rubric_id) != before.end())
    return Error{Errc::conflict, "this trial is to be rated by this rubric already"};
  TRY(tx.query(
      "insert into rating_requests (trial_id, rubric_id, version, blind, raters, made_utc_us, "
      "made_by) values (?, ?, ?, ?, ?, ?, ?)",
      {of.trial_id, of.rubric_id, of.version, bool_value(of.blind), of.raters, of.made_utc_us,
       of.made_by}));
  return renew_trial_entry(tx, of.trial_id);
}

core::Result<std::vector<RatingRequest>> rating_requests(Reading& tx, const std::string& trial_id) {
  return all_of(tx.query(std::string("select q.trial_id, q.rubric_id, q.version, q.blind, "
                                     "q.raters, q.made_utc_us, q.made_by, ") +
                             kSubmitted +
                             " from rating_requests q where ? = '' or q.trial_id = ? order by "
                             "q.made_utc_us desc, q.trial_id, q.rubric_id",
                         {trial_id, trial_id}),
                request_from);
}

core::Result<void> remove_rating_request(Writing& tx, const std::string& trial_id,
                                         const std::string& rubric_id) {
  const auto request = TRY(request_for(tx, Rating{.trial_id = trial_id, .rubric_id = rubric_id}));
  if (request.submitted > 0)
    return Error{Errc::conflict,
                 "somebody has rated this trial by this rubric: that is kept, and the trial stays "
                 "to be rated"};
  TRY(tx.query("delete from rating_requests where trial_id = ? and rubric_id = ?",
               {trial_id, rubric_id}));
  return renew_trial_entry(tx, trial_id);
}

core::Result<void> add_rating(Writing& tx, const Rating& rating) {
  const auto request = TRY(request_for(tx, rating));
  const auto before = TRY(ratings_before(tx, rating));
  if (before == 0 && request.complete())
    return Error{Errc::conflict,
                 fmt::format("this trial has its {} ratings by this rubric", request.raters)};
  if (before > 0 && rating.reason.empty())
    return Error{Errc::conflict,
                 "you have rated this trial by this rubric: a submitted rating is not changed; "
                 "give a reason to supersede it"};
  core::Json scores = core::Json::array();
  for (const int score : rating.scores) scores.push_back(score);
  TRY(tx.query(
      "insert into ratings (trial_id, rubric_id, rater_id, number, scores, comment, reason, "
      "independent, made_utc_us) values (?, ?, ?, ?, ?, ?, ?, ?, ?)",
      {rating.trial_id, rating.rubric_id, rating.rater_id, before + 1, scores.dump(),
       rating.comment, before > 0 ? rating.reason : std::string(), bool_value(!request.complete()),
       rating.made_utc_us}));
  return renew_trial_entry(tx, rating.trial_id);
}

core::Result<std::vector<Rating>> ratings_of(Reading& tx, const std::string& trial_id) {
  return all_of(
      tx.query("select g.trial_id, g.rubric_id, g.rater_id, g.number, g.scores, g.comment, "
               "g.reason, g.independent, g.made_utc_us, a.name from ratings g join accounts a on "
               "a.id = g.rater_id where ? = '' or g.trial_id = ? order by g.rubric_id, a.name, "
               "g.rater_id, g.number",
               {trial_id, trial_id}),
      rating_from);
}

core::Result<std::map<std::string, std::map<std::string, double>>> rating_scores(Reading& tx) {
  std::map<std::string, std::map<std::string, double>> out;
  const auto requests = TRY(rating_requests(tx, ""));
  if (requests.empty()) return out;
  const auto ratings = TRY(ratings_of(tx, ""));
  std::map<std::pair<std::string, std::string>, std::map<std::string, int>> totals;
  for (const Rating& one : ratings)  // a later number takes the place of the one before
    totals[{one.trial_id, one.rubric_id}][one.rater_id] = one.total();
  for (const RatingRequest& request : requests) {
    if (!request.complete()) continue;
    const auto& of_trial = totals[{request.trial_id, request.rubric_id}];
    double sum = 0.0;
    for (const auto& [_, total] : of_trial) sum += total;
    out[request.trial_id][fmt::format("{}{}_v{}", kRatingScore, request.rubric_id,
                                      request.version)] = sum / double(of_trial.size());
  }
  return out;
}

core::Result<std::set<std::string>> trials_with_hidden_name(Reading& tx) {
  const auto rows = TRY(tx.query("select t.id from trials t where " + name_hidden_sql()));
  std::set<std::string> out;
  for (const Row& row : rows) out.insert(row.text(0));
  return out;
}

std::string name_hidden_sql() {
  return std::string(
             "exists (select 1 from rating_requests q where q.trial_id = t.id and q.blind = 1 and "
             "q.raters > ") +
         kSubmitted + ")";
}

}  // namespace store
}  // namespace tractus
