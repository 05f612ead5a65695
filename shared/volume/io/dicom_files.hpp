/// DICOM files as they would be had nobody deflated them.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::volume_io {

/// Reads the files of one import. A file whose data set is deflated (1.2.840.10008.1.2.1.99, PS3.5
/// A.5) becomes the same data set in the explicit little-endian syntax, without the rest of its meta
/// information; others are as they are.
class DicomFiles {
 public:
  /// Errors: not_found, io; too_large (a file over 2 GiB, or deflated ones over 4 GiB together once
  /// they are inflated, or one over 64 MiB and 100 times its size: no CT compresses so); bad_input
  /// for a deflated data set that is damaged.
  core::Result<core::Bytes> read(const std::filesystem::path& path);

 private:
  std::uint64_t left_bytes_ = 4ull << 30;  ///< that deflated files may still take
};

}  // namespace tractus::volume_io
