#include "server/http/pieces.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/sendfile.h>
#include <unistd.h>

#include <cerrno>

namespace tractus::http {

bool is_closed_by_peer(int socket) {
  pollfd asked{.fd = socket, .events = POLLRDHUP, .revents = 0};
  return ::poll(&asked, 1, 0) > 0;  // POLLHUP and POLLERR need not be asked for
}

File::File(const std::filesystem::path& path) : fd_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}

File File::again(int socket) { return File(::fcntl(socket, F_DUPFD_CLOEXEC, 0)); }

File::~File() {
  if (fd_ >= 0) ::close(fd_);
}

bool File::read_at(std::uint64_t offset, std::string& piece) const {
  std::size_t done = 0;
  while (done < piece.size()) {
    const ssize_t n =
        ::pread(fd_, piece.data() + done, piece.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    done += static_cast<std::size_t>(n);
  }
  return true;
}

std::optional<std::uint64_t> File::send_to(const File& socket, std::uint64_t offset,
                                           std::uint64_t size) const {
  auto at = static_cast<off_t>(offset);
  const ssize_t n = ::sendfile(socket.fd_, fd_, &at, size);
  if (n > 0) return static_cast<std::uint64_t>(n);
  if (n < 0 && (errno == EAGAIN || errno == EINTR)) return 0;
  return std::nullopt;
}

}  // namespace tractus::http
