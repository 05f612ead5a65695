/// Which bytes of a part of a case a station has already.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/bytes.hpp"

namespace tractus::uplink {

/// Bytes of a part, in their order: from a file here, or to be fetched.
struct Segment {
  std::uint64_t offset = 0, size = 0;
  std::filesystem::path from = {};  ///< empty: fetched
  std::uint64_t from_offset = 0;
};

/// What other cases on this disk hold: whole parts by their SHA-256, bricks of stored volumes
/// (volume_file.hpp) by the SHA-256 of their voxels.
class LocalParts {
 public:
  /// Reads the manifests, and the indices of the volumes, of all cases in the folder. What cannot
  /// be read is left out.
  explicit LocalParts(const std::filesystem::path& cases_folder);

  bool empty() const { return parts_.empty(); }
  /// A file here that the manifest of its case calls the same, if there is one.
  std::optional<std::filesystem::path> whole(const std::string& sha256) const;
  /// The part cut into what is here and what is not. @param head  the part's first bytes, up to the
  /// end of its index. When they are no stored volume of `size` bytes: all is fetched.
  std::vector<Segment> plan(core::ByteView head, std::uint64_t size) const;

 private:
  struct Place {
    std::filesystem::path file;
    std::uint64_t offset = 0, size = 0;
  };
  std::map<std::string, std::filesystem::path> parts_;
  std::map<std::string, Place> bricks_;
};

/// Where the bricks of a stored volume lie.
struct BrickIndex {
  struct Entry {
    std::string digest;  ///< 32 bytes
    std::uint64_t offset = 0, size = 0;
  };
  std::vector<Entry> bricks;
  std::uint64_t end = 0;  ///< of the file
};
/// Bytes from the start to the end of the header's length, and of the JSON header.
inline constexpr std::uint64_t kVolumeHead_bytes = 16;
/// How many bytes from the start hold header and index, as far as `head` (at least
/// kVolumeHead_bytes, more once known) tells. Nothing: no stored volume.
std::optional<std::uint64_t> index_end(core::ByteView head);
/// Nothing when `head`, which goes to index_end, is not one.
std::optional<BrickIndex> brick_index(core::ByteView head);

}  // namespace tractus::uplink
