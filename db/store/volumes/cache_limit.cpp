#include "db/store/volumes/cache_limit.hpp"

#include <algorithm>
#include <chrono>
#include <vector>

namespace tractus {
namespace store {
namespace fs = std::filesystem;
namespace {

struct CachedFile {
  fs::path path;
  std::uint64_t size_bytes;
  fs::file_time_type used;
};

/// All but those that are being written.
std::vector<CachedFile> cached_files(const fs::path& root) {
  std::vector<CachedFile> out;
  std::error_code failure;
  for (auto at = fs::recursive_directory_iterator(root, failure); at != end(at);
       at.increment(failure)) {
    if (failure) break;
    std::error_code gone;
    if (!at->is_regular_file(gone) || at->path().extension() == ".part") continue;
    const CachedFile file{at->path(), at->file_size(gone), at->last_write_time(gone)};
    if (!gone) out.push_back(file);
  }
  return out;
}

}  // namespace

void CacheLimit::added(const fs::path& file) {
  std::error_code failure;
  const auto size = fs::file_size(file, failure);
  if (!failure) added_bytes_ += size;
  const std::unique_lock lock(trimming_, std::try_to_lock);
  if (!lock || added_bytes_ < most_bytes_ / 8) return;
  added_bytes_ = 0;
  trim();
}

void CacheLimit::trim() const {
  auto files = cached_files(root_);
  std::uint64_t total = 0;
  for (const CachedFile& file : files) total += file.size_bytes;
  std::ranges::sort(files, {}, &CachedFile::used);
  const auto still_used = fs::file_time_type::clock::now() - std::chrono::hours(1);
  for (const CachedFile& file : files) {
    if (total <= most_bytes_ || file.used > still_used) return;
    std::error_code failure;
    if (fs::remove(file.path, failure)) total -= file.size_bytes;
  }
}

}  // namespace store
}  // namespace tractus
