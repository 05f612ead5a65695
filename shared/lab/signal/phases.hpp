/// What the hand was doing, moment by moment, in words.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace tractus::lab {

/// Phases of a probing trial, by precedence:
///   layer crossing   within 60 ms of a moment at which a border of the model's layers is passed
///   reversal         within 100 ms of a change of direction
///   hold             slower than a thirtieth of the trial's brisk speed (95 % quantile of |v|)
///   advance, retract moving in, moving out
inline const std::vector<std::string> kProbingPhases{"hold", "advance", "retract", "reversal",
                                                     "layer crossing"};
/// Phases of a palpation trial: free (force under 0.05 N and under four times its noise), contact
/// (touching and slower than 2 mm/s), sliding (moving mostly across the force) and pressing (mostly
/// along it).
inline const std::vector<std::string> kPalpationPhases{"free", "contact", "sliding", "pressing"};
inline const std::vector<std::string> kDirections{"in", "out", "still"};
/// The same of a stage that only turns.
inline const std::vector<std::string> kTurningPhases{"hold", "turning forward", "turning back",
                                                     "reversal", "layer crossing"};
inline const std::vector<std::string> kTurningDirections{"forward", "back", "still"};

/// One motion along one axis, sample by sample, in the words' indices.
struct Courses {
  std::vector<float> direction, phase, since_reversal_s;
};

/// @param velocity  along the axis, m/s or rad/s.
/// @param crossing  1 where a border is being passed, as the problem says; may be empty.
Courses courses(std::span<const double> t_s, std::span<const double> velocity,
                std::span<const double> crossing);

/// Phases of a palpation, in the indices of kPalpationPhases.
/// @param along_m_s  the part of the velocity along the force, either sign.
std::vector<float> palpation_phases(std::span<const double> force_N,
                                    std::span<const double> speed_m_s,
                                    std::span<const double> along_m_s, double noise_N);

}  // namespace tractus::lab
