/// Bounds the size of a folder of objects that are kept elsewhere.
#pragma once

#include <atomic>
#include <filesystem>
#include <mutex>

namespace tractus::store {

class CacheLimit {
 public:
  CacheLimit(std::filesystem::path root, std::uint64_t most_bytes)
      : root_(std::move(root)), most_bytes_(most_bytes), added_bytes_(most_bytes) {}

  /// Notes a new file. Removes files when an eighth of the limit was added since it last did; the
  /// first time at once, since what others added is not known.
  void added(const std::filesystem::path& file);

 private:
  void trim() const;
  std::filesystem::path root_;
  std::uint64_t most_bytes_;
  std::atomic<std::uint64_t> added_bytes_;
  std::mutex trimming_;
};

}  // namespace tractus::store
