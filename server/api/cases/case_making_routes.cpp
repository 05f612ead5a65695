/// Making a case of a released volume: what a planned tract meets, the making, retiring.
#include <fmt/format.h>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/cases/case_makings.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/jobs.hpp"
#include "server/api/backend.hpp"
#include "server/api/cases/tract_plan.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/jobs/make_case.hpp"
#include "server/jobs/source_volume.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::uint64_t kMaxBody_bytes = 4096;
constexpr std::size_t kMaxTitle = 200;
constexpr std::int64_t kMostShown = 50;

Result<http::Response> look_at_tract(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const auto plan = TRY(jobs::plan_from(fields));
  TRY(fields.done());
  const auto source =
      TRY(jobs::released_volume(call.backend.store, call.backend.objects, call.text("id")));
  const auto ct = jobs::read_about(source.file, plan.entry_m, plan.target_m);
  if (!ct && ct.error().code == Errc::out_of_range)
    return json_response(no_tract_json(plan, ct.error().what));
  if (!ct) return ct.error();
  return json_response(tract_json(*ct, models::PalpationModel{}.transfer, plan));
}

Json making_json(const store::CaseMaking& making) {
  return {{"id", making.id},
          {"volume", making.volume_id},
          {"title", making.title},
          {"state", making.state},
          {"share", making.share},
          {"phase", making.phase},
          {"error", making.error},
          {"case_id", making.case_id ? Json(*making.case_id) : Json()},
          {"made_utc_us", making.made_utc_us},
          {"made_by", making.made_by}};
}

Result<http::Response> making_response(const Call& call, const std::string& id, int status) {
  const auto making = TRY(
      call.backend.store.read([&](store::Reading& tx) { return store::case_making_of(tx, id); }));
  if (!making) return Error{Errc::not_found, "no making of a case " + id.substr(0, 32)};
  return json_response(making_json(*making), status);
}

Result<http::Response> one_making(const Call& call) {
  return making_response(call, call.text("id"), 200);
}

Result<http::Response> list_makings(const Call& call) {
  const auto found = TRY(call.backend.store.read(
      [](store::Reading& tx) { return store::case_makings(tx, kMostShown); }));
  Json list = Json::array();
  for (const auto& making : found) list.push_back(making_json(making));
  return json_response({{"makings", list}});
}

Result<store::CaseMaking> making_from(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::CaseMaking out;
  out.id = core::new_id();
  out.volume_id = fields.text("volume", 64);
  out.title = fields.text("title", kMaxTitle);
  if (out.title.find_first_not_of(" \t\r\n") == std::string::npos)
    fields.wrong("title", "a title is expected");
  const auto plan = TRY(jobs::plan_from(fields));
  TRY(fields.done());
  out.plan = jobs::plan_json(plan).dump();
  out.made_utc_us = call.backend.now_utc_us();
  out.made_by = call.caller.name;
  return out;
}

Result<http::Response> make(const Call& call) {
  const auto making = TRY(making_from(call));
  TRY(jobs::released_volume(call.backend.store, call.backend.objects, making.volume_id));
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(store::add_case_making(tx, making));
    return store::queue_job(tx, "case", making.id, making.made_utc_us);
  }));
  call.backend.work_waits();
  return making_response(call, making.id, 201);
}

Result<http::Response> retire(const Call& call) {
  auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const Json* retired = fields.member("retired");
  if (retired && !retired->is_boolean()) fields.wrong("retired", "true or false is expected");
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::set_case_retired(tx, call.text("id"), retired->get<bool>(),
                                   call.backend.now_utc_us());
  }));
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

std::vector<schema::Field> plan_fields() {
  using namespace schema;
  const Json point = tuple(number("m", "x, y or z"), 3, "in the volume's frame, LPS");
  return {{"entry_m", point},
          {"target_m", point},
          {"radius_m", optional(number("m", "of the drill; 0.0015 without"))},
          {"channel", optional(one_of({"drilled", "planned"},
                                      "planned: the bone is left whole, "
                                      "for drilling; drilled without"))},
          {"breach", optional(nullable(ref("BreachWish")))}};
}

