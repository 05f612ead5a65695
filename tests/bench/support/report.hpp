/// What the benchmarks print: rows of numbers, figures with their limits, and a verdict.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "core/json.hpp"

namespace tractus::bench {

/// Seconds of processor time of this thread: what others do on the machine does not count.
double thread_s();
/// The same of all threads of this process.
double process_s();
/// Seconds on the wall's clock.
double wall_s();

/// Seconds that `work` takes by `clock`: the least of `times` calls, the one that was disturbed
/// least.
template <class Work>
double seconds(int times, double (*clock)(), Work work) {
  double least = 1e300;
  for (int n = 0; n < times; ++n) {
    const double start = clock();
    work();
    least = std::min(least, clock() - start);
  }
  return least;
}

/// The value that a share of the values does not exceed, 0 … 1. Sorts `values`.
double quantile(std::vector<double>& values, double share);

class Report {
 public:
  explicit Report(std::string name);
  /// A line of the table; printed at once.
  void row(const std::string& what, double value, const std::string& unit,
           const std::string& note = "");
  /// A figure that is judged.
  void at_most(const std::string& what, double value, double limit, const std::string& unit);
  void at_least(const std::string& what, double value, double limit, const std::string& unit);
  /// A condition without which the times mean nothing.
  void must(const std::string& what, bool holds);
  /// Writes the JSON when the command line has `--json FILE`. The program's exit status: 0, or 1
  /// with a figure missed.
  int finish(int argc, char** argv) const;

 private:
  void figure(const std::string& what, double value, const char* sign, double limit,
              const std::string& unit, bool met);
  core::Json json_;
  bool met_ = true;
};

}  // namespace tractus::bench
