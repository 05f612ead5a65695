/// A folder for one test, gone with it.
#pragma once

#include <filesystem>

#include "core/bytes.hpp"

namespace tractus::test_support {

class Scratch {
 public:
  Scratch();
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }
  /// Entries in it, folders included.
  std::size_t entries() const;

 private:
  std::filesystem::path path_;
};

/// Writes a file; ends the test program when it cannot.
void put(const std::filesystem::path& path, core::ByteView bytes);
/// The same, compressed by gzip.
void put_gzip(const std::filesystem::path& path, core::ByteView bytes);
/// A gzip file that inflates to `size` zero bytes after `start`; takes little memory to make.
void put_gzip_of_zeros(const std::filesystem::path& path, core::ByteView start, std::uint64_t size);

}  // namespace tractus::test_support
