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
#include "volume/tract.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

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
          {"state", name(making.state)},
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
  if (!making)
    return Error{Errc::not_found, "no job that makes a case has the id " + id.substr(0, 32)};
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
    return store::queue_job(tx, store::JobKind::making, making.id, making.made_utc_us);
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

std::vector<NamedSchema> tract_schemas() {
  using namespace schema;
  const Json wall = one_of<volume::Wall>("Wall of the tract");
  const Json point = tuple(number("m", "One coordinate x, y or z, in metres"), 3,
                           "Point in the volume's frame (LPS), in metres");
  const auto peak = [](const std::string& tissue) {
    return nullable(number("HU", "CT value of " + tissue + "; null where none was found"));
  };
  const Json thinnest =
      object({{"at_m", number("m", "Depth along the tract, in metres")},
              {"inner_m", number("m", "Distance from the tract's axis to the bone, in metres")},
              {"thickness_m", number("m", "Thickness of the bone, in metres")}});
  return {
      {"BreachWish",
       object(
           {{"wall", wall},
            {"depth_m", optional(number(
                            "m", "Depth of the breach beyond the bone, in metres; default 0.003"))},
            {"at_m",
             optional(
                 number("m",
                        "Depth along the tract, in metres; default: where the wall is thinnest, in "
                        "filled bone where the breach is told best"))},
            {"even", optional(truth("True: in filled bone, where the breach is as hard to tell as "
                                    "those of the other walls; without at_m"))}})},
      {"EnvelopeMark",
       object({{"at_m", point},
               {"radius_m", number("m", "Radius of the ball, in metres, 0.001 to 0.01")},
               {"bone", truth("True: there is bone of this vertebra; false: there is none")}})},
      {"TractWish", object(plan_fields())},
      {"PlannedWall",
       object({{"wall", wall},
               {"depth_m", array(number("m", "Depth along the tract, in metres"),
                                 "Depths at which the wall was searched")},
               {"inner_m", array(nullable(number("m", "Distance from the tract's axis, in metres")),
                                 "Distance at which the bone begins, for each depth; null where no "
                                 "wall was found")},
               {"thickness_m",
                array(nullable(number("m", "Thickness of the bone, in metres")),
                      "Thickness of the wall, for each depth; null where no wall was found")},
               {"thinnest", nullable(thinnest)}})},
      {"PlannedBreach",
       object(
           {{"wall", wall},
            {"at_m", number("m", "Depth of the breach along the tract, in metres")},
            {"breach_m", point},
            {"from_m", point},
            {"tip_m", point},
            {"depth_m", number("m", "Depth of the breach beyond the bone, in metres")},
            {"inner_m", number("m", "Distance from the tract's axis to the bone, in metres")},
            {"wall_thickness_m", number("m", "Thickness of the bone at the breach, in metres")}})},
      {"PlannedEnvelope",
       object({{"around", integer("1",
                                  "Points of a row; the last joins the first; the first and the "
                                  "last row are poles")},
               {"points_m", array(point,
                                  "The vertebra's outer face, a row after the other; also "
                                  "where a problem says that it is refused")}})},
      {"CtCalibration",
       object({{"air_HU", peak("air")},
               {"fat_HU", peak("fat")},
               {"soft_tissue_HU", peak("soft tissue")},
               {"cancellous_HU", peak("the cancellous bone about the tract")},
               {"cortical_HU", peak("the cortical bone about the tract")},
               {"cortex_m", nullable(number("m",
                                            "Median thickness of the cortex about the tract, "
                                            "in metres; null where it is not known"))}})},
      {"PlannedTract",
       object(
           {{"length_m", number("m", "Distance from the entry to the target, in metres")},
            {"side", nullable(one_of({"left", "right"},
                                     "Side of the patient; null if the tract cannot be placed"))},
            {"tract", nullable(ref("Tract"))},
            {"walls", array(ref("PlannedWall"),
                            "Walls in the order medial, lateral, superior, inferior, anterior")},
            {"breach", nullable(ref("PlannedBreach"))},
            {"problems", array(text("One problem, as a sentence"),
                               "Problems of the plan; empty if a case can be made from it")},
            {"envelope", nullable(ref("PlannedEnvelope"))},
            {"calibration", nullable(ref("CtCalibration"))},
            {"warnings", array(text("One warning, as a sentence"),
                               "What makes the CT a poor one for filled bone; a case can be made "
                               "all the same")}})}};
}

