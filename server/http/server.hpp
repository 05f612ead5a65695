/// The listening side: sockets, limits, time-outs.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/http/lane.hpp"
#include "server/http/message.hpp"
#include "server/http/networks.hpp"
#include "server/http/scratch_space.hpp"
#include "server/http/websocket_handler.hpp"

namespace tractus::http {

struct ServerOptions {
  std::string address = "127.0.0.1";
  std::uint16_t port = 8480;  ///< 0: any free one
  /// PEM files of a certificate chain and its key; none: plain HTTP.
  std::optional<std::pair<std::filesystem::path, std::filesystem::path>> tls;
  bool behind_proxy = false;  ///< browsers reach it by TLS, by way of a proxy
  /// Behind a proxy: whose X-Forwarded-For is believed; the peer is whom it names last.
  Networks proxies = Networks::loopback();
  int workers = 4;  ///< threads on which handlers run, but for those of a lane
  LaneLimits hashing = hashing_limits();
  LaneLimits remote{.threads = 4, .waiting_strangers = 8, .waiting = 32};
  int max_connections = 512;  ///< for one more, that which has kept us waiting longest is closed
  std::uint32_t max_header_bytes = 16 * 1024;
  std::chrono::milliseconds header_time{
      10'000};  ///< from a request's first byte to the end of its head
  std::chrono::milliseconds idle_time{60'000};   ///< between requests
  std::chrono::milliseconds body_time{60'000};   ///< for a whole body
  std::chrono::milliseconds write_time{60'000};  ///< for each piece (256 KiB) of an answer
  std::chrono::milliseconds drain_time{10'000};  ///< for requests under way once told to stop
  ScratchSpace* scratch = nullptr;  ///< for bodies that go to a file; none: all stay in memory
  std::chrono::milliseconds silence_time{30'000};  ///< of a WebSocket, pings unanswered
  std::chrono::milliseconds talk_write_time{
      5'000};  ///< for a WebSocket's listener to take a message
};

/// How a body is taken.
struct Admitted {
  std::uint64_t limit_bytes = 0;
  bool to_file = false;     ///< into ServerOptions::scratch
  std::string client = {};  ///< who sends it, by whatever name ScratchSpace shall know it
};

/// What the server does with requests. All are called on worker threads, several at a time.
struct Service {
  /// Sees the head before the body is read: how to take it, or a refusal.
  std::function<std::variant<Admitted, Response>(const RequestHead&)> admit;
  std::function<Response(const Request&)> handle;
  /// A request for a WebSocket: a refusal, or who answers in it. Empty: none are held.
  std::function<std::variant<Response, std::shared_ptr<WebSocketHandler>>(const RequestHead&)>
      converse = {};
  /// Which threads handle it? Called on the input/output thread. Empty: the workers, always.
  std::function<Lane(const RequestHead&)> lane = {};
  /// For a lane with a queue, once the body is there: whose request it is, or a refusal.
  std::function<std::variant<Standing, Response>(const RequestHead&)> standing = {};
};

/// One listening socket, HTTP/1.1 with keep-alive. `open` binds; `run` serves in the calling thread
/// until `stop`.
class Server {
 public:
  /// Errors: bad_input (not an address), unavailable (in use, not allowed).
  static core::Result<Server> open(const ServerOptions& options, Service service);
  ~Server();
  Server(Server&&) noexcept;
  std::uint16_t port() const;
  /// Returns after the last connection is closed, at the latest `drain_time` after `stop`.
  void run();
  /// Closes the listening socket, lets requests under way finish. Safe from any thread, more than
  /// once.
  void stop();

 private:
  struct State;
  explicit Server(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tractus::http
