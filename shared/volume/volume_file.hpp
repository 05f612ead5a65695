/// The store format of volumes, `tractus-volume/1` (.tvol): bricks, compressed, checksummed,
/// readable in part.
///
///     offset  0  "TRACTVOL"             8 bytes
///             8  version = 1            u32, little-endian as all that follows
///            12  h, length of header    u32, at most 1 MiB
///            16  header, JSON           geometry, slope, intercept, value range, histogram,
///            source, note
///        16 + h  index                  per brick: length u32, SHA-256 of its voxels (32 bytes)
///                bricks                 one after the other, in index order, to the end of the
///                file
///
/// A brick holds 64³ voxels (less at the far faces), [k][j][i], as zstd of all low bytes, then all
/// high bytes. Bricks are numbered with i fastest. The id names the content, whatever compressed
/// it: SHA-256 of the header and of the bricks' SHA-256 in order, so whoever trusts the id can
/// trust every voxel he reads.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

inline constexpr int kBrickEdge = 64;  ///< voxels along a brick

/// Where a volume came from, for people.
struct VolumeMeta {
  std::string source;  ///< name of the file or series it was read from, at most 1024 bytes
  std::string note;    ///< what was done to it on the way, at most 16384 bytes
};

/// Voxels counted over equal bins of the CT value, from the least value to the greatest.
struct Histogram {
  double low = 0.0;    ///< lower edge of the first bin, CT value
  double width = 0.0;  ///< of a bin, CT value; 0 when all voxels are alike (then one bin)
  std::vector<std::uint64_t> voxels;  ///< [bin]
  bool operator==(const Histogram&) const = default;
};

/// At most 256 bins, each of a whole number of counts.
Histogram histogram_of(const Volume& volume);
/// Least and greatest CT value. A volume without voxels is our bug.
std::array<double, 2> value_range_of(const Volume& volume);

/// Refuses what no volume of ours may be: an axis outside 1 … 4096 voxels, over 2³¹ voxels, a
/// spacing outside 1 µm … 0.1 m, an origin over 100 m away, directions that are not orthonormal to
/// 1e-4. `where` leads the message. Errors: bad_input.
core::Result<void> check_geometry(const Geometry& geometry, const std::string& where);

/// Writes brick by brick beside `path` and puts it in place when whole; returns the id. An older
/// file is replaced. Memory: a few bricks. Errors: bad_input (geometry or numbers no reader would
/// take), io, cancelled.
core::Result<std::string> write_volume(const std::filesystem::path& path, const Volume& volume,
                                       const VolumeMeta& meta, const core::Progress& progress = {});

/// A stored volume: `open` reads header and index alone, the rest is read brick by brick and
/// checked as it is read. Reading is const and safe from several threads.
class VolumeFile {
 public:
  /// Errors: not_found, io, bad_input (no such file format, or a version not known), corrupt
  /// (truncated, or a field that contradicts the file).
  static core::Result<VolumeFile> open(const std::filesystem::path& path);
  ~VolumeFile();
  VolumeFile(VolumeFile&&) noexcept;
  VolumeFile& operator=(VolumeFile&&) noexcept;

  const Geometry& geometry() const noexcept;
  double slope() const noexcept;      ///< CT value per count, > 0
  double intercept() const noexcept;  ///< CT value of count 0
  const std::string& id() const noexcept;
  const VolumeMeta& meta() const noexcept;
  std::array<double, 2> value_range() const noexcept;  ///< as the header states it
  const Histogram& histogram() const noexcept;         ///< as the header states it
  std::size_t brick_count() const noexcept;

  /// Errors: io, corrupt (naming the brick), cancelled.
  core::Result<Volume> read_all(const core::Progress& progress = {}) const;
  /// The voxels of a box, with the geometry they have there; only the bricks it touches are read.
  /// Errors: out_of_range (the box is empty or leaves the volume), io, corrupt.
  core::Result<Volume> read_box(const Box& box, const core::Progress& progress = {}) const;

 private:
  struct State;
  explicit VolumeFile(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tractus::volume
