/// The parameters of a palpation model that a fit may move, and the model that a set of values makes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lab/identify/problem.hpp"
#include "lab/identify/user_effects.hpp"
#include "models/model.hpp"

namespace tractus::lab {

/// Which numbers of the base are free: those not fixed. The pose offset of the base is never
/// fitted: the effect pose_offset is.
class PalpationParameterSpace {
 public:
  /// @param field_per_m  a usual |g| where the recordings touch bone: where the search for an
  /// exponent has its reference
  PalpationParameterSpace(models::PalpationModel model, double field_per_m,
                          UserEffects user_effects = {});

  /// Base, then the model's own effects, then those added.
  std::vector<Parameter> parameters(const Structure& structure) const;
  /// Numbers to begin an effect's search with, each in the order of its parameters.
  std::vector<std::vector<double>> starts(std::string_view effect) const;
  /// The model with these values. `sensor_drift`, free per trial, is left out of it.
  models::PalpationModel with(const Structure& structure, std::span<const double> values) const;
  const models::PalpationModel& model() const { return model_; }
  const UserEffects& user_effects() const { return user_effects_; }

 private:
  struct Slot {
    const char* name;
    double laws::PalpationParameters::*held;
    Parameter parameter;
  };
  bool fixed(const std::string& pointer) const;
  const effects::EffectFacts& facts_of(std::string_view id) const;
  std::vector<Parameter> of_effect(const effects::EffectFacts& facts) const;

  models::PalpationModel model_;
  UserEffects user_effects_;
  std::vector<effects::EffectFacts> own_;  // of the model's effects
  double field_per_m_;
  std::vector<Slot> slots_;
};

}  // namespace tractus::lab
