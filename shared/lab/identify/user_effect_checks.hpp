/// Checks of an effect that a user wrote, before and after it is tried.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "lab/identify/problem.hpp"

namespace tractus::lab {

/// Is the effect one that a diagnosis can judge on these recordings: does it vanish exactly where
/// it says that it is off, and is it finite over the whole recorded domain, at its initial numbers
/// and with each at its lowest and highest? Errors: bad_input, one line with what is wrong and, of
/// what is not finite, the trial.
core::Result<void> check_own_effect(const Problem& problem, const std::string& id);

/// Which effects of the catalogue, and which other own ones, do nearly the same as each of `own` in
/// these recordings, whatever its numbers of shape: the cosine of the angle between their
/// responses, after what the base's own numbers can imitate is taken from both. One sentence for
/// each likeness above 0.95, one for an effect that the base imitates, and one that says how many
/// own effects were ranked beside the catalogue's.
/// @param base  values of the base's parameters, best those of its fit.
std::vector<std::string> likenesses(const Problem& problem, const std::vector<std::string>& own,
                                    std::span<const double> base, int threads);

}  // namespace tractus::lab
