/// Rubrics: by what people rate trials, stated by directors in versions.
#include <algorithm>

#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/trials/rating_json.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

constexpr std::uint64_t kMaxRubric_bytes = 1u << 17;
constexpr std::size_t kLongestRubricId = 32, kLongestRubricReason = 500;

Result<http::Response> rubrics_response(const Call& call, int status) {
  const auto versions =
      TRY(call.backend.store.read([](store::Reading& tx) { return store::rubric_versions(tx); }));
  Json list = Json::array();
  for (const store::RubricVersion& one : versions) {
    auto json = TRY(rubric_version_json(one));
    list.push_back(std::move(json));
  }
  return json_response({{"rubrics", std::move(list)}}, status);
}

Result<http::Response> list_rubrics(const Call& call) { return rubrics_response(call, 200); }

/// As a column of a table and a name in a formula: "osats".
bool is_rubric_id(const std::string& id) {
  const auto is_part = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !id.empty() && id.front() >= 'a' && id.front() <= 'z' && std::ranges::all_of(id, is_part);
}

Result<http::Response> add_rubric(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::RubricVersion out{.id = fields.text("id", kLongestRubricId),
                           .title = {},
                           .definition = {},
                           .reason = fields.text_or("reason", "", kLongestRubricReason),
                           .made_utc_us = call.backend.now_utc_us(),
                           .made_by = call.caller.name};
  if (!is_rubric_id(out.id))
    fields.wrong("id", "a small letter, then small letters, digits and '_' are expected");
  const Json* definition = fields.member("rubric");
  TRY(fields.done());
  const auto rubric = TRY(assessment::Rubric::from_json(*definition, "body: /rubric"));
  out.title = rubric.title;
  out.definition = rubric.to_json().dump();
  TRY(call.backend.store.write([&](store::Writing& tx) { return store::add_rubric(tx, out); }));
  return rubrics_response(call, 201);
}

}  // namespace

std::vector<RouteInfo> rubrics_routes() {
  using namespace schema;
  RouteInfo list{.method = "GET",
                 .path = "/api/v1/rubrics",
                 .id = "rubrics",
                 .summary = "List the rubrics by which people rate trials, with all versions",
                 .who = {Role::admin, Role::director, Role::faculty},
                 .parameters = {},
                 .body = "",
                 .answer = "RubricList",
                 .schemas = rubric_schemas(),
                 .handle = list_rubrics};
  RouteInfo add = list;
  add.method = "POST";
  add.id = "addRubric";
  add.summary = "Make a rubric, or a new version of the rubric with this id";
  add.who = {Role::admin, Role::director};
  add.body = "NewRubric";
  add.body_limit_bytes = kMaxRubric_bytes;
  add.schemas = {
      {"NewRubric",
       object({{"id", text("Id of the rubric: a small letter, then small letters, digits and _, at "
                           "most 32; exports name the column rating.ID_vVERSION by it")},
               {"reason", optional(text("Reason of the change, at most 500 bytes"))},
               {"rubric", ref("RubricFile")}})}};
  add.handle = add_rubric;
  return {list, add};
}

}  // namespace api
}  // namespace tractus
