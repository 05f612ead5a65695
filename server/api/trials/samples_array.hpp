/// A trial's samples as a NumPy array in a file.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace tractus::api {

/// The most bytes that the array of so many samples has.
std::uint64_t samples_npy_bytes(std::uint64_t samples);

/// Writes the samples of a trial file as one array of doubles, a row per sample: NumPy's .npy,
/// version 1.0 (little-endian float64, row after row), which R reads as well, in bounded memory.
/// Columns by dictionary_csv (export.hpp).
/// @param rate_Hz  of the rows; 0: every sample
/// @param to       a file that is not there yet
/// Errors: those of reading the trial; io; too_large (over 512 MiB).
core::Result<void> write_samples_npy(const std::filesystem::path& trial_file, double rate_Hz,
                                     const std::filesystem::path& to);

}  // namespace tractus::api
