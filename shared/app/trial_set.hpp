/// Recorded trials as a measurement set for the lab.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "core/result.hpp"

namespace tractus::commands {

/// Writes `tractus-measurements/1` into a new folder: a trial each, all of one rig; ids are the
/// trials' own. Samples without a fresh reading are left out, as are those before a probing trial's
/// sensor was tared. A set of palpation holds the forces of the model that ran, for no station
/// measures others; its notes say so. `simulated` is stated when a trial was.
/// Errors: those of reading the files; bad_input for trials of two rigs, one that is there twice,
/// or one with fewer than two samples that count.
/// @returns the samples written.
core::Result<std::size_t> write_trial_set(std::span<const std::string> files,
                                          const std::filesystem::path& folder);

}  // namespace tractus::commands
