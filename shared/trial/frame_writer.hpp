/// Appends frames to a trial file and keeps its hash. Users of trials want trial_file.hpp.
#pragma once

#include "trial/frames.hpp"

namespace tractus::trial {

class FrameWriter {
 public:
  /// Makes `path` with the magic and a header frame: it appears whole and flushed, or not at all.
  /// Errors: conflict (there is such a file), io.
  static core::Result<FrameWriter> create(const std::filesystem::path& path,
                                          core::ByteView header_payload);
  /// Goes on behind what `reader` has read, cutting the file at its offset(). Holds the file's
  /// lock, as create() does. Errors: io.
  static core::Result<FrameWriter> resume(Descriptor locked, FrameReader& reader);

  /// One frame, one write(). A failed write is cut off again, so that a later one follows a whole
  /// frame. Errors: io.
  core::Result<void> append(FrameType type, core::ByteView payload);
  /// fdatasync. Errors: io.
  core::Result<void> flush();
  /// The end frame, flushed. Nothing may be appended afterwards.
  core::Result<void> seal(std::uint64_t samples);
  bool sealed() const { return sealed_; }

 private:
  FrameWriter(std::filesystem::path path, Descriptor file)
      : path_(std::move(path)), file_(std::move(file)) {}
  std::filesystem::path path_;
  Descriptor file_;
  std::uint64_t position_ = 0;
  std::uint32_t sequence_ = 0;
  core::Sha256 hash_;
  bool sealed_ = false, broken_ = false;
};

/// Opens for reading and writing and takes the lock that a writer holds. Errors: not_found, io,
/// bad_input (not a regular file), conflict (a writer has it).
core::Result<Descriptor> open_locked(const std::filesystem::path& path);

}  // namespace tractus::trial
