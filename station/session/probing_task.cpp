#include "station/session/probing_task.hpp"

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus {
namespace session {
namespace {

/// The layers as far as the probe can go: a model may say more of the bone than a rig reaches.
std::vector<laws::Layer> within_travel(std::vector<laws::Layer> layers, double travel_m) {
  std::erase_if(layers, [&](const laws::Layer& layer) { return layer.start_m >= travel_m; });
  for (laws::Layer& layer : layers)
    layer.thickness_m = std::min(layer.thickness_m, travel_m - layer.start_m);
  return layers;
}

}  // namespace

core::Result<ProbingTask> task_of(const scenarios::Scenario& scenario,
                                  const std::optional<models::ProbingModel>& model) {
  auto law = TRY(scenario.expanded());
  ProbingTask task;
  task.case_id = scenario.id();
  task.law = std::move(law);
  task.extra["scenario"] = scenario.to_json();
  if (model) {
    task.law.layers = within_travel(model->layers, task.law.travel_m);
    task.law.rotary = model->rotary;
    task.effects = model->effects;
    task.extra["model"] = model->to_json();
  }
  TRY(models::ProbingRuntime::make(task.law, task.effects));
  return task;
}

core::Result<ProbingTask> task_of(const models::ProbingModel& model, double travel_m) {
  ProbingTask task;
  const core::Json json = model.to_json();
  task.case_id =
      core::sha256(core::bytes_of(json.dump(-1, ' ', true, core::Json::error_handler_t::replace)));
  task.law.layers = within_travel(model.layers, travel_m);
  task.law.rotary = model.rotary;
  task.law.travel_m = travel_m;
  task.effects = model.effects;
  task.extra["model"] = json;
  TRY(models::ProbingRuntime::make(task.law, task.effects));
  return task;
}

}  // namespace session
}  // namespace tractus
