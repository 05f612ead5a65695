/// The parameters of a probing model that a fit may move, and the model that a set of values makes.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lab/identify/parameter_space.hpp"
#include "lab/identify/user_effects.hpp"
#include "models/probing_model.hpp"

namespace tractus::lab {

/// How far recordings of a set reached, for what they can inform.
struct Reach {
  double least_m = 0.0, most_m = 0.0;
  bool slides = true;       ///< else only the rotary stage's numbers move
  double spacing_s = 1e-3;  ///< between samples
};

/// Which numbers of the base are free: those not fixed, of layers that the recordings entered,
/// borders that they came near.
class ProbingParameterSpace {
 public:
  ProbingParameterSpace(models::ProbingModel model, const Reach& reach,
                        UserEffects user_effects = {});

  /// Base, then the model's own effects, then those added.
  std::vector<Parameter> parameters(const Structure& structure) const;
  /// The model with these values. What is free per trial is left out of it.
  models::ProbingModel with(const Structure& structure, std::span<const double> values) const;
  /// By how much the judged channel is recorded late against the motion: a number of the recording that every fit
  /// estimates, "/sensor/force_delay_s" or "/sensor/torque_delay_s". 0 where an effect of the model or of the structure has a delay of its own.
  double sensor_delay_s(const Structure& structure, std::span<const double> values) const;
  /// Where every search for that number begins.
  void begin_at_delay(double delay_s);
  const models::ProbingModel& model() const { return model_; }
  /// Does the given model have an effect of that id already?
  bool has(std::string_view effect) const;
  /// What is known of an effect of the model or of a structure.
  const effects::EffectFacts& facts_of(std::string_view id) const;
  /// The effect of the model or of the structure whose course is free in each trial; empty for none.
  std::string drift(const Structure& structure) const;
  /// Layers that no recording entered, in words.
  const std::vector<std::string>& notes() const { return notes_; }
  const UserEffects& user_effects() const { return user_effects_; }
  void add(const UserEffects& more) { user_effects_.add(more); }

 private:
  enum class Kind { stiffness, damping, equilibrium, start, end, delay, viscous, detent, pitch };
  struct Slot {
    Kind kind;
    std::size_t layer;
  };
  void add(Kind kind, std::size_t layer, const char* name, const Parameter& parameter);
  void add_layer(std::size_t layer, const Reach& reach);
  void add_delay(const char* name, double spacing_s);
  bool delays(const Structure& structure) const;
  bool fixed(const std::string& pointer) const;

  models::ProbingModel model_;
  UserEffects user_effects_;
  std::vector<effects::EffectFacts> own_;  // of the model's effects, a user's formulas among them
  std::vector<Slot> slots_;
  std::vector<Parameter> base_;
  std::vector<std::string> notes_;
};

}  // namespace tractus::lab
