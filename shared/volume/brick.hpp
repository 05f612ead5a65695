/// Bricks of the store format: how a volume is cut, and how one piece becomes bytes and back.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/result.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

/// Bricks along each axis, the last ones smaller where the edge does not divide the volume.
std::array<int, 3> brick_grid(const std::array<int, 3>& dims);
/// The voxels of brick `index`; bricks are numbered with i fastest.
Box brick_box(const std::array<int, 3>& dims, std::size_t index);
std::size_t voxels_in(const Box& box);

/// A brick as it lies in the file.
struct StoredBrick {
  core::Bytes bytes;   ///< zstd of the low bytes of all voxels, then their high bytes
  core::Bytes digest;  ///< SHA-256 of its voxels as little-endian 16-bit numbers, 32 bytes
};

/// Compresses the voxels of `box` of a volume.
StoredBrick stored_brick(const Volume& volume, const Box& box);

/// The `voxels` counts of a stored brick, [k][j][i] of its own box. Errors: corrupt, without the
/// file's name.
core::Result<std::vector<std::uint16_t>> brick_counts(core::ByteView stored, std::size_t voxels,
                                                      core::ByteView digest);

/// The most bytes a brick of so many voxels can take in a file.
std::size_t stored_brick_limit(std::size_t voxels);

}  // namespace tractus::volume
