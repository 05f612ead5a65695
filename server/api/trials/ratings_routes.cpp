/// Ratings of trials: which trials are to be rated by which rubric, and what the raters said.
#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "db/store/trials/trials.hpp"
#include "server/api/backend.hpp"
#include "server/api/trials/rating_json.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxRating_bytes = 16384;
constexpr std::size_t kLongestRatingText = 2000, kLongestRatingReason = 500;
constexpr long kMostRaters = 5;
constexpr std::size_t kMostListed = 500;

Json rating_json(const store::Rating& of, bool holds, const std::string& me) {
  return {{"rater", of.rater},
          {"own", of.rater_id == me},
          {"scores", of.scores},
          {"total", of.total()},
          {"comment", of.comment},
          {"reason", of.reason},
          {"independent", of.independent},
          {"holds", holds},
          {"made_utc_us", of.made_utc_us}};
}

/// The ratings that the caller may see: all of a complete request, else the caller's own; of a
/// trainee's own trial those that hold.
Json seen_ratings(const store::RatingRequest& request, const std::vector<store::Rating>& all,
                  const Call& call) {
  Json out = Json::array();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const store::Rating& one = all[i];
    if (one.rubric_id != request.rubric_id) continue;
    const bool holds = i + 1 == all.size() || all[i + 1].rubric_id != one.rubric_id ||
                       all[i + 1].rater_id != one.rater_id;
    const bool seen = request.complete() || one.rater_id == call.caller.id;
    if (seen && (holds || call.of != Scope::own))
      out.push_back(rating_json(one, holds, call.caller.id));
  }
  return out;
}

Result<Json> request_json(store::Reading& tx, const store::RatingRequest& request,
                          const std::vector<store::Rating>& all, const Call& call) {
  const auto version = TRY(rubric_version(tx, request.rubric_id, request.version));
  auto rubric = TRY(rubric_version_json(version));
  const bool rated = std::ranges::any_of(all, [&](const store::Rating& one) {
    return one.rubric_id == request.rubric_id && one.rater_id == call.caller.id;
  });
  return Json{{"rubric", std::move(rubric)},
              {"blind", request.blind},
              {"raters", request.raters},
              {"submitted", request.submitted},
              {"complete", request.complete()},
              {"may_rate", call.of != Scope::own && (rated || !request.complete())},
              {"ratings", seen_ratings(request, all, call)}};
}

/// A trainee sees nothing of a request before it is complete.
Result<http::Response> ratings_response(const Call& call, int status) {
  auto list = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Json> {
    const auto requests = TRY(store::rating_requests(tx, call.text("id")));
    const auto ratings = TRY(store::ratings_of(tx, call.text("id")));
    Json out = Json::array();
    for (const store::RatingRequest& request : requests) {
      if (call.of == Scope::own && !request.complete()) continue;
      auto json = TRY(request_json(tx, request, ratings, call));
      out.push_back(std::move(json));
    }
    return out;
  }));
  return json_response({{"requests", std::move(list)}}, status);
}

Result<http::Response> list_ratings(const Call& call) { return ratings_response(call, 200); }

/// The newest version of the rubric.
Result<store::RubricVersion> newest_rubric(store::Reading& tx, const std::string& id) {
  const auto versions = TRY(store::rubric_versions(tx, id));
  if (id.empty() || versions.empty())
    return Error{Errc::not_found, "body: /rubric: there is no rubric with this id"};
  return versions.back();
}

Result<http::Response> add_request(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::RatingRequest out{.trial_id = call.text("id"),
                           .rubric_id = fields.text("rubric", 64),
                           .raters = fields.integer_or("raters", 2, 1, kMostRaters),
                           .made_utc_us = call.backend.now_utc_us(),
                           .made_by = call.caller.name};
  if (const Json* blind = fields.member("blind", false); blind && blind->is_boolean())
    out.blind = blind->get<bool>();
  else if (blind)
    fields.wrong("blind", "true or false is expected");
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    const auto trial = TRY(store::trial_of(tx, out.trial_id));
    if (!trial) return absent("trial", out.trial_id);
    const auto rubric = TRY(newest_rubric(tx, out.rubric_id));
    out.version = rubric.version;
    return store::add_rating_request(tx, out);
  }));
  return ratings_response(call, 201);
}

