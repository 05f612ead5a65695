/// Operating statistics of the server in the Prometheus text format: only counts and durations,
/// without names, addresses and ids of people.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace tractus::api {

class Telemetry {
 public:
  /// Upper bounds of the histogram's buckets, in seconds.
  static constexpr std::array<double, 9> kBuckets_s{0.001, 0.005, 0.01, 0.05, 0.1,
                                                    0.25,  1.0,   5.0,  30.0};

  /// Counts one answered request. @param route  id of the route; empty if no route matched
  void count(const std::string& route, int status, double took_s, std::uint64_t body_bytes);
  /// The lines of counters and histograms; the caller adds gauges with `gauge`.
  std::string text() const;
  static std::string gauge(const std::string& name, const std::string& help, double value);
  static std::string counter(const std::string& name, const std::string& help, std::uint64_t value);

 private:
  struct Route {
    std::map<int, std::uint64_t> by_status;
    std::array<std::uint64_t, kBuckets_s.size() + 1> buckets{};
    double sum_s = 0.0;
    std::uint64_t body_bytes = 0;
  };
  mutable std::mutex mutex_;  ///< guards routes_
  std::map<std::string, Route> routes_;
};

}  // namespace tractus::api
