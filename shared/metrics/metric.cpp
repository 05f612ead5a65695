#include "metrics/metric.hpp"

namespace metrics {

std::vector<std::pair<MetricInfo, Score>> score_all(const Subject& subject) {
  std::vector<std::pair<MetricInfo, Score>> out;
  for (auto& info : all()) {
    Score score = info.compute(subject);
    out.emplace_back(std::move(info), std::move(score));
  }
  return out;
}

}  // namespace metrics
