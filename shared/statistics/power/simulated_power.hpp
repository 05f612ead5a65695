/// Power of a planned study by simulation: data are drawn from what the plan assumes, analysed as
/// the study will be, and the share of significant results is counted.
///
///     y = effect · x + a_surgeon + s_surgeon · t + b_scenario + e,  all normal about 0,  t = 1 … T
///     x: the trial number t, or 0 and 1 of two groups of surgeons, or of two conditions that
///     each surgeon meets in turn
///
/// The analysis: least squares where each surgeon has one trial; else the linear mixed model with
/// (1 | surgeon), (1 + t | surgeon) where slopes vary, and (1 | scenario) where there are two or
/// more. Simulated data are drawn by inversion from a seeded generator: the same seed gives the same
/// answer on every machine.
#pragma once

#include <cstdint>

#include "core/progress.hpp"
#include "statistics/distributions/proportions.hpp"
#include "statistics/mixed/lmm_tests.hpp"

namespace tractus::statistics {

struct StudyDesign {
  enum class Compares { trials, groups, conditions };
  Compares compares = Compares::trials;
  int surgeons = 10;    ///< per group where groups are compared
  int trials = 12;      ///< T, of each surgeon
  int scenarios = 1;    ///< taken in turn, each surgeon beginning with another
  double effect = 0.0;  ///< per trial, or second minus first, in the response's unit
  double surgeon_sd = 0.0, slope_sd = 0.0, scenario_sd = 0.0;
  double residual_sd = 1.0;  ///< > 0
  double alpha = 0.05;
  SmallSample df = SmallSample::satterthwaite;
};

struct SimulatedPower {
  int surgeons = 0;  ///< of the design
  int runs = 0;
  int significant = 0;
  int failed = 0;  ///< runs whose analysis could not be done: they count as not significant
  double power = 0.0;
  Interval interval;  ///< 95 %, Wilson
};

/// Errors: bad_input for a design that cannot be analysed (fewer than 2 surgeons, 2 trials of a
/// comparison within surgeons, more effects than observations), cancelled.
core::Result<SimulatedPower> simulated_power(const StudyDesign& design, int runs,
                                             std::uint64_t seed,
                                             const core::Progress& progress = {});

/// The smallest number of surgeons whose simulated power reaches `target`, by doubling and
/// bisection; `design.surgeons` is not looked at. Numbers that are clearly too few or too many get
/// fewer runs, the answer all of them. Errors: as above; out_of_range where 2000 are not enough.
core::Result<SimulatedPower> needed_surgeons(StudyDesign design, double target, int runs,
                                             std::uint64_t seed,
                                             const core::Progress& progress = {});

}  // namespace tractus::statistics
