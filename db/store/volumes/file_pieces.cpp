#include "db/store/volumes/file_pieces.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "core/file.hpp"

namespace tractus {
namespace store {

core::Result<FilePieces> FilePieces::open(const std::filesystem::path& path) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return core::system_error(path, "cannot open");
  FilePieces out(path, fd);
  struct stat facts {};
  if (::fstat(fd, &facts) != 0) return core::system_error(path, "cannot look at");
  out.size_ = static_cast<std::uint64_t>(facts.st_size);
  return out;
}

FilePieces::~FilePieces() {
  if (fd_ >= 0) ::close(fd_);
}

core::Result<core::Bytes> FilePieces::next(std::size_t most_bytes) {
  core::Bytes out(std::min<std::uint64_t>(most_bytes, size_ - bytes_));
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t n = ::read(fd_, out.data() + done, out.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return core::system_error(path_, "cannot read");
    if (n == 0) return core::Error{core::Errc::corrupt, path_.string() + ": was cut short"};
    done += static_cast<std::size_t>(n);
  }
  bytes_ += done;
  return out;
}

}  // namespace store
}  // namespace tractus
