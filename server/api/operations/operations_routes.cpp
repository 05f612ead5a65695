/// For those who keep the server running: is it well, and what does it do?
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"
#include "server/api/trials/uploads.hpp"
#include "tracing/tracer.hpp"

namespace tractus {
namespace api {
namespace {

core::Result<double> counted(store::Reading& tx, const char* sql) {
  auto rows = TRY(tx.query(sql));
  return static_cast<double>(rows.front().count(0));
}

/// The route needs no credentials, so the answer contains only whether the server can accept
/// trials.
core::Result<http::Response> health(const Call& call) {
  auto reads = call.backend.store.read(
      [](store::Reading& tx) { return counted(tx, "select count(*) from schema_versions"); });
  const bool room = bool(check_disk(call.backend, 0));
  const char* state = !reads ? "failing" : room ? "ok" : "disk full";
  return json_response({{"state", state}}, reads && room ? 200 : 503);
}

struct Gauge {
  const char *name, *help, *sql;
};
constexpr Gauge kGauges[] = {
    {"tractus_trials", "Trials stored.", "select count(*) from trials"},
    {"tractus_uploads_open", "Uploads in progress.",
     "select count(*) from uploads where state = 'receiving'"},
    {"tractus_jobs_waiting", "Jobs queued or running.",
     "select count(*) from jobs where state in ('queued', 'running')"},
    {"tractus_jobs_failed", "Jobs that failed.",
     "select count(*) from jobs where state = 'failed'"},
    {"tractus_deliveries_waiting", "E-mails, webhook calls, scores and statements that wait.",
     "select count(*) from deliveries where state = 'waiting'"},
    {"tractus_deliveries_given_up",
     "E-mails, webhook calls, scores and statements that were given up.",
     "select count(*) from deliveries where state = 'given up'"},
    {"tractus_stations", "Enrolled stations, without revoked ones.",
     "select count(*) from stations where revoked_utc_us is null"},
    {"tractus_sessions", "Sessions of signed-in people.", "select count(*) from sessions"},
    {"tractus_audit_rows", "Rows of the audit trail.",
     "select coalesce(max(number), 0) from audit"},
};

core::Result<http::Response> metrics_text(const Call& call) {
  std::string out = call.backend.telemetry.text();
  TRY(call.backend.store.read([&](store::Reading& tx) -> core::Result<void> {
    for (const Gauge& gauge : kGauges) {
      auto value = TRY(counted(tx, gauge.sql));
      out += Telemetry::gauge(gauge.name, gauge.help, value);
    }
    return {};
  }));
  out += Telemetry::gauge("tractus_disk_free_bytes", "Free bytes on the disk of the data folder.",
                          static_cast<double>(free_bytes(call.backend)));
  const auto spans =
      call.backend.tracer ? call.backend.tracer->counts() : tracing::Tracer::Counts{};
  out +=
      Telemetry::counter("tractus_spans_sent_total", "Spans that the collector took.", spans.sent);
  out += Telemetry::counter("tractus_spans_dropped_total",
                            "Spans dropped: the queue was full, or the collector refused them.",
                            spans.dropped);
  http::Response response{.status = 200, .headers = {}, .body = std::move(out)};
  response.with("Content-Type", "text/plain; version=0.0.4").with("Cache-Control", "no-store");
  return response;
}

}  // namespace

std::vector<RouteInfo> operations_routes() {
  using namespace schema;
  return {{.method = "GET",
           .path = "/api/v1/health",
           .id = "health",
           .summary = "Show the state of the server: status 200 if it works and has disk space for "
                      "trials, else 503",
           .who = {},
           .open = true,
           .parameters = {},
           .body = "",
           .answer = "Health",
           .schemas = {{"Health", object({{"state", one_of({"ok", "disk full", "failing"},
                                                           "State of the server")}})}},
           .handle = health},
          {.method = "GET",
           .path = "/api/v1/server/metrics",
           .id = "serverMetrics",
           .summary = "Read counters, durations and gauges in the Prometheus text format, without "
                      "names of people",
           .who = {Role::admin, Role::technician, Role::station},
           .parameters = {},
           .body = "",
           .answer = kBytes,
           .schemas = {},
           .handle = metrics_text}};
}

}  // namespace api
}  // namespace tractus
