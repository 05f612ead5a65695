#include "metrics/metric.hpp"

namespace tractus::metrics {

std::vector<std::pair<MetricInfo, Score>> score_all(const Subject& subject) {
  std::vector<std::pair<MetricInfo, Score>> out;
  for (auto& info : all()) {
    if (info.rig && info.rig != subject.trial.header.rig) continue;
    if (info.is_of && !info.is_of(subject.trial)) continue;
    Score score = info.compute(subject);
    out.emplace_back(std::move(info), std::move(score));
  }
  return out;
}

core::Json to_json(const MetricInfo& info, const Score& score) {
  return {{"id", info.id},
          {"label", info.label},
          {"unit", info.unit},
          {"value", score.value ? core::Json(*score.value) : core::Json(nullptr)},
          {"note", score.note},
          {"definition", info.definition},
          {"source", info.source}};
}

}  // namespace tractus::metrics
