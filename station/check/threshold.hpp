/// What this person can tell at this device: thresholds of force, by two-interval forced choices.
///
/// Each question has two intervals; in one of them, drawn by chance, is more than in the other, and
/// the person says in which. The level of each question follows from the answers before it, by the
/// ψ method (statistics::Psi [Kontsevich1999]); the threshold is the level at which three of four
/// answers are right.
#pragma once

#include <functional>
#include <string>

#include "core/words.hpp"
#include "station/check/device_check.hpp"
#include "statistics/psychometric/psi.hpp"

namespace tractus::check {

/// What is told apart.
enum class Stimulus {
  detection,   ///< a push to the right from none
  difference,  ///< a push of kReference_N from a stronger one
  gap,         ///< a wall with a gap from one without: the handle is led up and down along it
};
constexpr auto words(Stimulus) {
  return std::to_array<core::Word<Stimulus>>({{Stimulus::detection, "detection"},
                                              {Stimulus::difference, "difference"},
                                              {Stimulus::gap, "gap"}});
}
using core::name;

inline constexpr double kReference_N = 1.0;
inline constexpr double kWallStiffness_N_per_m = 400.0;
inline constexpr double kGapWidth_m = 0.006;  ///< foot of a raised cosine; its half height: half

/// Of a question, to whoever is asked.
enum class Moment { pause, first, second, answer };

/// Who is asked, at a terminal or SIMULATED. Both are called from the thread that ticks.
struct Asked {
  std::function<void(Stimulus, Moment)> begins;
  std::function<int()> answer;  ///< 1 or 2, the interval with more; 0: not yet
};

struct MeasuredThreshold {
  Stimulus stimulus = Stimulus::detection;
  statistics::Threshold threshold = {};  ///< N of a push; m, the depth, of a gap
  int questions = 0, right = 0;

  core::Json to_json() const;
};

/// So many questions. A seed of its own for each measurement. Zero force at the end. Errors:
/// unavailable (the device's fault; nobody answered for two minutes), cancelled.
core::Result<MeasuredThreshold> measure_threshold(Bench bench, Stimulus stimulus, int questions,
                                                  std::uint64_t seed, const Asked& asked);

/// One person's thresholds at one device: file of format `tractus-observer/1`. Names nobody but
/// `who`, which stays on the station.
struct ObserverRecord {
  std::int64_t at_utc_us = 0;
  std::string device = {}, who = {};
  bool simulated = false;
  std::vector<MeasuredThreshold> measured = {};  ///< detection and difference at least

  /// With `perception`, what a certificate takes: the threshold of detection t, and of the
  /// difference J at the reference F₀ what is not of t, w = √(J² − t²)/F₀ (0 where J < t).
  core::Json to_json() const;
};

}  // namespace tractus::check
