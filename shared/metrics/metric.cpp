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

core::Json to_json(const MetricInfo& info) {
  return {{"id", info.id},
          {"label", info.label},
          {"unit", info.unit},
          {"definition", info.definition},
          {"source", info.source},
          {"shown_as", name(info.shown_as)},
          {"cell", info.cell ? core::Json{{"row", info.cell->row},
                                          {"symbol", info.cell->symbol},
                                          {"column", info.cell->column}}
                             : core::Json()}};
}

core::Json to_json(const MetricInfo& info, const Score& score) {
  core::Json out = to_json(info);
  out["value"] = score.value ? core::Json(*score.value) : core::Json();
  out["note"] = score.note;
  return out;
}

}  // namespace tractus::metrics
