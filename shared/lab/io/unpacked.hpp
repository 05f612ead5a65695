/// A measurement set as people send it: a folder, or a zip of one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/file.hpp"
#include "core/progress.hpp"
#include "core/result.hpp"

namespace tractus::lab_io {

struct UnpackLimits {
  std::uint64_t max_bytes = 4ull << 30;  ///< of all files unpacked
  std::size_t max_files = 20'000;
};

/// A folder to read a set from; one that was unpacked goes with this object.
class Unpacked {
 public:
  /// A folder is taken as it is. A zip is unpacked into a folder of its own below the system's
  /// temporary folder; the set is where its set.json lies, at the top or in the only folder there.
  ///
  /// Errors, one line naming the archive and the entry: not a folder nor a zip, a damaged or
  /// encrypted one, an entry that is a link or a device, whose path leaves the folder or is there
  /// twice, no set.json (bad_input); over the limits, checked while unpacking and whatever the
  /// archive claims (too_large); not_found, io, cancelled. Nothing is left behind.
  static core::Result<Unpacked> open(const std::filesystem::path& path,
                                     const UnpackLimits& limits = {},
                                     const core::Progress& progress = {});
  const std::filesystem::path& folder() const { return folder_; }

 private:
  Unpacked(std::filesystem::path folder, std::optional<core::ScratchFolder> scratch)
      : folder_(std::move(folder)), scratch_(std::move(scratch)) {}
  std::filesystem::path folder_;
  std::optional<core::ScratchFolder> scratch_;
};

}  // namespace tractus::lab_io
