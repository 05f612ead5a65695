/// A trial's samples as a NumPy array: .npy, version 1.0 (little-endian float64, row-major), which R
/// can also read. dictionary_csv (export.hpp) describes the columns.
#pragma once

#include <filesystem>

#include "trial/trial_reader.hpp"

namespace tractus::api {

/// The bytes before the rows. An array without rows has the columns of palpation.
std::string npy_head(trial::Rig rig, std::uint64_t rows);
/// Number of rows that `size_bytes` of rows are.
std::uint64_t npy_rows(trial::Rig rig, std::uint64_t size_bytes);
/// Size of the whole array.
std::uint64_t npy_bytes(trial::Rig rig, std::uint64_t rows);

/// The rows of a trial's array, block by block, in the memory of one block.
class SampleRows {
 public:
  /// @param rate_Hz  rate of the rows; 0: every sample
  /// Errors: those of reading the trial.
  static core::Result<SampleRows> open(const std::filesystem::path& trial_file, double rate_Hz);
  /// Appends the rows of the next block, which may be none. Returns false at the end. Errors: those
  /// of reading the trial.
  core::Result<bool> append_to(std::string& out);
  trial::Rig rig() const { return rig_; }  ///< of the blocks that were read

 private:
  SampleRows(trial::TrialReader reader, double rate_Hz)
      : reader_(std::move(reader)), rate_Hz_(rate_Hz) {}
  trial::TrialReader reader_;
  double rate_Hz_, next_s_ = 0.0;
  trial::Rig rig_ = trial::Rig::palpation;
};

/// Largest size of the array of `samples` samples, in bytes.
std::uint64_t samples_npy_bytes(std::uint64_t samples);

/// Writes the samples of a trial file as one array of doubles, one row per sample, with bounded
/// memory.
/// @param rate_Hz  rate of the rows; 0: every sample
/// @param to       file that must not exist
/// Errors: those of reading the trial; io; too_large (over 512 MiB).
core::Result<void> write_samples_npy(const std::filesystem::path& trial_file, double rate_Hz,
                                     const std::filesystem::path& to);

}  // namespace tractus::api
