/// What an effect of the catalogue says of itself. One file each in probing/ and palpation/; the
/// file's name is the id.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/named.hpp"
#include "core/result.hpp"

namespace tractus::effects {

/// Kept apart: what a hand may feel, and what only belongs to how a measurement was made.
enum class Kind {
  force,        ///< adds to the law
  structure,    ///< changes what the law sees or how it answers
  measurement,  ///< corrects the comparison; never rendered to a hand
};
constexpr auto words(Kind) {
  using enum Kind;
  return std::to_array<core::Word<Kind>>(
      {{force, "force"}, {structure, "structure"}, {measurement, "measurement"}});
}
using core::name;

/// On the probing rig: the recorded channel that shows an effect. A set that only turns is compared
/// in its torque, every other in its force.
enum class Channel {
  force,   ///< fz_N, along the probe
  torque,  ///< tz_Nm, about the probe
};

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
  /// A change that is felt but small, of the logarithm if logarithmic: the step of a fit's difference
  /// quotients. 0: a hundredth of the initial value.
  double step = 0.0;
  /// Standard deviation (of the logarithm, if logarithmic) with which a fit believes the value it
  /// starts from before the data speak.
  double prior_sd = std::numeric_limits<double>::infinity();
};
/// "N/m" of stiffness_N_per_m, "1" of coefficient: what the name ends in, or what is stated.
std::string unit_of(const Param& param);

/// Where the search for an effect begins, one entry for each start: its numbers in the order of the
/// params, components flattened. Of a strength only the scale counts, a fit estimates it first.
using Starts = std::vector<std::vector<double>>;

/// What is common to the effects of both rigs.
struct EffectFacts {
  std::string id;     ///< "coulomb_friction"
  std::string label;  ///< as within a sentence: "Coulomb friction"
  Kind kind = Kind::force;
  std::string summary;   ///< one line for a person
  std::string equation;  ///< as in the design, plain text
  std::string source;    ///< key of the bibliography with equation, or "own"
  /// What to record so that the effect shows, as the object of "record": "slow strokes at …".
  std::string experiment;
  std::vector<Param> params;
  /// States of the recording it needs beyond depth or pose: "omega_rad_s", "tz_Nm"; a set without
  /// them cannot show it.
  std::vector<std::string> needs = {};
  std::vector<std::string> parents = {};  ///< simpler effects it contains as a limit
  Channel channel = Channel::force;       ///< of the probing rig
  /// A slow course of the sensor that differs from trial to trial: the lab removes it from each
  /// trial and reports its range, which is then its one parameter.
  bool free_per_trial = false;
  bool is_bias = false;   ///< a constant that the sensor adds to what it shows
  bool is_delay = false;  ///< the force against the motion
  bool is_dry = false;    ///< dry friction: at standstill it takes any value within its size
  bool passive = true;    ///< gives back no more work than it got
  /// Starts that do not depend on the recordings. Empty: the initial values, and a grid over the
  /// range of each parameter of shape.
  Starts starts = {};
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
