/// Which recording would decide between the structures that the data leave: each candidate is simulated under each of them and
/// analysed as a real one would be, before anything is recorded (preposterior analysis [Raiffa1961]).
#pragma once

#include <functional>
#include <vector>

#include "core/progress.hpp"
#include "lab/identify/diagnosis.hpp"
#include "models/probing_model.hpp"
#include "trial/motion_program.hpp"
#include "trial/probing_set.hpp"

namespace tractus::lab {

/// A candidate recording and what it promises.
struct ProgramValue {
  trial::MotionProgram program;
  double seconds = 0.0;  ///< of all its repetitions
  double difference =
      0.0;  ///< between the structures' predictions of it, in standard deviations of the noise, rms
  double expected_gain =
      0.0;  ///< of the probability of the true structure, over the structures left and simulated noise
  double gain_per_minute = 0.0;
};

struct PreposteriorOptions {
  int threads = 2;
  int draws = 2;        ///< simulated recordings for each candidate and structure. Bound.
  int repetitions = 3;  ///< trials of the program, as a person would record them. Physical.
  std::size_t shortlist =
      3;  ///< candidates that are simulated, those whose predictions differ most per minute. Bound.
};

/// Best per minute first; empty where fewer than two structures are left. The set is that which `problem` was made of.
/// Errors: those of make_probing_problem and diagnose; cancelled.
core::Result<std::vector<ProgramValue>> weigh_programs(const Problem& problem,
                                                       const Diagnosis& diagnosis,
                                                       const models::ProbingModel& given,
                                                       const trial::ProbingSet& set,
                                                       const PreposteriorOptions& options = {},
                                                       const core::Progress& progress = {});

}  // namespace tractus::lab
