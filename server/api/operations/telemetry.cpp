#include "server/api/operations/telemetry.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tractus::api {

void Telemetry::count(const std::string& route, int status, double took_s,
                      std::uint64_t body_bytes) {
  const std::lock_guard held(mutex_);
  Route& r = routes_[route.empty() ? "none" : route];
  ++r.by_status[status];
  const auto bucket = std::ranges::lower_bound(kBuckets_s, took_s) - kBuckets_s.begin();
  ++r.buckets[static_cast<std::size_t>(bucket)];
  r.sum_s += took_s;
  r.body_bytes += body_bytes;
}

std::string Telemetry::text() const {
  const std::lock_guard held(mutex_);
  std::string out =
      "# HELP tractus_requests_total Requests answered.\n# TYPE tractus_requests_total counter\n";
  for (const auto& [id, r] : routes_)
    for (const auto& [status, count] : r.by_status)
      out += fmt::format("tractus_requests_total{{route=\"{}\",status=\"{}\"}} {}\n", id, status,
                         count);
  out +=
      "# HELP tractus_body_bytes_total Bytes of request bodies taken.\n"
      "# TYPE tractus_body_bytes_total counter\n";
  for (const auto& [id, r] : routes_)
    out += fmt::format("tractus_body_bytes_total{{route=\"{}\"}} {}\n", id, r.body_bytes);
  out +=
      "# HELP tractus_request_seconds Time to answer.\n# TYPE tractus_request_seconds histogram\n";
  for (const auto& [id, r] : routes_) {
    std::uint64_t below = 0;
    for (std::size_t i = 0; i < kBuckets_s.size(); ++i) {
      below += r.buckets[i];
      out += fmt::format("tractus_request_seconds_bucket{{route=\"{}\",le=\"{}\"}} {}\n", id,
                         kBuckets_s[i], below);
    }
    below += r.buckets.back();
    out +=
        fmt::format("tractus_request_seconds_bucket{{route=\"{}\",le=\"+Inf\"}} {}\n", id, below);
    out += fmt::format("tractus_request_seconds_sum{{route=\"{}\"}} {}\n", id, r.sum_s);
    out += fmt::format("tractus_request_seconds_count{{route=\"{}\"}} {}\n", id, below);
  }
  return out;
}

std::string Telemetry::gauge(const std::string& name, const std::string& help, double value) {
  return fmt::format("# HELP {0} {1}\n# TYPE {0} gauge\n{0} {2}\n", name, help, value);
}

std::string Telemetry::counter(const std::string& name, const std::string& help,
                               std::uint64_t value) {
  return fmt::format("# HELP {0} {1}\n# TYPE {0} counter\n{0} {2}\n", name, help, value);
}

}  // namespace tractus::api
