/// What a foreign file claims of itself, held against what it is, before a library or the memory
/// has to pay for it.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>

#include "core/bytes.hpp"
#include "core/progress.hpp"
#include "core/result.hpp"
#include "math/geometry.hpp"

namespace tractus::volume_io {

core::Error bad(const std::filesystem::path& path, const std::string& why);

/// `claimed` as numbers of voxels: each 1 … 4096, at most 2³¹ together. `where` names the header's
/// field.
core::Result<std::array<int, 3>> checked_dims(const std::array<std::int64_t, 3>& claimed,
                                              const std::filesystem::path& path, const char* where);

/// The first `limit` bytes of a regular file, or of what it holds when it is gzip; fewer when it
/// has no more.
core::Result<core::Bytes> first_bytes(const std::filesystem::path& path, std::size_t limit);

/// Size of a regular file. Errors: not_found, io, bad_input (a folder, a device, a pipe).
core::Result<std::uint64_t> size_of_file(const std::filesystem::path& path);

/// Is the file, from `offset`, compressed by gzip?
bool is_gzip(const std::filesystem::path& path, std::uint64_t offset = 0);

/// Inflates from `offset` without keeping anything and asks for exactly `expected` bytes: less is a
/// truncated file, more a bomb or a lie, and so is a compression no CT reaches (over 200 : 1 beyond
/// 256 MiB).
core::Result<void> check_gzip(const std::filesystem::path& path, std::uint64_t offset,
                              std::uint64_t expected, const core::Progress& progress = {});

/// The orthonormal matrix nearest to unit columns that a file has rounded. Columns further than
/// 0.01° from right angles are refused: a sheared volume (a tilted gantry, an affine registration)
/// has no place in ours.
core::Result<math::Mat3> straightened(const math::Mat3& columns, const std::filesystem::path& path,
                                      const char* where);

/// Text of a file's field, safe to print: one line, no control characters, shortened.
std::string printable(std::string text);

}  // namespace tractus::volume_io
