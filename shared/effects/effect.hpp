/// What an effect of the catalogue says of itself. One file each in probing/ and palpation/; the
/// file's name is the id.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace tractus::effects {

/// Kept apart: what a hand may feel, and what only belongs to how a measurement was made.
enum class Kind {
  force,        ///< adds to the law
  structure,    ///< changes what the law sees or how it answers
  measurement,  ///< corrects the comparison; never rendered to a hand
};
std::string_view name(Kind kind);

/// Of a parameter of shape, at which nothing vanishes.
inline constexpr double kNoOff = std::numeric_limits<double>::quiet_NaN();

/// One number (or several of one name, as the three of a vector) of an effect.
struct Param {
  std::string name;     ///< as in model files; ends in its unit: "friction_N"
  std::string meaning;  ///< one sentence
  double initial;       ///< where a fit begins, each component
  double low, high;     ///< plausible range, each component; what lies outside is refused
  int components = 1;
  /// The effect vanishes exactly when every parameter that has an off value takes it, whatever the
  /// others are; kNoOff for a parameter of shape (a velocity, a period), which has no such value.
  double off = 0.0;
  bool logarithmic = false;  ///< spans decades: search and step in its logarithm
  /// What a model file means that does not give it; kNoOff: it must.
  double if_missing = kNoOff;
  std::string unit = {};  ///< where the name does not say it, see unit_of
};
/// "N/m" of stiffness_N_per_m, "1" of coefficient: what the name ends in, or what is stated.
std::string unit_of(const Param& param);

/// What is common to the effects of both rigs.
struct EffectFacts {
  std::string id;  ///< "coulomb_friction"
  Kind kind = Kind::force;
  std::string summary;   ///< one line for a person
  std::string equation;  ///< as in the design, plain text
  std::string source;    ///< key of the bibliography with equation, or "own"
  std::vector<Param> params;
  /// States of the recording it needs beyond depth or pose: "omega_rad_s", "tz_Nm"; a set without
  /// them cannot show it.
  std::vector<std::string> needs = {};
  std::vector<std::string> parents = {};  ///< simpler effects it contains as a limit
  bool free_per_trial = false;            ///< its course differs from trial to trial (sensor_drift)
  bool passive = true;                    ///< gives back no more work than it got
  /// Do the numbers stand to each other as the law means it (breakaway ≥ friction)? A fit that ends
  /// elsewhere imitates something else. Null: always.
  bool (*admissible)(std::span<const double> values) = nullptr;
};

/// An effect in a model: which, and its numbers in the order of the params, components flattened.
struct EffectInstance {
  std::string id;
  std::vector<double> values;
  /// Of a user's own expression ("expression:NAME"): its file's JSON. Empty for the catalogue's.
  std::string definition = {};
};

/// Are the numbers as many as the effect takes, finite and within their ranges? Errors: bad_input
/// (too few, too many), out_of_range naming the parameter, its value and its range.
core::Result<void> check(const EffectFacts& facts, std::span<const double> values);
/// How many numbers an effect takes: its parameters' components together.
std::size_t value_count(const EffectFacts& facts);

}  // namespace tractus::effects
