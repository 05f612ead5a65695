/// A trial's samples as a NumPy array in a file.
#pragma once

#include <filesystem>

#include "core/result.hpp"

namespace tractus::api {

/// Largest size of the array of `samples` samples, in bytes.
std::uint64_t samples_npy_bytes(std::uint64_t samples);

/// Writes the samples of a trial file as one array of doubles, one row per sample, with bounded
/// memory. The format is NumPy's .npy, version 1.0 (little-endian float64, row-major), which R can
/// also read. dictionary_csv (export.hpp) describes the columns.
/// @param rate_Hz  rate of the rows; 0: every sample
/// @param to       file that must not exist
/// Errors: those of reading the trial; io; too_large (over 512 MiB).
core::Result<void> write_samples_npy(const std::filesystem::path& trial_file, double rate_Hz,
                                     const std::filesystem::path& to);

}  // namespace tractus::api