std::vector<NamedSchema> tract_schemas() {
  using namespace schema;
  const Json wall = one_of({"medial", "lateral", "superior", "inferior", "anterior"}, "which");
  const Json point = tuple(number("m", "x, y or z"), 3, "in the volume's frame, LPS");
  const Json thinnest = object({{"at_m", number("m", "depth along the tract")},
                                {"inner_m", number("m", "from the axis to the bone")},
                                {"thickness_m", number("m", "of the bone")}});
  return {
      {"BreachWish",
       object({{"wall", wall},
               {"depth_m", optional(number("m", "beyond the bone; 0.003 without"))},
               {"at_m", optional(number("m", "along the tract; where it is thinnest without"))}})},
      {"TractWish", object(plan_fields())},
      {"PlannedWall",
       object({{"wall", wall},
               {"depth_m", array(number("m", "along the tract"), "where it was looked for")},
               {"inner_m", array(nullable(number("m", "from the axis")), "where bone begins")},
               {"thickness_m", array(nullable(number("m", "of the bone")), "null: not found")},
               {"thinnest", nullable(thinnest)}})},
      {"PlannedBreach", object({{"wall", wall},
                                {"at_m", number("m", "depth along the tract")},
                                {"breach_m", point},
                                {"from_m", point},
                                {"tip_m", point},
                                {"depth_m", number("m", "beyond the bone")},
                                {"inner_m", number("m", "from the axis to the bone")},
                                {"wall_thickness_m", number("m", "of the bone that gives way")}})},
      {"PlannedTract", object({{"length_m", number("m", "from entry to target")},
                               {"side", nullable(one_of({"left", "right"}, "of the patient"))},
                               {"tract", nullable(ref("Tract"))},
                               {"walls", array(ref("PlannedWall"),
                                               "medial, lateral, superior, inferior, anterior")},
                               {"breach", nullable(ref("PlannedBreach"))},
                               {"problems", array(text("a sentence"), "none: it can be made")}})}};
}

std::vector<NamedSchema> making_schemas() {
  using namespace schema;
  std::vector<Field> wish = plan_fields();
  wish.emplace(wish.begin(), "title", text("for those who teach; trainees never see it"));
  wish.emplace(wish.begin(), "volume", text("a released volume's id"));
  return {
      {"NewCase", object(wish)},
      {"CaseMaking", object({{"id", text("of the making")},
                             {"volume", text("that it is made of")},
                             {"title", text("for those who teach")},
                             {"state", one_of({"queued", "running", "done", "failed"}, "how far")},
                             {"share", number("1", "of the work, 0 to 1")},
                             {"phase", text("what it is at; else empty")},
                             {"error", text("why it failed; else empty")},
                             {"case_id", nullable(text("once done"))},
                             {"made_utc_us", integer("us", "since 1970, UTC")},
                             {"made_by", text("who")}})},
      {"CaseMakings", object({{"makings", array(ref("CaseMaking"), "newest first, 50 at most")}})},
      {"Retirement", object({{"retired", truth("offered no more")}})}};
}

RouteInfo route(std::string method, std::string path, std::string id, std::string summary,
                std::string body, std::string answer,
                Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/" + path,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::faculty},
          .parameters = {},
          .body = std::move(body),
          .body_limit_bytes = kMaxBody_bytes,
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> case_making_routes() {
  RouteInfo look = route("POST", "volumes/{id}/tract", "planTract",
                         "What a planned tract meets: walls along it, the breach, what is wrong",
                         "TractWish", "PlannedTract", look_at_tract);
  look.parameters = {path_text("id", "the volume's")};
  look.audited = false;  // it changes nothing
  look.schemas = tract_schemas();
  RouteInfo add = route("POST", "cases", "makeCase",
                        "Make a case of a released volume, as `tractus carve` does: a job",
                        "NewCase", "CaseMaking", make);
  add.schemas = making_schemas();
  RouteInfo list = route("GET", "case-makings", "caseMakings", "Cases in the making and made", "",
                         "CaseMakings", list_makings);
  RouteInfo one = route("GET", "case-makings/{id}", "caseMaking", "How far one is", "",
                        "CaseMaking", one_making);
  one.parameters = {path_text("id", "of the making")};
  RouteInfo away = route("POST", "cases/{id}/retire", "retireCase",
                         "Offer a case no more, or again; what was assigned of it goes on",
                         "Retirement", "", retire);
  away.parameters = {path_text("id", "the case's")};
  return {look, add, list, one, away};
}

}  // namespace api
}  // namespace tractus
