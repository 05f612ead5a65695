/// The trial file `tractus-trial/1`: append-only frames, each with length and checksum, readable up
/// to the last whole frame whatever happened to the writer.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>

#include "core/result.hpp"
#include "trial/trial.hpp"

namespace tractus::trial {

/// Writes one file. Not for the tick: called by the recorder's thread. Every append is one frame
/// and one write() (more only beyond 1 MiB). What a reader would refuse (fault_of, events
/// out of order) is refused here as bad_input, and nothing of that append is written. Gone without
/// finish(), the file is as after a crash: recover_trial() ends it.
class TrialWriter {
 public:
  /// Makes a new file: it appears with its header, flushed to the disk, or not at all. Errors:
  /// conflict (there is such a file), bad_input (a header that a reader would refuse), io.
  static core::Result<TrialWriter> create(const std::filesystem::path& path, const Header& header);
  ~TrialWriter();
  TrialWriter(TrialWriter&&) noexcept;
  TrialWriter& operator=(TrialWriter&&) noexcept;
  /// Errors: also bad_input when the header's rig is not that of the samples.
  core::Result<void> append(std::span<const Sample> samples);
  core::Result<void> append(std::span<const ProbingSample> samples);
  core::Result<void> append(const Event& event);
  /// Forces all appended frames to the disk (fdatasync).
  core::Result<void> flush();
  /// Writes the end frame (sample count, SHA-256 of all bytes before it), flushes, closes: append
  /// nothing afterwards.
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

/// Reads frame by frame; the memory is that of the samples the file really holds.
/// A torn last frame (or a tail of zeros) ends the trial quietly, with `sealed` and `complete`
/// false. Errors: corrupt with the offset for anything else that does not hold; bad_input with the
/// offset for numbers that are not finite, times or ticks that run backwards (fault_of), a field of
/// a header or an event; too_large.
core::Result<Trial> read_trial(const std::filesystem::path& path, const ReadLimits& limits = {});
/// The same in the memory of one frame, handing out the frames' samples in order; `trial` returned
/// holds header and events only. An Error may come after samples were handed out: they then count
/// for nothing.
core::Result<Trial> scan_trial(const std::filesystem::path& path,
                               const std::function<void(const Block&)>& on_samples,
                               const ReadLimits& limits = {});
/// Cuts a file that a crash left open after its last whole frame and ends it with an "interrupted"
/// event and an end frame, so that it can be handed over. Returns the samples kept. Does nothing to
/// a finished file; may itself be interrupted and repeated. Errors: conflict (its writer is alive),
/// corrupt or bad_input for damage that no interrupted writer leaves (the file is then as it was),
/// io.
core::Result<std::uint64_t> recover_trial(const std::filesystem::path& path);

}  // namespace tractus::trial
