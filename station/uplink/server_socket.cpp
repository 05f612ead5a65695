#include "station/uplink/server_socket.hpp"

#include <curl/curl.h>
#include <fmt/format.h>
#include <poll.h>

#include <chrono>

#include "core/try.hpp"

namespace tractus {
namespace uplink {
namespace {

constexpr long kConnect_s = 5;
constexpr int kAnswer_ms = 10'000, kSend_ms = 5'000;
constexpr std::size_t kMaxHead_bytes = 16 * 1024;
using Clock = std::chrono::steady_clock;

core::Error broken(const std::string& why) {
  return {core::Errc::unavailable, "live line: " + why};
}

int stops(void* stopped, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  return static_cast<const std::atomic<bool>*>(stopped)->load() ? 1 : 0;
}

class CurlLine final : public ServerSocket {
 public:
  CurlLine() : handle_(curl_easy_init()) {}
  ~CurlLine() override {
    if (!handle_) return;
    if (open_) static_cast<void>(send_frame(Opcode::close, ""));
    curl_easy_cleanup(handle_);
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
    curl_easy_setopt(handle_, CURLOPT_CONNECTTIMEOUT, kConnect_s);
    curl_easy_setopt(handle_, CURLOPT_NOPROGRESS, 0L);
    curl_easy_setopt(handle_, CURLOPT_XFERINFOFUNCTION, stops);
    curl_easy_setopt(handle_, CURLOPT_XFERINFODATA,
                     const_cast<std::atomic<bool>*>(&stopped));  // only read
    if (const CURLcode code = curl_easy_perform(handle_); code != CURLE_OK)
      return broken(curl_easy_strerror(code));
    curl_easy_getinfo(handle_, CURLINFO_ACTIVESOCKET, &socket_);
    const std::string key = core::base64(core::random_bytes(16));
    const std::string host = to.url.substr(to.url.find("://") + 3);
    TRY(send_all(websocket_request(host, to.path, to.authorization, key), kAnswer_ms));
    return take_answer(key);
  }

  core::Result<void> send(const std::string& text) override {
    return send_frame(Opcode::text, text);
  }

  core::Result<std::optional<std::string>> receive(int patience_ms) override {
    const auto until = Clock::now() + std::chrono::milliseconds(patience_ms);
    while (true) {
      auto event = TRY(reader_.next());
      if (event) {
        if (event->opcode == Opcode::text) return std::optional(std::move(event->payload));
        if (event->opcode == Opcode::close) return open_ = false, broken("the server closed it");
        if (event->opcode == Opcode::ping) TRY(send_frame(Opcode::pong, event->payload));
        continue;
      }
      auto more = TRY(receive());
      if (!more.empty()) {
        reader_.add(more);
        continue;
      }
      const auto left = until - Clock::now();
      if (left <= Clock::duration::zero()) return std::optional<std::string>();
      wait(POLLIN, left);
    }
  }

 private:
  void wait(short what, Clock::duration time) const {
    const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(time).count() + 1;
    pollfd waiting{socket_, what, 0};
    ::poll(&waiting, 1, static_cast<int>(ms));
  }

  /// Whatever is there; empty: nothing just now.
  core::Result<std::string> receive() {
    std::string piece(16 * 1024, '\0');
    std::size_t got = 0;
    const CURLcode code = curl_easy_recv(handle_, piece.data(), piece.size(), &got);
    if (code == CURLE_AGAIN) return std::string();
    if (code != CURLE_OK || got == 0) return open_ = false, broken("the connection is gone");
    piece.resize(got);
    return piece;
  }

  core::Result<void> send_all(std::string_view bytes, int patience_ms) {
    const auto until = Clock::now() + std::chrono::milliseconds(patience_ms);
    while (!bytes.empty()) {
      std::size_t sent = 0;
      const CURLcode code = curl_easy_send(handle_, bytes.data(), bytes.size(), &sent);
      bytes.remove_prefix(code == CURLE_OK ? sent : 0);
      if (code == CURLE_OK) continue;
      const auto left = until - Clock::now();
      if (code != CURLE_AGAIN || left <= Clock::duration::zero())
        return open_ = false, broken("the server does not take what is sent");
      wait(POLLOUT, left);
    }
    return {};
  }

  core::Result<void> send_frame(Opcode opcode, std::string_view payload) {
    const core::Bytes random = core::random_bytes(4);
    std::array<std::byte, 4> mask{};
    std::copy(random.begin(), random.end(), mask.begin());
    return send_all(websocket_frame(opcode, payload, mask), kSend_ms);
  }

  core::Result<void> take_answer(const std::string& key) {
    const auto until = Clock::now() + std::chrono::milliseconds(kAnswer_ms);
    std::string head;
    while (head.find("\r\n\r\n") == std::string::npos) {
      auto more = TRY(receive());
      head += more;
      const auto left = until - Clock::now();
      if (head.size() > kMaxHead_bytes || left <= Clock::duration::zero())
        return broken("the server does not answer");
      if (more.empty()) wait(POLLIN, left);
    }
    const auto end = head.find("\r\n\r\n") + 4;
    TRY(check_acceptance(std::string_view(head).substr(0, end), key));
    reader_.add(std::string_view(head).substr(end));
    open_ = true;
    return {};
  }

  CURL* handle_;
  curl_socket_t socket_ = CURL_SOCKET_BAD;
  bool open_ = false;
  WebSocketReader reader_;
};

}  // namespace

core::Result<std::unique_ptr<ServerSocket>> open_server_socket(const ServerAddress& to,
                                                               const std::atomic<bool>& stopped) {
  auto line = std::make_unique<CurlLine>();
  TRY(line->open(to, stopped));
  return std::unique_ptr<ServerSocket>(std::move(line));
}

}  // namespace uplink
}  // namespace tractus
