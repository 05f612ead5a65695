/// Talking about a trial: comments on its moments, and experts' trials on the same case beside it.
#include <set>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/trials/debriefs.hpp"
#include "db/store/trials/ratings.hpp"
#include "server/api/access.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/trial_signals.hpp"
#include "server/jobs/case_facts.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxComment_bytes = 16384;
constexpr std::size_t kMaxComment = 4000;
constexpr double kLatestComment_s = 1e6;
constexpr std::size_t kPoints = 2000;

Json comment_json(const store::Comment& comment, const std::string& me) {
  return {{"id", comment.id},           {"at_s", comment.at_s ? Json(*comment.at_s) : Json()},
          {"text", comment.text},       {"by", comment.by_name},
          {"own", comment.by_id == me}, {"made_utc_us", comment.made_utc_us}};
}

Result<http::Response> comments_response(const Call& call, int status) {
  const auto found = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::comments_of(tx, call.text("id")); }));
  Json list = Json::array();
  for (const auto& comment : found) list.push_back(comment_json(comment, call.caller.id));
  return json_response({{"comments", list}}, status);
}

Result<http::Response> list_comments(const Call& call) { return comments_response(call, 200); }

Result<http::Response> add_comment(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::Comment comment{.id = core::new_id(),
                         .trial_id = call.text("id"),
                         .at_s = {},
                         .text = fields.text("text", kMaxComment),
                         .by_id = call.caller.id,
                         .by_name = call.caller.name,
                         .made_utc_us = call.backend.now_utc_us()};
  if (comment.text.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("text", "a comment is expected");
  const Json* at = fields.member("at_s", false);
  if (at && !at->is_null()) comment.at_s = fields.number("at_s", 0.0, kLatestComment_s);
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    auto trial = TRY(store::trial_of(tx, comment.trial_id));
    if (!trial) return Error{Errc::not_found, "no trial " + comment.trial_id.substr(0, 32)};
    return store::add_comment(tx, comment);
  }));
  return comments_response(call, 201);
}

Result<http::Response> remove_comment(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::remove_comment(tx, call.text("id"), call.text("comment"), call.caller.id);
  }));
  return comments_response(call, 200);
}

/// The answer names a person only if the caller may see this person's trials and none is rated blind.
Result<http::Response> references_response(const Call& call) {
  struct Found {
    bool own;
    std::vector<store::ReferenceTrial> others;
    std::set<std::string> named;  ///< trials of people whom the caller may see
  };
  const auto found = TRY(call.backend.store.read([&](store::Reading& tx) -> Result<Found> {
    auto own = TRY(store::is_reference(tx, call.text("id")));
    auto others = TRY(store::references_for(tx, call.text("id")));
    Found out{own, std::move(others), {}};
    const auto hidden = TRY(store::trials_with_hidden_name(tx));
    for (const auto& one : out.others) {
      if (hidden.contains(one.trial_id)) continue;
      auto sees = TRY(call.of == Scope::all
                          ? Result<bool>(true)
                          : relates(tx, call.caller, call.of, Object::trial, one.trial_id));
      if (sees) out.named.insert(one.trial_id);
    }
    return out;
  }));
  Json list = Json::array();
  for (const auto& one : found.others)
    list.push_back({{"id", one.trial_id},
                    {"operator", found.named.contains(one.trial_id) ? one.operator_name : ""},
                    {"simulated", one.simulated},
                    {"started_utc_us", one.started_utc_us},
                    {"duration_s", one.duration_s}});
  return json_response({{"reference", found.own}, {"trials", list}});
}

Result<http::Response> set_reference(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const Json* reference = fields.member("reference");
  if (reference && !reference->is_boolean()) fields.wrong("reference", "true or false is expected");
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::set_reference(tx, call.text("id"), reference->get<bool>(), call.caller.name,
                                call.backend.now_utc_us());
  }));
  return references_response(call);
}

Json tips_json(const trial::Path& path) {
  Json out = Json::array();
  for (const math::Vec3& tip : path.tip_m) out.push_back({tip.x(), tip.y(), tip.z()});
  return out;
}

Result<Json> palpated(Backend& backend, const trial::Signals& signals, const std::string& case_id) {
  auto facts = TRY(jobs::case_facts(backend.store, backend.objects, case_id));
  const trial::Path path = signals.path(kPoints);
  Json depths = Json::array();
  for (const math::Vec3& tip : path.tip_m) depths.push_back(facts.definition.tract.depth_of(tip));
  return Json{{"t_s", path.t_s},
              {"depth_m", depths},
              {"force_N", path.force_N},
              {"tip_m", tips_json(path)}};
}

/// The path of a trial that is offered as an example on the same case.
Result<http::Response> reference_way(const Call& call) {
  const std::string& id = call.text("reference");
  auto record = TRY(
      call.backend.store.read([&](store::Reading& tx) -> Result<std::optional<store::TrialRecord>> {
        auto offered = TRY(store::references_for(tx, call.text("id")));
        for (const auto& one : offered)
          if (one.trial_id == id) return store::trial_of(tx, id);
        return std::optional<store::TrialRecord>();
      }));
  if (!record)
    return Error{Errc::not_found, "no trial with this id is offered as an example on this case"};
  auto signals = TRY(signals_of(call.backend, id));
  if (signals->rig() == trial::Rig::palpation) {
    auto way = TRY(palpated(call.backend, *signals, record->summary.case_id));
    return json_response(way);
  }
  const auto curve = signals->force_against_depth(kPoints);
  return json_response({{"t_s", curve.t_s},
                        {"depth_m", curve.depth_m},
                        {"force_N", curve.force_N},
                        {"tip_m", Json()}});
}