Result<http::Response> remove_request(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::remove_rating_request(tx, call.text("id"), call.text("rubric"));
  }));
  return ratings_response(call, 200);
}

std::vector<int> scores_field(core::Fields& fields) {
  std::vector<int> out;
  const Json* list = fields.member("scores");
  const bool fits = list && list->is_array() && std::ranges::all_of(*list, [](const Json& one) {
                      return one.is_number_integer() && std::abs(one.get<double>()) <= 1000.0;
                    });
  if (list && !fits) fields.wrong("scores", "an array of whole points is expected");
  if (fits)
    for (const Json& one : *list) out.push_back(one.get<int>());
  return out;
}

Result<void> check_scores(store::Reading& tx, const store::Rating& rating) {
  const auto requests = TRY(store::rating_requests(tx, rating.trial_id));
  const auto request =
      std::ranges::find(requests, rating.rubric_id, &store::RatingRequest::rubric_id);
  if (request == requests.end()) return {};  // add_rating says so
  const auto version = TRY(rubric_version(tx, request->rubric_id, request->version));
  const auto rubric = TRY(stored_rubric(version));
  return rubric.check(rating.scores, "body: /scores");
}

Result<http::Response> add_rating_route(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const store::Rating out{.trial_id = call.text("id"),
                          .rubric_id = fields.text("rubric", 64),
                          .rater_id = call.caller.id,
                          .scores = scores_field(fields),
                          .comment = fields.text_or("comment", "", kLongestRatingText),
                          .reason = fields.text_or("reason", "", kLongestRatingReason),
                          .made_utc_us = call.backend.now_utc_us()};
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(check_scores(tx, out));
    return store::add_rating(tx, out);
  }));
  return ratings_response(call, 201);
}

Result<Json> listed_json(store::Reading& tx, const Call& call,
                         const store::RatingRequest& request) {
  const auto trial = TRY(store::trial_of(tx, request.trial_id));
  const auto rubric = TRY(rubric_version(tx, request.rubric_id, request.version));
  const auto ratings = TRY(store::ratings_of(tx, request.trial_id));
  const bool own = std::ranges::any_of(ratings, [&](const store::Rating& one) {
    return one.rubric_id == request.rubric_id && one.rater_id == call.caller.id;
  });
  return Json{{"trial_id", request.trial_id},
              {"case_title", trial->summary.case_title},
              {"simulated", trial->summary.simulated},
              {"started_utc_us", trial->summary.started_utc_us},
              {"rubric_id", request.rubric_id},
              {"rubric_title", rubric.title},
              {"version", request.version},
              {"blind", request.blind},
              {"raters", request.raters},
              {"submitted", request.submitted},
              {"own", own}};
}

Result<http::Response> list_requests(const Call& call) {
  auto list = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Json> {
    const auto requests = TRY(store::rating_requests(tx, ""));
    Json out = Json::array();
    for (const store::RatingRequest& request : requests) {
      if (out.size() == kMostListed) break;
      const auto sees = TRY(sees_trial(tx, call, request.trial_id));
      if (!sees) continue;
      auto json = TRY(listed_json(tx, call, request));
      out.push_back(std::move(json));
    }
    return out;
  }));
  return json_response({{"requests", std::move(list)}});
}

RouteInfo rating_route(std::string method, std::string tail, std::string id, std::string summary,
                       std::string body, Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/trials/{id}" + tail,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = raters(),
          .object = Object::trial,
          .parameters = {path_text("id", "Id of the trial")},
          .body = std::move(body),
          .body_limit_bytes = kMaxRating_bytes,
          .answer = "TrialRatings",
          .schemas = {},
          .handle = handle};
}

