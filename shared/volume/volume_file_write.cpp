#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/brick.hpp"
#include "volume/volume_file.hpp"
#include "volume/volume_header.hpp"

namespace tractus {
namespace volume {
namespace {
namespace fs = std::filesystem;

constexpr std::size_t kWrittenBatch = 16;  ///< bricks compressed side by side

/// A file written beside its name, renamed onto it by `keep`, removed otherwise.
class FileBeside {
 public:
  explicit FileBeside(const fs::path& path)
      : path_(path),
        beside_(path.string() + fmt::format(".{}.part", core::hex(core::random_bytes(4)))),
        fd_(::open(beside_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644)) {}
  ~FileBeside() {
    if (fd_ >= 0) ::close(fd_);
    if (fd_ >= 0 && !kept_) ::unlink(beside_.c_str());
  }
  FileBeside(const FileBeside&) = delete;
  FileBeside& operator=(const FileBeside&) = delete;

  core::Result<void> opened() const {
    TRY(core::may_be_replaced(path_));
    if (fd_ < 0) return core::system_error(path_, "cannot create");
    return {};
  }
  core::Result<void> write_at(std::uint64_t offset, core::ByteView bytes) {
    while (!bytes.empty()) {
      const ssize_t n = ::pwrite(fd_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return core::system_error(path_, "cannot write");
      offset += static_cast<std::uint64_t>(n);
      bytes = bytes.subspan(static_cast<std::size_t>(n));
    }
    return {};
  }
  core::Result<void> keep() {
    if (::fsync(fd_) != 0) return core::system_error(path_, "cannot write");
    if (::rename(beside_.c_str(), path_.c_str()) != 0)
      return core::system_error(path_, "cannot put in place");
    kept_ = true;
    return core::sync_folder(path_.has_parent_path() ? path_.parent_path() : fs::path("."));
  }

 private:
  fs::path path_, beside_;
  int fd_;
  bool kept_ = false;
};

void append_u32(core::Bytes& out, std::uint32_t value) {
  for (int shift = 0; shift < 32; shift += 8)
    out.push_back(static_cast<std::byte>(value >> shift & 0xffu));
}

core::Bytes preamble(std::size_t header_bytes) {
  const auto magic = core::bytes_of(kVolumeMagic);
  core::Bytes out(magic.begin(), magic.end());
  append_u32(out, kVolumeVersion);
  append_u32(out, static_cast<std::uint32_t>(header_bytes));
  return out;
}

/// What the bricks leave behind for the index and the id.
struct Index {
  core::Bytes entries;  ///< as they lie in the file
  core::Sha256 id;      ///< header, then every brick's digest
};

core::Result<Index> write_bricks(FileBeside& file, const Volume& volume, std::size_t bricks,
                                 std::uint64_t offset, const core::Progress& progress) {
  Index index;
  std::vector<StoredBrick> batch(kWrittenBatch);
  for (std::size_t first = 0; first < bricks; first += kWrittenBatch) {
    const std::size_t count = std::min(kWrittenBatch, bricks - first);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
      batch[b] = stored_brick(volume, brick_box(volume.geometry.dims, first + b));
    });
    for (std::size_t b = 0; b < count; ++b) {
      TRY(file.write_at(offset, batch[b].bytes));
      offset += batch[b].bytes.size();
      append_u32(index.entries, static_cast<std::uint32_t>(batch[b].bytes.size()));
      index.entries.insert(index.entries.end(), batch[b].digest.begin(), batch[b].digest.end());
    }
    if (progress && !progress(static_cast<double>(first + count) / static_cast<double>(bricks)))
      return core::Error{core::Errc::cancelled, "writing the volume was stopped"};
  }
  return index;
}

VolumeHeader header_of(const Volume& volume, const VolumeMeta& meta) {
  return {volume.geometry,        volume.slope,         volume.intercept,
          value_range_of(volume), histogram_of(volume), meta};
}

}  // namespace

std::array<double, 2> value_range_of(const Volume& volume) {
  core::require(!volume.counts.empty(), "a volume has voxels");
  const auto [low, high] = std::ranges::minmax_element(volume.counts);
  return {volume.intercept + volume.slope * *low, volume.intercept + volume.slope * *high};
}

Histogram histogram_of(const Volume& volume) {
  core::require(!volume.counts.empty(), "a volume has voxels");
  const auto [low_at, high_at] = std::ranges::minmax_element(volume.counts);
  const std::uint32_t low = *low_at, span = *high_at - low;
  const std::uint32_t per_bin = span / 256 + 1;
  Histogram out{volume.intercept + volume.slope * low, span == 0 ? 0.0 : volume.slope * per_bin,
                std::vector<std::uint64_t>(span / per_bin + 1, 0)};
  for (const std::uint16_t count : volume.counts) ++out.voxels[(count - low) / per_bin];
  return out;
}

core::Result<std::string> write_volume(const fs::path& path, const Volume& volume,
                                       const VolumeMeta& meta, const core::Progress& progress) {
  core::require(volume.counts.size() == volume.geometry.voxel_count(),
                "a volume holds a count per voxel");
  TRY(check_geometry(volume.geometry, path.string()));
  const VolumeHeader header = header_of(volume, meta);
  TRY(check_header(header, path.string()));
  const std::string text = header_text(header);
  const auto grid = brick_grid(volume.geometry.dims);
  const auto bricks = static_cast<std::size_t>(grid[0]) * static_cast<std::size_t>(grid[1]) *
                      static_cast<std::size_t>(grid[2]);
  FileBeside file(path);
  TRY(file.opened());
  const std::size_t bricks_at = kPreambleBytes + text.size() + bricks * kIndexEntryBytes;
  auto index = TRY(write_bricks(file, volume, bricks, bricks_at, progress));
  core::Sha256 id;
  id.add(core::bytes_of(text));
  for (std::size_t b = 0; b < bricks; ++b)
    id.add(core::ByteView(index.entries).subspan(b * kIndexEntryBytes + 4, 32));
  core::Bytes front = preamble(text.size());
  const auto json = core::bytes_of(text);
  front.insert(front.end(), json.begin(), json.end());
  front.insert(front.end(), index.entries.begin(), index.entries.end());
  TRY(file.write_at(0, front));
  TRY(file.keep());
  return id.hex();
}

}  // namespace volume
}  // namespace tractus
