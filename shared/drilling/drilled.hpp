/// What a drilling came to, as a value and as a file: the voxels of the box that changed.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "drilling/erosion.hpp"

namespace tractus::drilling {

/// The file `tractus-drilled/1` (.tdrill):
///
///     "tractus-drilled/1\n" · u32 h, length of the header · header, JSON · zstd of the counts
///
/// little-endian; header: trial_id, case_id, and what `to_json` says. The counts are those of the
/// box, [k][j][i], 16 bits each.
struct Drilled {
  std::array<int, 3> dims{};  ///< of the whole volume
  volume::Box box;            ///< of the counts; empty when nothing was drilled
  double removed_m3 = 0.0;    ///< bone, Erosion::removed_m3
  std::uint32_t changes = 0;
  std::vector<std::uint16_t> counts;  ///< [k][j][i]

  /// Names the result: SHA-256 of the dims, the box and the counts.
  std::string sha256() const;
  /// {"dims", "box": {"begin", "end"}, "removed_m3", "changes", "counts_sha256"}: what a trial's
  /// "drilled" event says.
  core::Json to_json() const;
  /// Writes the counts into a volume of these dims.
  void put_into(volume::Volume& volume) const;
};

Drilled drilled_of(const Erosion& erosion);

/// Errors: io.
core::Result<void> write_drilled(const std::filesystem::path& path, const Drilled& drilled,
                                 const std::string& trial_id, const std::string& case_id);

/// The state of this trial on this case's volume. Errors: not_found, io, bad_input (another trial's
/// or another case's, a volume of other dims, a field), corrupt (the counts are not those of the
/// hash).
core::Result<Drilled> read_drilled(const std::filesystem::path& path, const std::string& trial_id,
                                   const std::string& case_id, const std::array<int, 3>& dims);

}  // namespace tractus::drilling
