/// What is scored, and how it is defined.
#include "metrics/metric.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

core::Result<http::Response> list_metrics(const Call&) {
  core::Json list = core::Json::array();
  for (const metrics::MetricInfo& metric : metrics::all())
    list.push_back({{"id", metric.id},
                    {"label", metric.label},
                    {"unit", metric.unit},
                    {"definition", metric.definition},
                    {"source", metric.source},
                    {"rig", metric.rig ? core::Json(trial::name(*metric.rig)) : core::Json()}});
  return json_response({{"metrics", list}});
}

}  // namespace

std::vector<RouteInfo> metrics_routes() {
  const core::Json info = schema::object(
      {{"id", schema::text("never changes")},
       {"label", schema::text("for people")},
       {"unit", schema::text("as printed: N, s, 1")},
       {"definition", schema::text("one sentence")},
       {"source", schema::text("where it is from")},
       {"rig", schema::nullable(schema::one_of({"palpation", "probing"},
                                               "whose trials it is of; null: of both"))}});
  return {{.method = "GET",
           .path = "/api/v1/metrics",
           .id = "metrics",
           .summary = "Every score and its definition",
           .who = {kRoles.begin(), kRoles.end()},
           .parameters = {},
           .body = "",
           .answer = "MetricList",
           .schemas = {{"MetricInfo", info},
                       {"MetricList",
                        schema::object({{"metrics", schema::array(schema::ref("MetricInfo"),
                                                                  "in the order of a trial's")}})}},
           .handle = list_metrics}};
}

}  // namespace api
}  // namespace tractus
