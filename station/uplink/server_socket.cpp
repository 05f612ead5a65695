#include "station/uplink/server_socket.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <boost/asio/compose.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/buffers_range.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>

#include "core/try.hpp"
#include "core/words.hpp"
#include "station/uplink/server.hpp"

namespace tractus {
namespace uplink {
namespace {
namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;
using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr long kSocketConnect_s = 5;
constexpr milliseconds kAnswer{10'000}, kSend{5'000}, kGoodbye{200}, kLook{100};
constexpr std::size_t kMostHead_bytes = 16 * 1024, kMostMessage_bytes = 64 * 1024;

core::Error broken(const std::string& why) {
  return {core::Errc::unavailable, "live line: " + why};
}

int stops(void* stopped, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<const std::atomic<bool>*>(stopped)->load() ? 1 : 0;
}

/// libcurl's connection as a stream of Beast's: libcurl has the bytes and TLS, Asio waits.
class CurlStream {
 public:
  using executor_type = net::posix::stream_descriptor::executor_type;

  CurlStream(net::io_context& io, CURL* handle, curl_socket_t socket)
      : handle_(handle), socket_(io, socket) {}
  ~CurlStream() { socket_.release(); }  // libcurl closes it
  CurlStream(const CurlStream&) = delete;
  CurlStream& operator=(const CurlStream&) = delete;

  executor_type get_executor() noexcept { return socket_.get_executor(); }
  /// No more than so many bytes are read from now on.
  void allow(std::size_t bytes) { allowed_ = bytes; }

  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    const auto to = first_of<net::mutable_buffer>(buffers);
    return transferred(
        net::posix::stream_descriptor::wait_read,
        [this, to](std::size_t& size) {
          const CURLcode code = curl_easy_recv(handle_, to.data(), to.size(), &size);
          if (code != CURLE_OK) return code;
          if (size == 0 || size > allowed_) return CURLE_RECV_ERROR;  // its end, or too much
          allowed_ -= size;
          return code;
        },
        token);
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    const auto from = first_of<net::const_buffer>(buffers);
    return transferred(
        net::posix::stream_descriptor::wait_write,
        [this, from](std::size_t& size) {
          return curl_easy_send(handle_, from.data(), from.size(), &size);
        },
        token);
  }
  void hang_up() {
    error_code ignored;
    socket_.cancel(ignored);
  }

 private:
  template <class Buffer, class Buffers>
  static Buffer first_of(const Buffers& buffers) {
    for (const Buffer each : beast::buffers_range_ref(buffers))
      if (each.size() > 0) return each;
    return {};
  }

  /// Tries at once, since TLS may hold bytes that the socket does not show, then whenever the
  /// socket is ready. What is done at once is told by the queue, as Asio's callers expect.
  template <class Try, class Token>
  auto transferred(net::posix::stream_descriptor::wait_type ready, Try attempt, Token& token) {
    return net::async_compose<Token, void(error_code, std::size_t)>(
        [this, ready, attempt, queued = false, done = false, size = std::size_t{0},
         said = error_code{}](auto& self, error_code failure = {}) mutable {
          if (done) return self.complete(said, size);
          const CURLcode code = failure ? CURLE_ABORTED_BY_CALLBACK : attempt(size);
          if (code == CURLE_AGAIN) {
            queued = true;
            return socket_.async_wait(ready, std::move(self));
          }
          done = true;
          if (code != CURLE_OK) said = net::error::connection_reset, size = 0;
          if (queued) return self.complete(said, size);
          net::post(socket_.get_executor(), std::move(self));
        },
        token, socket_);
  }

  CURL* handle_;
  net::posix::stream_descriptor socket_;
  std::size_t allowed_ = SIZE_MAX;
};

void beast_close_socket(CurlStream& stream) { stream.hang_up(); }
/// TLS's goodbye is libcurl's.
template <class Handler>
void async_teardown(beast::role_type, CurlStream& stream, Handler&& handler) {
  net::post(stream.get_executor(),
            beast::bind_front_handler(std::forward<Handler>(handler), error_code()));
}

class BeastLine final : public ServerSocket {
 public:
  BeastLine() : handle_(curl_easy_init()) {}
  ~BeastLine() override {
    if (open_) {
      std::optional<error_code> parted;
      socket_->async_close(websocket::close_code::normal,
                           [&parted](error_code failure) { parted = failure; });
      run(parted, kGoodbye);
    }
    socket_.reset();
    if (handle_) curl_easy_cleanup(handle_);
  }

