/// A file read from its start, piece by piece.
#pragma once

#include <filesystem>
#include <utility>

#include "core/bytes.hpp"
#include "core/result.hpp"

namespace tractus::store {

class FilePieces {
 public:
  /// Errors: those of the system.
  static core::Result<FilePieces> open(const std::filesystem::path& path);
  ~FilePieces();
  FilePieces(FilePieces&& other) noexcept
      : path_(std::move(other.path_)),
        fd_(std::exchange(other.fd_, -1)),
        size_(other.size_),
        bytes_(other.bytes_) {}
  FilePieces& operator=(FilePieces&&) = delete;

  /// The next bytes, fewer than `most_bytes` only at the end of the file, none behind it. Errors: io,
  /// corrupt (it became shorter).
  core::Result<core::Bytes> next(std::size_t most_bytes);
  std::uint64_t bytes() const { return bytes_; }  ///< read so far
  const std::filesystem::path& path() const { return path_; }

 private:
  FilePieces(std::filesystem::path path, int fd) : path_(std::move(path)), fd_(fd) {}
  std::filesystem::path path_;
  int fd_;
  std::uint64_t size_ = 0, bytes_ = 0;
};

}  // namespace tractus::store