RouteInfo comment_route(std::string method, std::string tail, std::string id, std::string summary,
                        std::string body, std::string answer,
                        Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = method,
                .path = "/api/v1/trials/{id}" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin, {Role::faculty, Scope::cohort}},
                .object = Object::trial,
                .parameters = {path_text("id", "Id of the trial")},
                .body = std::move(body),
                .body_limit_bytes = kMaxComment_bytes,
                .answer = std::move(answer),
                .schemas = {},
                .handle = handle};
  if (method != "GET") return out;
  out.who.push_back(Role::director);
  out.who.push_back({Role::trainee, Scope::own});
  return out;
}

std::vector<NamedSchema> comment_schemas() {
  using namespace schema;
  return {
      {"TrialComment",
       object({{"id", text("Id of the comment, which never changes")},
               {"at_s", nullable(number(
                            "s",
                            "Moment of the trial that the comment is about, in seconds since the "
                            "start of the trial; null if the comment is about the whole trial"))},
               {"text", text("Text of the comment")},
               {"by", text("Name of the account that wrote the comment")},
               {"own", truth("True if the caller wrote the comment and can remove it")},
               {"made_utc_us",
                integer("us", "Time of the comment, in microseconds since 1970-01-01 UTC")}})},
      {"TrialComments",
       object({{"comments",
                array(ref("TrialComment"), "Comments, sorted by the moment of the trial")}})},
      {"NewComment",
       object({{"at_s",
                optional(nullable(number(
                    "s",
                    "Moment of the trial that the comment is about, in seconds since the start of "
                    "the trial; null or missing: the comment is about the whole trial")))},
               {"text", text("Text of the comment, at most 4000 characters")}})}};
}

std::vector<NamedSchema> reference_schemas() {
  using namespace schema;
  const Json one = object(
      {{"id", text("Id of the trial")},
       {"operator",
        text("Name of the person who did the trial; empty if the caller may not see this person")},
       {"simulated", truth("True if a simulated hand did the trial")},
       {"started_utc_us",
        integer("us", "Start of the trial, in microseconds since 1970-01-01 UTC")},
       {"duration_s", number("s", "Duration of the trial, in seconds")}});
  const Json tip = tuple(number("m", "One coordinate x, y or z, in metres"), 3,
                         "Position of the tip in patient coordinates (LPS), in metres");
  return {{"ReferenceTrials",
           object({{"reference", truth("True if this trial itself is offered as an example")},
                   {"trials", array(one, "Example trials on the same case, newest first")}})},
          {"ReferenceWish",
           object({{"reference",
                    truth("True to offer the trial as an example, false to withdraw it")}})},
          {"ReferenceWay",
           object({{"t_s", array(number("s", "Time since the start of the trial, in seconds"),
                                 "Times in ascending order, in seconds")},
                   {"depth_m", array(number("m", "Depth of the tip along the tract, in metres"),
                                     "Depth of the tip at each time")},
                   {"force_N", array(number("N",
                                            "Palpation: magnitude of the force; probing: pushing "
                                            "force of the hand; in newtons"),
                                     "Force at each time")},
                   {"tip_m",
                    nullable(array(
                        tip, "Position of the tip at each time; null for a probing trial"))}})}};
}

}  // namespace

std::vector<RouteInfo> comments_routes() {
  RouteInfo list =
      comment_route("GET", "/comments", "trialComments", "List the comments on a trial", "",
                    "TrialComments", list_comments);
  list.schemas = comment_schemas();
  RouteInfo take =
      comment_route("DELETE", "/comments/{comment}", "removeComment",
                    "Remove one of the caller's comments", "", "TrialComments", remove_comment);
  take.parameters.push_back(path_text("comment", "Id of the comment"));
  RouteInfo offered = comment_route("GET", "/references", "trialReferences",
                                    "List the trials on the same case that are offered as examples",
                                    "", "ReferenceTrials", references_response);
  offered.schemas = reference_schemas();
  RouteInfo way =
      comment_route("GET", "/references/{reference}", "referenceWay",
                    "Read the path of an example trial: position, depth and force over time", "",
                    "ReferenceWay", reference_way);
  way.parameters.push_back(path_text("reference", "Id of the example trial"));
  // The example may belong to any person: it is offered to all who did a trial on its case.
  way.ends = {
      {"reference", Object::trial, {Role::admin, Role::director, Role::faculty, Role::trainee}}};
  return {list,
          comment_route("POST", "/comments", "addComment",
                        "Comment on a trial or on one moment of a trial", "NewComment",
                        "TrialComments", add_comment),
          take,
          offered,
          comment_route("POST", "/reference", "setReference",
                        "Offer a trial as an example on its case, or withdraw the offer",
                        "ReferenceWish", "ReferenceTrials", set_reference),
          way};
}

}  // namespace api
}  // namespace tractus
