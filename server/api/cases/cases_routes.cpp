/// Published cases: their list, manifest, parts and a small picture in voxels.
#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "server/api/backend.hpp"
#include "server/api/cases/case_file_schemas.hpp"
#include "server/api/cases/preview.hpp"
#include "server/api/finding/list_request.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

constexpr const char* kForEver = "private, max-age=31536000, immutable";  // named by content

core::Result<http::Response> list_cases(const Call& call) {
  const auto request = TRY(list_request(call, store::case_list()));
  const auto found = TRY(
      call.backend.store.read([&](store::Reading& tx) { return store::find_cases(tx, request); }));
  core::Json list = core::Json::array();
  for (const store::CaseSummary& c : found.cases)
    list.push_back({{"id", c.id},
                    {"title", c.title},
                    {"source", c.source},
                    {"made_utc_us", c.made_utc_us},
                    {"trials", c.trials},
                    {"retired", c.retired},
                    {"planned", c.planned},
                    {"felt", name(c.felt)}});
  return json_response(with_page({{"cases", list}}, found.page));
}

core::Result<http::Response> part_named(const Call& call, const std::string& part_name) {
  const std::string& id = call.text("id");
  auto part = TRY(call.backend.store.read(
      [&](store::Reading& tx) { return store::case_part(tx, id, part_name); }));
  const core::Error absent{
      core::Errc::not_found,
      fmt::format("case {} has no part {} here", id.substr(0, 64), part_name.substr(0, 64))};
  if (!part) return absent;
  const Role role = call.caller.role;
  const bool may_know = role == Role::admin || role == Role::faculty || role == Role::researcher;
  if (part->secret && !may_know) {
    auto known =
        TRY(call.backend.store.read([&](store::Reading& tx) { return store::case_of(tx, id); }));
    // The answer must not even reveal that this server has the scenario, because the versions of
    // scenarios are not secret.
    if (known && known->kind == trial::Rig::probing) return absent;
    return core::Error{core::Errc::forbidden, "this part is secret"};
  }
  const bool json = part_name.ends_with(".json");
  auto response = http::file_response(TRY(call.backend.objects.file(part->sha256)), call.request,
                                      json ? "application/json" : "application/octet-stream");
  if (response)
    response->with("Cache-Control", part->secret ? "no-store" : kForEver)
        .with("ETag", "\"" + part->sha256 + "\"");
  return response;
}

core::Result<http::Response> manifest(const Call& call) { return part_named(call, "case.json"); }
core::Result<http::Response> part(const Call& call) { return part_named(call, call.text("name")); }

std::string numbers(std::span<const double> values) {
  return fmt::format("{}", fmt::join(values, ","));
}

core::Result<http::Response> preview_of_case(const Call& call) {
  auto preview =
      TRY(case_preview(call.backend, call.text("id"), static_cast<int>(call.integer("max_side"))));
  const volume::Geometry& g = preview.geometry;
  const math::Mat3 rows = g.directions.transpose();  // Eigen stores by column
  http::Response response;
  response.with("Content-Type", "application/octet-stream")
      .with("Cache-Control", kForEver)
      .with("X-Dims", fmt::format("{},{},{}", g.dims[0], g.dims[1], g.dims[2]))
      .with("X-Spacing-m", numbers({g.spacing_m.data(), 3}))
      .with("X-Origin-m", numbers({g.origin_m.data(), 3}))
      .with("X-Directions", numbers({rows.data(), 9}));
  response.body = std::move(preview.opacity);
  return response;
}

RouteInfo read_route(std::string path, std::string id, std::string summary, std::string answer) {
  return {.method = "GET",
          .path = "/api/v1/cases" + path,
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::director, Role::faculty, Role::researcher, Role::station},
          .parameters = {},
          .body = "",
          .answer = std::move(answer),
          .schemas = {},
          .handle = nullptr};
}

}  // namespace

std::vector<RouteInfo> cases_routes() {
  const Parameter id = path_text("id", "Id of the case, the SHA-256 of its file case.json");
  RouteInfo list = read_route("", "cases", "List published cases", "CaseList");
  list.parameters = list_parameters(store::case_list(), "title, source or id");
  std::vector<schema::Field> fields = page_fields();
  fields.emplace_back(
      "cases", schema::array(schema::ref("CaseSummary"), "Published cases in the order asked for"));
  list.schemas = {
      {"CaseSummary",
       schema::object(
           {{"id", schema::text("Id of the case, the SHA-256 of its file case.json")},
            {"title", schema::text("Title of the case, shown to people")},
            {"source", schema::text("Origin of the volume and its licence")},
            {"made_utc_us",
             schema::integer("us", "Time of creation, in microseconds since 1970-01-01 UTC")},
            {"trials", schema::integer("1", "Number of trials on this case on this server")},
            {"retired", schema::truth("True if new assignments cannot use the case")},
            {"planned", schema::truth("True if the bone is whole: the trainee first drills the "
                                      "channel, then palpates it")},
            {"felt", schema::one_of<store::Felt>(
                         "Whether the case's breaches can be told by feel, by its certificate: "
                         "told (every one), not_told, not_known (its bone does not say), untried "
                         "(a job will try it)")}})},
      {"CaseList", schema::object(fields)}};
  list.handle = list_cases;

  RouteInfo one = read_route("/{id}", "case", "Read the signed manifest case.json, byte for byte",
                             "CaseManifest");
  one.parameters = {id};
  one.schemas = case_file_schemas();
  one.handle = manifest;

  RouteInfo bytes = read_route("/{id}/parts/{name}", "casePart",
                               "Read the bytes of one part of a case; the header Range is "
                               "supported; stations cannot read secret parts",
                               kBytes);
  bytes.parameters = {
      id, path_text("name", "Name of the part in the manifest, or case.json, or case.sig")};
  bytes.handle = part;

  RouteInfo small =
      read_route("/{id}/preview", "casePreview",
                 "Read the opacity around the tract as values 0 to 255, one byte per voxel in the "
                 "order [k][j][i]; the headers X-Dims, X-Spacing-m, X-Origin-m and X-Directions "
                 "(row-major) state the position in the patient (LPS)",
                 kBytes);
  small.parameters = {id,
                      {.in = Parameter::In::query,
                       .name = "max_side",
                       .kind = Parameter::Kind::integer,
                       .unit = "1",
                       .meaning = "Largest number of voxels along the longest side",
                       .low = 8,
                       .high = 256,
                       .fallback = "64"}};
  small.who.push_back({Role::trainee, Scope::own});
  small.object = Object::published_case;
  small.handle = preview_of_case;
  return {list, one, bytes, small};
}

}  // namespace api
}  // namespace tractus
