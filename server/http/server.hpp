/// The HTTP server: sockets, limits, time-outs.
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
  std::uint16_t port = 8480;  ///< 0: any free port
  /// PEM files of a certificate chain and its private key; none: HTTP without TLS.
  std::optional<std::pair<std::filesystem::path, std::filesystem::path>> tls;
  bool behind_proxy = false;  ///< browsers use TLS to a reverse proxy in front of this server
  /// Proxies whose X-Forwarded-For is trusted; the last address in it is then the peer.
  Networks proxies = Networks::loopback();
  int workers = 4;  ///< number of worker threads for handlers, besides the threads of the lanes
  LaneLimits hashing = hashing_limits();
  LaneLimits remote{.threads = 4, .waiting_strangers = 8, .waiting = 32};
  LaneLimits computing{.threads = 2, .waiting_strangers = 4, .waiting = 16};
  int max_connections = 512;  ///< a further one closes the longest idle connection; WebSockets
                              ///< get at most seven eighths of them, so that requests have room
  std::uint32_t max_header_bytes = 16 * 1024;
  std::chrono::milliseconds header_time{
      10'000};  ///< from a request's first byte to the end of its head
  std::chrono::milliseconds idle_time{60'000};   ///< between requests
  std::chrono::milliseconds body_time{60'000};   ///< for a whole body
  std::chrono::milliseconds write_time{60'000};  ///< for each piece (256 KiB) of an answer
  std::chrono::milliseconds drain_time{10'000};  ///< for requests in progress after `stop`
  ScratchSpace* scratch = nullptr;  ///< for bodies in files; null: all bodies stay in memory
  std::chrono::milliseconds silence_time{30'000};  ///< for a WebSocket that does not answer pings
  std::chrono::milliseconds talk_write_time{
      5'000};  ///< for the receiver of a WebSocket to read a message
};

/// How the server receives a body.
struct Admitted {
  std::uint64_t limit_bytes = 0;
  bool to_file = false;     ///< into ServerOptions::scratch
  std::string client = {};  ///< client for ScratchSpace::reserve
};

/// The functions with which the server answers requests. They are called on worker threads,
/// concurrently.
struct Service {
  /// Called with the head before the body is read. Returns how to receive the body, or a refusal.
  std::function<std::variant<Admitted, Response>(const RequestHead&)> admit;
  std::function<Response(const Request&)> handle;
  /// Called for a WebSocket request. Returns a refusal, or the handler of the WebSocket. Empty: the
  /// server has no WebSockets.
  std::function<std::variant<Response, std::shared_ptr<WebSocketHandler>>(const RequestHead&)>
      converse = {};
  /// The threads that handle the request. Called on the input/output thread. Empty: always the
  /// workers.
  std::function<Lane(const RequestHead&)> lane = {};
  /// Called for a lane with a queue after the body was received. Returns who sent the request, or a
  /// refusal.
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
  /// Closes the listening socket and lets requests in progress finish. May be called from any
  /// thread and more than once.
  void stop();

 private:
  struct State;
  explicit Server(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace tractus::http