  core::Result<void> open(const ServerAddress& to, const std::atomic<bool>& stopped) {
    if (!handle_) return broken("libcurl does not start");
    curl_easy_setopt(handle_, CURLOPT_URL, to.url.c_str());
    curl_easy_setopt(handle_, CURLOPT_CONNECT_ONLY, 1L);
    curl_easy_setopt(handle_, CURLOPT_PROTOCOLS_STR, "http,https");
    curl_easy_setopt(handle_, CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_1_1));
    curl_easy_setopt(handle_, CURLOPT_SSLVERSION, CURL_SSLVERSION_TLSv1_2);
    if (!to.authority.empty()) {
      curl_easy_setopt(handle_, CURLOPT_CAINFO, to.authority.c_str());
      curl_easy_setopt(handle_, CURLOPT_CAPATH, nullptr);
    }
    curl_easy_setopt(handle_, CURLOPT_NOSIGNAL, 1L);
    curl_easy_setopt(handle_, CURLOPT_CONNECTTIMEOUT, kSocketConnect_s);
    curl_easy_setopt(handle_, CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(handle_, CURLOPT_XFERINFOFUNCTION, stops);
    curl_easy_setopt(handle_, CURLOPT_XFERINFODATA,
                     const_cast<std::atomic<bool>*>(&stopped));  // only read
    if (const CURLcode code = curl_easy_perform(handle_); code != CURLE_OK)
      return broken(curl_easy_strerror(code));
    curl_socket_t socket = CURL_SOCKET_BAD;
    curl_easy_getinfo(handle_, CURLINFO_ACTIVESOCKET, &socket);
    socket_.emplace(io_, handle_, socket);
    return shake_hands(to, stopped);
  }

  core::Result<void> send(const std::string& text) override {
    if (!open_) return broken("it is closed");
    sending_ = text;
    sent_.reset();
    socket_->async_write(net::buffer(sending_),
                         [this](error_code failure, std::size_t) { sent_ = failure; });
    if (!run(sent_, kSend) || *sent_)
      return open_ = false, broken("the server does not take what is sent");
    return {};
  }

  core::Result<std::optional<std::string>> receive(int patience_ms) override {
    if (!open_) return broken("it is closed");
    if (!reading_) {
      reading_ = true;
      read_.reset();
      socket_->async_read(received_, [this](error_code failure, std::size_t) { read_ = failure; });
    }
    if (!run(read_, milliseconds(patience_ms))) return std::optional<std::string>();
    reading_ = false;
    if (*read_) return open_ = false, parting(*read_);
    if (!socket_->got_text())
      return open_ = false,
             core::Error{core::Errc::bad_input, "live line: the server sends what is no text"};
    std::string text = beast::buffers_to_string(received_.data());
    received_.clear();
    return std::optional(std::move(text));
  }

 private:
  /// Lets what was begun go on until it is done or the time is over. Is it done?
  bool run(const std::optional<error_code>& done, milliseconds patience) {
    const auto until = Clock::now() + patience;
    io_.restart();
    io_.poll();
    while (!done && io_.run_one_until(until) > 0) {
    }
    return done.has_value();
  }

  core::Result<void> shake_hands(const ServerAddress& to, const std::atomic<bool>& stopped) {
    socket_->read_message_max(kMostMessage_bytes);
    socket_->auto_fragment(false);  // the server counts fragments as it counts messages
    socket_->next_layer().allow(kMostHead_bytes);
    socket_->set_option(
        websocket::stream_base::decorator([headers = to.headers](websocket::request_type& request) {
          for (const auto& [name, value] : headers) request.set(name, value);
        }));
    socket_->async_handshake(answer_, to.url.substr(to.url.find("://") + 3), to.path,
                             [this](error_code failure) { shaken_ = failure; });
    for (auto left = kAnswer; !run(shaken_, kLook); left -= kLook)
      if (stopped || left <= milliseconds(0)) return broken("the server does not answer");
    if (*shaken_ == websocket::error::upgrade_declined)
      return core::Error{error_code_of(static_cast<int>(answer_.result_int())),
                         fmt::format("live line: the server answers {}", answer_.result_int())};
    if (*shaken_) return parting(*shaken_);
    socket_->next_layer().allow(SIZE_MAX);
    open_ = true;
    return {};
  }

  /// Why the line is of no use any more.
  core::Error parting(error_code failure) const {
    if (failure == websocket::error::closed) {
      const auto& said = socket_->reason().reason;
      return broken("the server closed it" +
                    (said.empty() ? "" : ": " + core::one_line({said.data(), said.size()})));
    }
    if (failure == websocket::error::message_too_big)
      return {core::Errc::too_large, "live line: the server sends too long a message"};
    if (failure == net::error::connection_reset || failure == net::error::operation_aborted)
      return broken("the connection is gone");
    return {core::Errc::bad_input, "live line: no WebSocket: " + failure.message()};
  }

  net::io_context io_;  // outlives what waits in it
  CURL* handle_;
  std::optional<websocket::stream<CurlStream>> socket_;
  websocket::response_type answer_;
  beast::flat_buffer received_;
  std::string sending_;
  bool open_ = false, reading_ = false;  ///< a read goes on from one call of `receive` to the next
  std::optional<error_code> shaken_, sent_, read_;
};

}  // namespace

core::Result<std::unique_ptr<ServerSocket>> open_server_socket(const ServerAddress& to,
                                                               const std::atomic<bool>& stopped) {
  auto line = std::make_unique<BeastLine>();
  TRY(line->open(to, stopped));
  return std::unique_ptr<ServerSocket>(std::move(line));
}

}  // namespace uplink
}  // namespace tractus