std::vector<NamedSchema> making_schemas() {
  using namespace schema;
  std::vector<Field> wish = plan_fields();
  wish.emplace(wish.begin(), "title", text("Title for faculty; trainees never see it"));
  wish.emplace(wish.begin(), "volume", text("Id of a released volume"));
  return {
      {"NewCase", object(wish)},
      {"CaseMaking",
       object({{"id", text("Id of the job that makes the case")},
               {"volume", text("Id of the volume from which the case is made")},
               {"title", text("Title for faculty")},
               {"state", one_of<store::WorkState>("State of the job")},
               {"share", number("1", "Completed share of the work, 0 to 1")},
               {"phase", text("Current step of the work; empty if the job is not running")},
               {"error", text("Reason for the failure; empty if the job did not fail")},
               {"case_id", nullable(text("Id of the case; null until the job is done"))},
               {"made_utc_us",
                integer("us", "Time of the request, in microseconds since 1970-01-01 UTC")},
               {"made_by", text("Name of the account that requested the case")}})},
      {"CaseMakings",
       object({{"makings",
                array(ref("CaseMaking"), "Jobs that make cases, newest first, at most 50")}})},
      {"Retirement", object({{"retired", truth("True if new assignments cannot use the case")}})}};
}

RouteInfo case_making_route(std::string method, std::string path, std::string id,
                            std::string summary, std::string body, std::string answer,
                            Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/" + path,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::faculty},
          .parameters = {},
          .body = std::move(body),
          .body_limit_bytes = kMaxPlan_bytes,
          .answer = std::move(answer),
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<schema::Field> plan_fields() {
  using namespace schema;
  const Json point = tuple(number("m", "One coordinate x, y or z, in metres"), 3,
                           "Point in the volume's frame (LPS), in metres");
  return {
      {"entry_m", point},
      {"target_m", point},
      {"radius_m", optional(number("m", "Radius of the drill, in metres; default 0.0015"))},
      {"channel",
       optional(one_of({"drilled", "planned"},
                       "drilled (default): the channel is drilled into the volume; planned: "
                       "the bone stays whole, and a trainee drills the channel"))},
      {"preparation",
       optional(one_of<volume::Preparation>(
           "published (default): the CT's own values, marrow is not felt; filled: all bone "
           "within the vertebra's envelope is felt"))},
      {"envelope_marks",
       optional(array(ref("EnvelopeMark"),
                      "Where a person says that there is bone of this vertebra or none, at most "
                      "200; for filled bone"))},
      {"breach", optional(nullable(ref("BreachWish")))}};
}

std::vector<RouteInfo> case_making_routes() {
  RouteInfo look =
      case_making_route("POST", "volumes/{id}/tract", "planTract",
                        "Examine a planned tract before a case is made: the walls along it, the "
                        "breach and the problems of the plan",
                        "TractWish", "PlannedTract", look_at_tract);
  look.parameters = {path_text("id", "Id of the volume")};
  look.audited = false;  // it changes nothing
  look.schemas = tract_schemas();
  RouteInfo add = case_making_route(
      "POST", "cases", "makeCase",
      "Queue a job that makes a case from a released volume, as `tractus carve` does", "NewCase",
      "CaseMaking", make);
  add.schemas = making_schemas();
  RouteInfo list = case_making_route("GET", "case-makings", "caseMakings",
                                     "List the jobs that make cases, newest first", "",
                                     "CaseMakings", list_makings);
  RouteInfo one = case_making_route("GET", "case-makings/{id}", "caseMaking",
                                    "Read the state of one job that makes a case", "", "CaseMaking",
                                    one_making);
  one.parameters = {path_text("id", "Id of the job that makes the case")};
  RouteInfo away =
      case_making_route("POST", "cases/{id}/retire", "retireCase",
                        "Retire a case, so that new assignments cannot use it, or offer it again; "
                        "existing assignments continue",
                        "Retirement", "", retire);
  away.parameters = {path_text("id", "Id of the case")};
  return {look, add, list, one, away};
}

}  // namespace api
}  // namespace tractus
