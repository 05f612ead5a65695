#include "bench/support/report.hpp"

#include <fmt/core.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace tractus {
namespace bench {
namespace {

double now_s(clockid_t clock) {
  timespec t{};
  clock_gettime(clock, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

}  // namespace

double thread_s() { return now_s(CLOCK_THREAD_CPUTIME_ID); }
double process_s() { return now_s(CLOCK_PROCESS_CPUTIME_ID); }
double wall_s() { return now_s(CLOCK_MONOTONIC); }

double quantile(std::vector<double>& values, double share) {
  std::ranges::sort(values);
  const double at = std::ceil(share * double(values.size())) - 1.0;
  return values[std::size_t(std::clamp(at, 0.0, double(values.size() - 1)))];
}

Report::Report(std::string name) {
  fmt::print("{}\n", name);
  json_["benchmark"] = std::move(name);
  json_["rows"] = core::Json::array();
  json_["figures"] = core::Json::array();
}

void Report::row(const std::string& what, double value, const std::string& unit,
                 const std::string& note) {
  fmt::print("  {:<58} {:>12.4g} {:<10} {}\n", what, value, unit, note);
  std::fflush(stdout);
  json_["rows"].push_back({{"what", what}, {"value", value}, {"unit", unit}, {"note", note}});
}

void Report::at_most(const std::string& what, double value, double limit, const std::string& unit) {
  figure(what, value, "≤", limit, unit, value <= limit);
}

void Report::at_least(const std::string& what, double value, double limit,
                      const std::string& unit) {
  figure(what, value, "≥", limit, unit, value >= limit);
}

void Report::must(const std::string& what, bool holds) {
  fmt::print("  {:<58} {}\n", what, holds ? "yes" : "NO");
  json_["rows"].push_back({{"what", what}, {"holds", holds}});
  met_ = met_ && holds;
}

void Report::figure(const std::string& what, double value, const char* sign, double limit,
                    const std::string& unit, bool met) {
  fmt::print("  {:<58} {:>12.4g} {:<10} {} {} {}\n", what, value, unit, sign, limit,
             met ? "met" : "MISSED");
  std::fflush(stdout);
  json_["figures"].push_back(
      {{"what", what}, {"value", value}, {"unit", unit}, {"limit", limit}, {"met", met}});
  met_ = met_ && met;
}

int Report::finish(int argc, char** argv) const {
  for (int k = 1; k + 1 < argc; ++k)
    if (std::string_view(argv[k]) == "--json")
      if (const auto written = core::write_json(argv[k + 1], json_); !written) {
        fmt::print(stderr, "{}\n", written.error().what);
        return 2;
      }
  return met_ ? 0 : 1;
}

}  // namespace bench
}  // namespace tractus