std::vector<NamedSchema> rating_schemas() {
  using namespace schema;
  const Json rating = object(
      {{"rater", text("Name of the account that rated")},
       {"own", truth("True if the caller gave this rating")},
       {"scores",
        array(integer("1", "Points of one item"), "Points, in the order of the rubric's items")},
       {"total", integer("1", "Sum of the points")},
       {"comment", text("Comment of the rater; may be empty")},
       {"reason", text("Why the rating before was superseded; empty for the first")},
       {"independent", truth("True if the rater could not see another's rating of the trial")},
       {"holds", truth("True if the rater has not superseded this rating")},
       {"made_utc_us", integer("us", "Time of the rating, in microseconds since 1970-01-01 UTC")}});
  return {
      {"RatingRequest",
       object({{"rubric", ref("RubricVersion")},
               {"blind", truth("True if the trainee's name is hidden until all have rated")},
               {"raters", integer("1", "Number of people who are to rate the trial")},
               {"submitted", integer("1", "Number of people who have rated it")},
               {"complete", truth("True if all have rated; ratings are seen from then on")},
               {"may_rate", truth("True if the caller may rate, or supersede the own rating")},
               {"ratings", array(rating, "Ratings that the caller may see, by rater and time")}})},
      {"TrialRatings",
       object({{"requests", array(ref("RatingRequest"),
                                  "By what the trial is to be rated; in the answer to a trainee "
                                  "only what all have rated")}})}};
}

std::vector<NamedSchema> new_rating_schemas() {
  using namespace schema;
  return {{"NewRatingRequest",
           object({{"rubric", text("Id of the rubric, whose newest version is taken")},
                   {"blind", optional(truth("True to hide the trainee's name until all have rated; "
                                            "missing: false"))},
                   {"raters", optional(integer("1",
                                               "Number of people who are to rate, 1 to 5; "
                                               "missing: 2"))}})},
          {"NewRating",
           object({{"rubric", text("Id of the rubric")},
                   {"scores", array(integer("1", "Points of one item"),
                                    "Points, in the order of the rubric's items")},
                   {"comment", optional(text("Comment, at most 2000 bytes"))},
                   {"reason", optional(text("Why the own rating before is superseded, at most 500 "
                                            "bytes; expected if there is one"))}})}};
}

RouteInfo requests_route() {
  using namespace schema;
  RouteInfo out =
      rating_route("GET", "", "ratingRequests",
                   "List the trials that are to be rated, newest request first", "", list_requests);
  out.path = "/api/v1/ratings";
  out.object = Object::none;
  out.parameters.clear();
  out.answer = "RatingRequestList";
  out.schemas = {
      {"RatingRequestList",
       object(
           {{"requests",
             array(object({{"trial_id", text("Id of the trial")},
                           {"case_title", text("Title of the case or scenario")},
                           {"simulated", truth("True if a simulated hand did the trial")},
                           {"started_utc_us", integer("us",
                                                      "Start of the trial, in microseconds "
                                                      "since 1970-01-01 UTC")},
                           {"rubric_id", text("Id of the rubric")},
                           {"rubric_title", text("Title of the rubric")},
                           {"version", integer("1", "Version of the rubric")},
                           {"blind", truth("True if the trainee's name is hidden until all "
                                           "have rated")},
                           {"raters", integer("1", "Number of people who are to rate the trial")},
                           {"submitted", integer("1", "Number of people who have rated it")},
                           {"own", truth("True if the caller has rated it")}}),
                   "Trials to rate, at most 500")}})}};
  return out;
}

}  // namespace

std::vector<RouteInfo> ratings_routes() {
  RouteInfo list =
      rating_route("GET", "/ratings", "trialRatings",
                   "Read by what a trial is to be rated, and its ratings", "", list_ratings);
  list.who.push_back({Role::trainee, Scope::own});
  list.schemas = rating_schemas();
  RouteInfo add = rating_route("POST", "/ratings", "addRating",
                               "Rate a trial by a rubric, or supersede the caller's own rating",
                               "NewRating", add_rating_route);
  add.schemas = new_rating_schemas();
  RouteInfo withdraw = rating_route("DELETE", "/rating-requests/{rubric}", "withdrawRatingRequest",
                                    "Withdraw that a trial is to be rated by a rubric, while "
                                    "nobody has rated it",
                                    "", remove_request);
  withdraw.parameters.push_back(path_text("rubric", "Id of the rubric"));
  return {list, add,
          rating_route("POST", "/rating-requests", "askForRating", "Have a trial rated by a rubric",
                       "NewRatingRequest", add_request),
          withdraw, requests_route()};
}

}  // namespace api
}  // namespace tractus
