#include "station/sensors/row_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "core/file.hpp"

namespace tractus {
namespace sensors {
namespace {
constexpr core::Instant_ns kEach_ns = 500'000'000;
constexpr std::size_t kMostWaiting = 64 * 1024;
}  // namespace

core::Result<RowFile> RowFile::make(const std::filesystem::path& path, std::string_view header) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (fd < 0) return core::system_error(path, "cannot make it");
  RowFile out(path, fd);
  out.waiting_ = header;
  out.write();
  if (out.error_) return *out.error_;
  return out;
}

RowFile::RowFile(RowFile&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      waiting_(std::move(other.waiting_)),
      size_(other.size_),
      written_at_(other.written_at_),
      error_(std::move(other.error_)) {}

RowFile::~RowFile() {
  if (fd_ >= 0) ::close(fd_);
}

void RowFile::write() {
  std::string_view rest = waiting_;
  while (!rest.empty() && !error_) {
    const ssize_t n = ::write(fd_, rest.data(), rest.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) error_ = core::system_error(path_.filename(), "cannot write");
    if (n > 0) rest.remove_prefix(std::size_t(n));
  }
  if (error_) {  // what got there ends with a whole row
    const std::string_view there =
        std::string_view(waiting_).substr(0, waiting_.size() - rest.size());
    const auto whole = there.rfind('\n') + 1;  // 0 when there is none
    if (::ftruncate(fd_, off_t(size_ + whole)) != 0) return;
  }
  size_ += waiting_.size();
  waiting_.clear();
}

void RowFile::add(std::string_view row, core::Instant_ns now) {
  if (error_) return;
  waiting_ += row;
  if (waiting_.size() < kMostWaiting && now - written_at_ < kEach_ns) return;
  written_at_ = now;
  write();
}

core::Result<void> RowFile::finish() {
  if (!error_) write();
  if (!error_ && ::fsync(fd_) != 0) error_ = core::system_error(path_.filename(), "cannot flush");
  if (error_) return *error_;
  return {};
}

}  // namespace sensors
}  // namespace tractus
