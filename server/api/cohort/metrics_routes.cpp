/// What is scored, and how it is defined.
#include "metrics/metric.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/trial_json.hpp"

namespace tractus {
namespace api {
namespace {

core::Result<http::Response> list_metrics(const Call&) {
  core::Json list = core::Json::array();
  for (const metrics::MetricInfo& metric : metrics::all()) {
    core::Json entry = metrics::to_json(metric);
    entry["rig"] = metric.rig ? core::Json(trial::name(*metric.rig)) : core::Json();
    list.push_back(std::move(entry));
  }
  return json_response({{"metrics", list}});
}

}  // namespace

std::vector<RouteInfo> metrics_routes() {
  auto fields = metric_fields();
  fields.emplace_back("rig",
                      schema::nullable(schema::one_of<trial::Rig>(
                          "Rig whose trials have this metric; null: trials of both rigs have it")));
  const core::Json info = schema::object(fields);
  return {
      {.method = "GET",
       .path = "/api/v1/metrics",
       .id = "metrics",
       .summary = "List the metrics with their definitions",
       .who = {kRoles.begin(), kRoles.end()},
       .parameters = {},
       .body = "",
       .answer = "MetricList",
       .schemas = {{"MetricInfo", info},
                   {"MetricList",
                    schema::object(
                        {{"metrics",
                          schema::array(
                              schema::ref("MetricInfo"),
                              "All metrics, in the order in which a trial lists its scores")}})}},
       .handle = list_metrics}};
}

}  // namespace api
}  // namespace tractus
