/// The parameters of a palpation model that a fit may move, and the model that a set of values makes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lab/identify/parameter_space.hpp"
#include "lab/identify/user_effects.hpp"
#include "models/model.hpp"

namespace tractus::lab {

/// Which numbers of the base are free: those not fixed, and not replaced by an effect of the model.
/// The pose offset of the base is never fitted: the effect of that name is.
class PalpationParameterSpace {
 public:
  /// @param field_per_m  a usual |g| where the recordings touch bone: where the search for an
  /// exponent has its reference
  PalpationParameterSpace(models::PalpationModel model, double field_per_m,
                          UserEffects user_effects = {});

  /// Base, the force's delay ("/sensor/force_delay_s"), then the model's own effects, then those added.
  std::vector<Parameter> parameters(const Structure& structure) const;
  /// Starts that an effect of the catalogue states or takes from base and recordings; empty: none.
  effects::Starts starts(std::string_view effect) const;
  /// What is known of an effect of a structure.
  const effects::EffectFacts& facts_of(std::string_view id) const;
  /// The effect of the structure whose course is free in each trial; empty for none.
  std::string drift(const Structure& structure) const;
  /// The model with these values. What is free per trial is left out of it.
  models::PalpationModel with(const Structure& structure, std::span<const double> values) const;
  /// The same as its sensor records it: with the force's delay against the motion.
  models::PalpationModel recorded(const Structure& structure, std::span<const double> values) const;
  const models::PalpationModel& model() const { return model_; }
  const UserEffects& user_effects() const { return user_effects_; }

 private:
  struct Slot {
    double laws::PalpationParameters::*held;  // null: the force's delay
    Parameter parameter;
  };
  bool fixed(const std::string& pointer) const;
  bool replaced(double laws::PalpationParameters::*held) const;
  void add(const char* name, double laws::PalpationParameters::*held, Parameter parameter);
  void add_delay();
  bool delays(const Structure& structure) const;
  std::vector<Parameter> of_effect(const effects::EffectFacts& facts) const;

  models::PalpationModel model_;
  UserEffects user_effects_;
  std::vector<effects::EffectFacts> own_;  // of the model's effects
  double field_per_m_;
  std::vector<Slot> slots_;
};

}  // namespace tractus::lab
