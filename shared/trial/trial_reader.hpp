/// A trial file read block by block, for a caller that takes the samples when it is ready for them.
#pragma once

#include <memory>
#include <optional>

#include "trial/trial_file.hpp"

namespace tractus::trial {

/// Reads as scan_trial does, in the memory of one frame.
class TrialReader {
 public:
  /// Errors: not_found, io, bad_input, corrupt (not a trial file), too_large.
  static core::Result<TrialReader> open(const std::filesystem::path& path,
                                        const ReadLimits& limits = {});
  ~TrialReader();
  TrialReader(TrialReader&&) noexcept;
  TrialReader& operator=(TrialReader&&) noexcept;
  /// The samples of the next frame, valid until the next call; nothing at the end of the trial, and
  /// in every later call. Errors: those of scan_trial; samples before an error count for nothing.
  core::Result<std::optional<Block>> next();

 private:
  struct State;
  explicit TrialReader(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tractus::trial
