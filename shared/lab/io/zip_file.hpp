/// A zip written to a file, entry by entry, with bounded memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.hpp"

namespace tractus::lab_io {

class ZipFile {
 public:
  /// @param most_bytes  largest size of the zip
  ZipFile(const std::filesystem::path& path, std::uint64_t most_bytes);
  ~ZipFile();
  ZipFile(const ZipFile&) = delete;
  ZipFile& operator=(const ZipFile&) = delete;

  /// No times are written: the same entries are the same bytes. Errors: io; too_large.
  core::Result<void> add(const std::string& name, const std::string& content);
  /// Of a file, in pieces.
  core::Result<void> add(const std::string& name, const std::filesystem::path& content);
  core::Result<void> finish();

 private:
  struct Parts;
  core::Error failure() const;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::lab_io
