/// The trial file `tractus-trial/1`: append-only frames, each with length and checksum, readable up
/// to the last whole frame whatever happened to the writer.
#pragma once

#include <filesystem>
#include <functional>
#include <span>

#include "core/result.hpp"
#include "trial/trial.hpp"

namespace trial {

/// Writes one file. Not for the tick: called by the recorder's thread. Every append is one frame.
class TrialWriter {
 public:
  /// Makes a new file (an existing one is a conflict), writes the header frame and flushes it to
  /// the disk.
  static core::Result<TrialWriter> create(const std::filesystem::path& path, const Header& header);
  ~TrialWriter();
  TrialWriter(TrialWriter&&) noexcept;
  core::Result<void> append(std::span<const Sample> samples);
  core::Result<void> append(const Event& event);
  /// Forces all appended frames to the disk (fdatasync).
  core::Result<void> flush();
  /// Writes the end frame (sample count, SHA-256 of the frames before it), flushes, closes.
  core::Result<void> finish();
  std::uint64_t samples_written() const noexcept;

 private:
  struct State;
  explicit TrialWriter(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

struct ReadLimits {
  std::uint64_t max_samples = 50'000'000;
  std::uint64_t max_bytes = 8ull << 30;
};

/// Reads frame by frame in bounded memory.
/// A torn last frame ends the trial quietly (`complete` false); anything else that does not hold is
/// Errc::corrupt with the offset. Non-finite values and times that run backwards are bad_input.
core::Result<Trial> read_trial(const std::filesystem::path& path, const ReadLimits& limits = {});
/// The same, handing out the frames' samples; `trial` returned holds header and events only.
core::Result<Trial> scan_trial(const std::filesystem::path& path,
                               const std::function<void(std::span<const Sample>)>& on_samples,
                               const ReadLimits& limits = {});
/// Cuts a file that a crash left open after its last whole frame and ends it with an "interrupted"
/// event and an end frame, so that it can be handed over. Returns the samples kept. Does nothing to
/// a finished file.
core::Result<std::uint64_t> recover_trial(const std::filesystem::path& path);

}  // namespace trial
