/// What the server counts of itself, in Prometheus' text form. Counts and times alone: no name, no
/// address, no id of anybody.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <mutex>
#include <string>

namespace tractus::api {

class Telemetry {
 public:
  /// Upper ends of the histogram's buckets, s.
  static constexpr std::array<double, 9> kBuckets_s{0.001, 0.005, 0.01, 0.05, 0.1,
                                                    0.25,  1.0,   5.0,  30.0};

  /// One answered request. @param route  its id; empty for one that fits no route
  void count(const std::string& route, int status, double took_s, std::uint64_t body_bytes);
  /// Lines of counters and histograms; gauges are the caller's to add with `gauge`.
  std::string text() const;
  static std::string gauge(const std::string& name, const std::string& help, double value);

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
