/// What is probed in a trial on the probing rig.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "effects/effect.hpp"
#include "laws/probing_law.hpp"
#include "models/probing_runtime.hpp"
#include "scenarios/scenario.hpp"

namespace tractus::session {

/// What is probed. A value; holds no name of a scenario when the trial is blind.
struct ProbingTask {
  std::string case_id;          ///< the scenario's id, or the slot's of a blind study
  laws::ProbingParameters law;  ///< what a station needs of a scenario
  std::vector<effects::EffectInstance>
      effects;                ///< of a model that is felt instead of the scenario's bone
  std::string operator_name;  ///< a pseudonym; empty: the simulated surgeon's own name
  core::Json extra = core::Json::object();  ///< goes into the header's extra as it is
  /// Nothing that tells one scenario from another is written into the header or shown while it runs.
  bool blind = false;
};

/// From a scenario; with a model, its bone and effects instead, behind the scenario's walls.
/// Errors: those of the scenario; out_of_range when the model does not fit the travel.
core::Result<ProbingTask> task_of(const scenarios::Scenario& scenario,
                                  const std::optional<models::ProbingModel>& model = {});
/// A model alone, without walls, over `travel_m`. `case_id` is the SHA-256 of its JSON.
core::Result<ProbingTask> task_of(const models::ProbingModel& model, double travel_m);

}  // namespace tractus::session
