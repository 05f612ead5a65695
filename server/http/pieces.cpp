#include "server/http/pieces.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>

namespace tractus::http {
namespace {

// Copied through the cache: 1.2 times as fast as sendfile(2) to four stations on a loopback of two
// cores (tests/bench/distribution).
constexpr std::size_t kCopied_bytes = 512 * 1024;
constexpr std::chrono::milliseconds kMostWait{2};  ///< of a worker for one socket

}  // namespace

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
  using Clock = std::chrono::steady_clock;
  thread_local std::string piece(kCopied_bytes, '\0');
  const auto until = Clock::now() + kMostWait;
  std::uint64_t done = 0;
  while (done < size) {
    // A full socket costs no read. Once it has taken some, waiting is cheaper than coming back.
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd room{.fd = socket.fd_, .events = POLLOUT, .revents = 0};
    if (::poll(&room, 1, done == 0 || left < 0 ? 0 : int(left)) <= 0) return done;
    const std::size_t next = std::min<std::uint64_t>(kCopied_bytes, size - done);
    const ssize_t read = ::pread(fd_, piece.data(), next, static_cast<off_t>(offset + done));
    if (read < 0 && errno == EINTR) continue;
    if (read <= 0) return std::nullopt;
    const ssize_t n =
        ::send(socket.fd_, piece.data(), static_cast<std::size_t>(read), MSG_NOSIGNAL);
    if (n > 0)
      done += static_cast<std::uint64_t>(n);
    else if (errno != EAGAIN && errno != EINTR)
      return std::nullopt;
  }
  return done;
}

}  // namespace tractus::http
