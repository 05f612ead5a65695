#include "volume/brick.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <bit>

#include "volume/volume_file.hpp"

namespace tractus {
namespace volume {
namespace {

static_assert(std::endian::native == std::endian::little,
              "voxels are hashed as they lie in memory");

constexpr int kZstdLevel = 3;

std::vector<std::uint16_t> cut(const Volume& volume, const Box& box) {
  std::vector<std::uint16_t> out;
  out.reserve(voxels_in(box));
  for (int k = box.begin[2]; k < box.end[2]; ++k)
    for (int j = box.begin[1]; j < box.end[1]; ++j) {
      const auto* row = volume.counts.data() + volume.offset(box.begin[0], j, k);
      out.insert(out.end(), row, row + (box.end[0] - box.begin[0]));
    }
  return out;
}

/// SHA-256 as 32 bytes.
core::Bytes digest_of(std::span<const std::uint16_t> counts) {
  const std::string hex = core::sha256(std::as_bytes(counts));
  const auto nibble = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  core::Bytes out(hex.size() / 2);
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::byte>(nibble(hex[2 * i]) * 16 + nibble(hex[2 * i + 1]));
  return out;
}

}  // namespace

std::array<int, 3> brick_grid(const std::array<int, 3>& dims) {
  std::array<int, 3> grid{};
  for (std::size_t a = 0; a < 3; ++a) grid[a] = (dims[a] + kBrickEdge - 1) / kBrickEdge;
  return grid;
}

Box brick_box(const std::array<int, 3>& dims, std::size_t index) {
  const auto grid = brick_grid(dims);
  const auto nx = static_cast<std::size_t>(grid[0]), ny = static_cast<std::size_t>(grid[1]);
  const std::array<std::size_t, 3> at{index % nx, index / nx % ny, index / (nx * ny)};
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    box.begin[a] = static_cast<int>(at[a]) * kBrickEdge;
    box.end[a] = std::min(box.begin[a] + kBrickEdge, dims[a]);
  }
  return box;
}

std::size_t voxels_in(const Box& box) {
  std::size_t count = 1;
  for (std::size_t a = 0; a < 3; ++a) count *= static_cast<std::size_t>(box.end[a] - box.begin[a]);
  return count;
}

std::size_t stored_brick_limit(std::size_t voxels) { return ZSTD_compressBound(2 * voxels); }

StoredBrick stored_brick(const Volume& volume, const Box& box) {
  const auto counts = cut(volume, box);
  const std::size_t n = counts.size();
  std::vector<std::uint8_t> planes(2 * n);
  for (std::size_t v = 0; v < n; ++v) {
    planes[v] = static_cast<std::uint8_t>(counts[v] & 0xffu);
    planes[n + v] = static_cast<std::uint8_t>(counts[v] >> 8);
  }
  StoredBrick out{core::Bytes(stored_brick_limit(n)), digest_of(counts)};
  const std::size_t size =
      ZSTD_compress(out.bytes.data(), out.bytes.size(), planes.data(), planes.size(), kZstdLevel);
  core::require(!ZSTD_isError(size), "a brick always fits the bound zstd gave for it");
  out.bytes.resize(size);
  return out;
}

core::Result<std::vector<std::uint16_t>> brick_counts(core::ByteView stored, std::size_t voxels,
                                                      core::ByteView digest) {
  std::vector<std::uint8_t> planes(2 * voxels);
  const std::size_t size =
      ZSTD_decompress(planes.data(), planes.size(), stored.data(), stored.size());
  if (ZSTD_isError(size))
    return core::Error{core::Errc::corrupt,
                       fmt::format("does not decompress: {}", ZSTD_getErrorName(size))};
  if (size != planes.size())
    return core::Error{core::Errc::corrupt, fmt::format("decompresses to {} bytes, {} are expected",
                                                        size, planes.size())};
  std::vector<std::uint16_t> counts(voxels);
  for (std::size_t v = 0; v < voxels; ++v)
    counts[v] = static_cast<std::uint16_t>(planes[v] | planes[voxels + v] << 8);
  if (!std::ranges::equal(digest_of(counts), digest))
    return core::Error{core::Errc::corrupt, "its voxels do not match their checksum"};
  return counts;
}

}  // namespace volume
}  // namespace tractus
