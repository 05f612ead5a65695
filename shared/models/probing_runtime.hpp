/// The probing law and its effects made ready to run: replay, fit and the live loop step this one
/// object.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "effects/probing_effect.hpp"
#include "laws/probing_law.hpp"
#include "models/probing_model.hpp"

namespace models {

using effects::ProbingMotion;

/// What a sensor would have said, one entry per sample.
struct ProbingForces {
  std::vector<double> fz_N;   ///< push of the hand along x
  std::vector<double> tz_Nm;  ///< empty when the motion has no angle
};

/// The law with effects at their stages. With x̃ the depth that the bone sees:
///
///     fz = s · (D v + K (x̃ − x0)) + Σ f_e,   then late by the delay, plus bias, drift, crosstalk
///     tz = viscous and detent torque of the law
///
/// Immutable: safe to use from several threads at once. Making one costs microseconds, so a fit
/// makes one for each set of numbers.
class ProbingRuntime {
 public:
  /// @param travel_m  the probe stop. Errors: out_of_range, bad_input or not_found naming the layer
  /// or the effect and its parameter.
  static core::Result<ProbingRuntime> make(const ProbingModel& model, double travel_m);
  /// The same for a law that has walls (a scenario's).
  static core::Result<ProbingRuntime> make(laws::ProbingParameters parameters,
                                           std::span<const effects::Use> uses);

  /// Force from motion, measurement effects included. The motion's arrays have one size; the last
  /// three may be empty. A sample's dt is that since the sample before.
  void predict(const ProbingMotion& motion, ProbingForces& out) const;

  const laws::ProbingLaw& law() const noexcept { return law_; }

 private:
  using Effects = std::vector<std::unique_ptr<effects::ProbingEffect>>;
  ProbingRuntime(laws::ProbingLaw law, Effects effects);
  void predict_forces(const ProbingMotion& motion, std::span<double> fz_N) const;

  laws::ProbingLaw law_;
  Effects effects_;  // by stage
  std::size_t live_ =
      0;  // so many of them, from the first, belong to the law and not to a recording
};

}  // namespace models
