#include "server/http/spool.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <cerrno>

#include "server/http/coroutine.hpp"
#include "server/http/pieces.hpp"

namespace tractus {
namespace http {
namespace {

constexpr double kLeastRate_bytes_s = 256.0 * 1024.0;

struct OpeningFile {
  SpooledFile* file;
  const SpoolLimits* limits;
  bool operator()() const {
    file->path = limits->space->new_name();
    file->fd = ::open(file->path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
    return file->fd >= 0;
  }
};

struct WritingPiece {
  int fd;
  const char* from;
  std::size_t size;
  bool operator()() const {
    for (std::size_t done = 0; done < size;) {
      const ssize_t n = ::write(fd, from + done, size - done);
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) return false;
      done += static_cast<std::size_t>(n);
    }
    return true;
  }
};

}  // namespace

SpooledFile::~SpooledFile() {
  if (fd < 0) return;
  ::close(fd);
  ::unlink(path.c_str());
}

boost::asio::awaitable<boost::system::error_code> spool_body(
    Stream& stream, boost::beast::flat_buffer& buffer,
    boost::beast::http::request_parser<boost::beast::http::string_body>& parser,
    const SpoolLimits& limits, boost::asio::thread_pool& workers, SpooledFile& into_file) {
  namespace bh = boost::beast::http;
  boost::system::error_code failure;
  if (!co_await on_workers(workers, OpeningFile{&into_file, &limits})) {
    into_file.broken = true;
    co_return failure;
  }
  bh::request_parser<bh::buffer_body> body(std::move(parser));
  body.body_limit(limits.max_bytes);
  std::string piece(kPiece_bytes, '\0');
  const auto most_s = std::chrono::duration<double>(double(limits.max_bytes) / kLeastRate_bytes_s);
  const auto deadline = std::chrono::steady_clock::now() + limits.patience +
                        std::chrono::duration_cast<std::chrono::milliseconds>(most_s);
  while (!body.is_done()) {
    body.get().body().data = piece.data();
    body.get().body().size = piece.size();
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    stream.expires_after(std::max(std::chrono::milliseconds(1), std::min(limits.patience, left)));
    co_await bh::async_read(stream, buffer, body, into(failure));
    if (failure == bh::error::need_buffer) failure = {};
    if (failure) co_return failure;
    stream.expires_never();
    const std::size_t size = piece.size() - body.get().body().size;
    if (!co_await on_workers(workers, WritingPiece{into_file.fd, piece.data(), size})) {
      into_file.broken = true;
      co_return failure;
    }
  }
  co_return failure;
}

}  // namespace http
}  // namespace tractus
