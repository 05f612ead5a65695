/// What a sensor would have said of a motion that comes one moment at a time.
#pragma once

#include <vector>

#include "effects/probing_effect.hpp"
#include "models/probing_runtime.hpp"

namespace tractus::models {

/// What a sensor would have said at one moment.
struct ProbingAnswer {
  double fz_N = 0.0;   ///< push of the hand along x
  double tz_Nm = 0.0;  ///< torque of the hand about x
};

/// Gives moment by moment what ProbingRuntime::predict gives for the whole motion: the same effects in the
/// same order. One exception: a delay shorter than the time between two moments. `predict` then interpolates with the
/// moment after, which is not there yet; here the force is straight on from the last two.
///
/// A copy goes on from where the original stands.
class ProbingStream {
 public:
  /// @param runtime  must outlive this. @param start_s, stop_s  of the whole motion: a drift of the
  /// sensor runs over it.
  ProbingStream(const ProbingRuntime& runtime, double start_s, double stop_s);

  /// The answer at a moment after the last kept one. Its `dt_s` is set here.
  ProbingAnswer at(effects::ProbingTick tick) const;
  /// The same, and the motion has passed that moment.
  ProbingAnswer keep(effects::ProbingTick tick);

 private:
  /// What runs along with the motion.
  struct Kept {
    std::vector<effects::ProbingMemory> memories;  // depths, then forces
    std::size_t stretch = 0;                       // of the law, where the depth lay last
    bool started = false;
    double t_s = 0.0;
    std::vector<double> past_t_s, past_fz_N;  // as long ago as a delay reaches; else empty
  };
  ProbingAnswer answer(effects::ProbingTick tick, Kept& kept) const;
  double felt_N(const effects::ProbingTick& tick, Kept& kept) const noexcept;
  double delayed_N(double t_s, double fz_N, Kept& kept) const;
  void forget(Kept& kept) const;

  const ProbingRuntime* runtime_;
  double start_s_, stop_s_;
  Kept kept_;
};

}  // namespace tractus::models
