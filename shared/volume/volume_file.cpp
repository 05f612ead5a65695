#include "volume/volume_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "core/file.hpp"
#include "core/try.hpp"
#include "volume/brick.hpp"
#include "volume/volume_header.hpp"

namespace tractus {
namespace volume {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kBatch = 16;  ///< bricks decompressed side by side

struct BrickEntry {
  std::uint64_t offset;
  std::uint32_t length;
  core::Bytes digest;
};

core::Error corrupt(const fs::path& path, const std::string& why) {
  return {core::Errc::corrupt, fmt::format("{}: {}", path.string(), why)};
}

std::uint32_t u32_at(core::ByteView bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

}  // namespace

struct VolumeFile::State {
  fs::path path;
  int fd = -1;
  std::uint64_t size = 0;
  VolumeHeader header;
  std::vector<BrickEntry> bricks;
  std::string id;

  ~State() {
    if (fd >= 0) ::close(fd);
  }
  core::Result<core::Bytes> read(std::uint64_t offset, std::size_t length, const char* what) const;
  core::Result<void> read_header();
  core::Result<void> read_index(std::size_t at, std::string_view header_json);
  core::Result<void> copy_brick(std::size_t brick, const Box& box, Volume& out) const;
};

core::Result<core::Bytes> VolumeFile::State::read(std::uint64_t offset, std::size_t length,
                                                  const char* what) const {
  if (offset > size || length > size - offset)
    return corrupt(path, fmt::format("{} of {} bytes at offset {}, the file has {}", what, length,
                                     offset, size));
  core::Bytes out(length);
  for (std::size_t done = 0; done < length;) {
    const ssize_t n =
        ::pread(fd, out.data() + done, length - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return core::system_error(path, "cannot read");
    if (n == 0) return corrupt(path, fmt::format("{} ends early", what));
    done += static_cast<std::size_t>(n);
  }
  return out;
}

core::Result<void> VolumeFile::State::read_header() {
  auto start = read(0, kPreambleBytes, "preamble");
  if (!start || core::text_of(core::ByteView(*start).first(8)) != kVolumeMagic)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: not a tractus-volume file", path.string())};
  if (const auto version = u32_at(*start, 8); version != kVolumeVersion)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: version {} of the format, {} is known", path.string(),
                                   version, kVolumeVersion)};
  const std::size_t length = u32_at(*start, 12);
  if (length > kHeaderLimitBytes)
    return corrupt(
        path, fmt::format("header of {} bytes, at most {} are taken", length, kHeaderLimitBytes));
  auto json = TRY(read(kPreambleBytes, length, "header"));
  auto parsed = TRY(parse_header(core::text_of(json), path.string() + ": header"));
  header = std::move(parsed);
  return read_index(kPreambleBytes + length, core::text_of(json));
}

core::Result<void> VolumeFile::State::read_index(std::size_t at, std::string_view header_json) {
  const auto grid = brick_grid(header.geometry.dims);
  const auto count = static_cast<std::size_t>(grid[0]) * static_cast<std::size_t>(grid[1]) *
                     static_cast<std::size_t>(grid[2]);
  auto index = TRY(read(at, count * kIndexEntryBytes, "index"));
  core::Sha256 name;
  name.add(core::bytes_of(header_json));
  std::uint64_t offset = at + count * kIndexEntryBytes;
  for (std::size_t b = 0; b < count; ++b) {
    const auto entry = core::ByteView(index).subspan(b * kIndexEntryBytes, kIndexEntryBytes);
    const auto digest = entry.subspan(4);
    bricks.push_back({offset, u32_at(entry, 0), core::Bytes(digest.begin(), digest.end())});
    const auto limit = stored_brick_limit(voxels_in(brick_box(header.geometry.dims, b)));
    if (bricks.back().length > limit)
      return corrupt(path, fmt::format("brick {} of {} bytes, at most {} are possible", b,
                                       bricks.back().length, limit));
    offset += bricks.back().length;
    name.add(digest);
  }
  if (offset != size)
    return corrupt(path, fmt::format("bricks end at byte {}, the file has {}", offset, size));
  id = name.hex();
  return {};
}

core::Result<void> VolumeFile::State::copy_brick(std::size_t brick, const Box& box,
                                                 Volume& out) const {
  const BrickEntry& entry = bricks[brick];
  const Box from = brick_box(header.geometry.dims, brick);
  auto stored = TRY(read(entry.offset, entry.length, "brick"));
  auto counts = brick_counts(stored, voxels_in(from), entry.digest);
  if (!counts)
    return corrupt(path,
                   fmt::format("brick {} of {}: {}", brick, bricks.size(), counts.error().what));
  std::array<int, 3> low{}, high{};
  for (std::size_t a = 0; a < 3; ++a) {
    low[a] = std::max(from.begin[a], box.begin[a]);
    high[a] = std::min(from.end[a], box.end[a]);
  }
  const auto nx = static_cast<std::size_t>(from.end[0] - from.begin[0]);
  const auto ny = static_cast<std::size_t>(from.end[1] - from.begin[1]);
  for (int k = low[2]; k < high[2]; ++k)
    for (int j = low[1]; j < high[1]; ++j) {
      const std::size_t row = (static_cast<std::size_t>(k - from.begin[2]) * ny +
                               static_cast<std::size_t>(j - from.begin[1])) *
                                  nx +
                              static_cast<std::size_t>(low[0] - from.begin[0]);
      std::copy_n(
          counts->begin() + static_cast<std::ptrdiff_t>(row), high[0] - low[0],
          out.counts.begin() + static_cast<std::ptrdiff_t>(out.offset(
                                   low[0] - box.begin[0], j - box.begin[1], k - box.begin[2])));
    }
  return {};
}

VolumeFile::VolumeFile(std::unique_ptr<State> state) : state_(std::move(state)) {}
VolumeFile::~VolumeFile() = default;
VolumeFile::VolumeFile(VolumeFile&&) noexcept = default;
VolumeFile& VolumeFile::operator=(VolumeFile&&) noexcept = default;

core::Result<VolumeFile> VolumeFile::open(const fs::path& path) {
  auto state = std::make_unique<State>();
  state->path = path;
  state->fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (state->fd < 0) return core::system_error(path, "cannot open");
  struct stat info {};
  if (::fstat(state->fd, &info) != 0) return core::system_error(path, "cannot look at");
  if (!S_ISREG(info.st_mode))
    return core::Error{core::Errc::bad_input, fmt::format("{}: not a regular file", path.string())};
  state->size = static_cast<std::uint64_t>(info.st_size);
  TRY(state->read_header());
  return VolumeFile(std::move(state));
}

const Geometry& VolumeFile::geometry() const noexcept { return state_->header.geometry; }
double VolumeFile::slope() const noexcept { return state_->header.slope; }
double VolumeFile::intercept() const noexcept { return state_->header.intercept; }
const std::string& VolumeFile::id() const noexcept { return state_->id; }
const VolumeMeta& VolumeFile::meta() const noexcept { return state_->header.meta; }
std::array<double, 2> VolumeFile::value_range() const noexcept {
  return state_->header.value_range;
}
const Histogram& VolumeFile::histogram() const noexcept { return state_->header.histogram; }
std::size_t VolumeFile::brick_count() const noexcept { return state_->bricks.size(); }

core::Result<Volume> VolumeFile::read_all(const core::Progress& progress) const {
  return read_box({{0, 0, 0}, geometry().dims}, progress);
}

core::Result<Volume> VolumeFile::read_box(const Box& box, const core::Progress& progress) const {
  const auto& dims = geometry().dims;
  Volume out{geometry(), slope(), intercept(), {}};
  std::array<int, 3> first{}, last{};
  for (std::size_t a = 0; a < 3; ++a) {
    if (box.begin[a] < 0 || box.begin[a] >= box.end[a] || box.end[a] > dims[a])
      return core::Error{
          core::Errc::out_of_range,
          fmt::format("{}: voxels {} to {} of axis {}, it has {}", state_->path.string(),
                      box.begin[a], box.end[a], a + 1, dims[a])};
    out.geometry.dims[a] = box.end[a] - box.begin[a];
    first[a] = box.begin[a] / kBrickEdge;
    last[a] = (box.end[a] - 1) / kBrickEdge;
  }
  out.geometry.origin_m = geometry().position_of(Vec3(box.begin[0], box.begin[1], box.begin[2]));
  out.counts.resize(out.geometry.voxel_count());
  const auto grid = brick_grid(dims);
  std::vector<std::size_t> wanted;
  for (int z = first[2]; z <= last[2]; ++z)
    for (int y = first[1]; y <= last[1]; ++y)
      for (int x = first[0]; x <= last[0]; ++x)
        wanted.push_back(static_cast<std::size_t>((z * grid[1] + y) * grid[0] + x));
  for (std::size_t at = 0; at < wanted.size(); at += kBatch) {
    const std::size_t count = std::min(kBatch, wanted.size() - at);
    std::array<std::optional<core::Error>, kBatch> failed;
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t b) {
      if (auto copied = state_->copy_brick(wanted[at + b], box, out); !copied)
        failed[b] = copied.error();
    });
    for (const auto& failure : failed)
      if (failure) return *failure;
    if (progress && !progress(static_cast<double>(at + count) / static_cast<double>(wanted.size())))
      return core::Error{core::Errc::cancelled, "reading the volume was stopped"};
  }
  return out;
}

}  // namespace volume
}  // namespace tractus
