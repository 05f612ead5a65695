/// Includes Asio and Beast, as only stream.hpp, head.hpp, spool.hpp and websocket.cpp do beside it.
#include <utility>  // before Asio: 1.74 uses std::exchange without it
//
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <list>

#include "server/http/coroutine.hpp"
#include "server/http/handling.hpp"
#include "server/http/head.hpp"
#include "server/http/pieces.hpp"
#include "server/http/server.hpp"
#include "server/http/spool.hpp"
#include "server/http/static_files.hpp"
#include "server/http/stream.hpp"
#include "server/http/websocket.hpp"

namespace tractus {
namespace http {
namespace {
namespace net = boost::asio;
namespace beast = boost::beast;
using boost::system::error_code;
using net::ip::tcp;

constexpr std::size_t kLingering_bytes = 16u << 20;
constexpr std::chrono::seconds kLingering_time{2};
constexpr std::chrono::milliseconds kFarewell_time{500};

/// A lane's threads and its queue. Touched by the input/output thread alone.
struct Queue {
  explicit Queue(const LaneLimits& given) : limits(given), threads(given.threads) {}
  bool has_room(Standing standing) const {
    const bool stranger = standing == Standing::stranger;
    return taken < limits.threads + (stranger ? limits.waiting_strangers : limits.waiting);
  }
  LaneLimits limits;
  std::size_t taken = 0;  ///< being handled or waiting
  net::thread_pool threads;
};

Response too_many(const std::string& what, int wait_s) {
  auto response = error_response(503, "unavailable",
                                 fmt::format("too many {}: try again in {} s", what, wait_s));
  return response.with("Retry-After", std::to_string(wait_s)), response;
}

/// What a refused or broken request is answered, or nothing when there is nobody to answer.
std::optional<Response> answer_to(error_code failure) {
  using beast::http::error;
  if (failure == error::header_limit)
    return error_response(431, "too_large", "the request's head is too large");
  if (failure == error::body_limit)
    return error_response(413, "too_large", "the request's body is too large");
  if (failure == beast::error::timeout)
    return error_response(408, "unavailable", "the request took too long to arrive");
  if (failure.category() == make_error_code(error::bad_version).category() &&
      failure != error::end_of_stream && failure != error::partial_message)
    return error_response(400, "bad_input", "this is not HTTP/1.1: " + failure.message());
  return std::nullopt;
}

}  // namespace

struct Server::State {
  State(ServerOptions given, Service what)
      : options(std::move(given)),
        service(std::move(what)),
        workers(static_cast<std::size_t>(options.workers)),
        hashing(options.hashing),
        remote(options.remote),
        computing(options.computing) {}

  struct Connection {
    Connection(tcp::socket socket, net::ssl::context* tls) : stream(std::move(socket), tls) {}
    Stream stream;
    beast::flat_buffer buffer;
    std::string peer;
    bool idle = true;     ///< between requests: closed at once when told to stop
    bool waited = false;  ///< it is we who wait for the other side, since `since`
    bool talking = false;
    std::chrono::steady_clock::time_point since{};

    void wait_for_peer() { waited = true, since = std::chrono::steady_clock::now(); }
  };

  net::awaitable<void> accept_all();
  net::awaitable<void> serve(std::list<Connection>::iterator connection);
  /// One request and its answer; false when the connection is to be closed.
  net::awaitable<bool> exchange(Connection& connection);
  net::awaitable<Response> handle(const Request& request);
  net::awaitable<Response> handle_queued(Queue& queue, const Request& request);
  net::awaitable<bool> converse(Connection& connection, const Parser& parser,
                                const RequestHead& head);
  bool make_room();
  /// Whether another WebSocket leaves enough connections for requests.
  bool may_talk() const;
  net::awaitable<std::optional<Response>> read_body(Connection& connection, Parser& parser,
                                                    const RequestHead& head, SpooledFile& spooled);
  net::awaitable<bool> write(Connection& connection, const RequestHead& head, Response& response,
                             bool keep_alive);
  net::awaitable<void> refuse(Connection& connection, const RequestHead& head, Response& refusal);
  net::awaitable<bool> write_file(Connection& connection, const FileSlice& slice);
  net::awaitable<bool> write_made(Connection& connection, const MadeBody& body);
  net::awaitable<void> linger(Connection& connection);
  net::awaitable<bool> handshake(Connection& connection);
  net::awaitable<void> farewell(Connection& connection);
  void drain();
  void ended(std::list<Connection>::iterator connection);

  ServerOptions options;
  Service service;
  std::optional<net::ssl::context> tls;
  net::io_context io{1};
  net::executor_work_guard<net::io_context::executor_type> guard{io.get_executor()};
  tcp::acceptor acceptor{io};
  net::steady_timer drained{io};
  net::thread_pool workers;
  Queue hashing, remote, computing;
  std::list<Connection> connections;  ///< touched by the input/output thread alone
  std::atomic<bool> draining = false;
};

net::awaitable<void> Server::State::accept_all() {
  while (acceptor.is_open()) {
    error_code failure;
    tcp::socket socket = co_await acceptor.async_accept(into(failure));
    if (failure == net::error::operation_aborted) co_return;
    if (failure) {  // out of descriptors: wait for some to come back
      net::steady_timer pause(io, std::chrono::milliseconds(100));
      co_await pause.async_wait(into(failure));
      continue;
    }
    if (connections.size() >= static_cast<std::size_t>(options.max_connections) && !make_room())
      continue;
    const auto endpoint = socket.remote_endpoint(failure);
    socket.set_option(tcp::no_delay(true), failure);
    socket.native_non_blocking(true, failure);  // File::send_to must not wait for good
    connections.emplace_front(std::move(socket), tls ? &*tls : nullptr);
    connections.front().peer = endpoint.address().to_string(failure);
    net::co_spawn(io, serve(connections.begin()), net::detached);
  }
}

/// Closes the connection that has kept us waiting longest: whoever holds many open and sends little
/// shuts out nobody. False when each is being answered or talks.
bool Server::State::make_room() {
  Connection* longest = nullptr;
  for (Connection& c : connections)
    if (c.waited && !c.talking && (!longest || c.since < longest->since)) longest = &c;
  if (!longest) return false;
  longest->waited = false;
  error_code ignored;
  longest->stream.socket().close(ignored);
  return true;
}

bool Server::State::may_talk() const {
  const auto talking = std::ranges::count(connections, true, &Connection::talking);
  return talking < options.max_connections - options.max_connections / 8;
}

net::awaitable<void> Server::State::serve(std::list<Connection>::iterator connection) {
  try {
    if (co_await handshake(*connection)) {
      while (!draining && co_await exchange(*connection)) {
      }
      co_await farewell(*connection);
    }
    error_code ignored;
    connection->stream.socket().shutdown(tcp::socket::shutdown_both, ignored);
  } catch (const std::exception&) {  // out of memory: this connection ends, the others go on
  }
  ended(connection);
}

net::awaitable<bool> Server::State::handshake(Connection& c) {
  if (!c.stream.is_tls()) co_return true;
  error_code failure;
  c.wait_for_peer();
  c.stream.expires_after(options.header_time);
  co_await c.stream.async_handshake(into(failure));
  co_return !failure;
}

net::awaitable<void> Server::State::farewell(Connection& c) {
  if (!c.stream.is_tls() || draining) co_return;
  error_code ignored;
  c.stream.expires_after(kFarewell_time);
  co_await c.stream.async_shutdown(into(ignored));
}

void Server::State::ended(std::list<Connection>::iterator connection) {
  connections.erase(connection);
  if (draining && connections.empty()) io.stop();
}

net::awaitable<bool> Server::State::exchange(Connection& c) {
  error_code failure;
  c.idle = true;
  c.wait_for_peer();
  if (c.buffer.size() == 0) {
    c.stream.expires_after(options.idle_time);
    const auto n = co_await c.stream.async_read_some(c.buffer.prepare(4096), into(failure));
    if (failure) co_return false;
    c.buffer.commit(n);
  }
  c.idle = false;
  c.wait_for_peer();
  Parser parser;
  parser.header_limit(options.max_header_bytes);
  parser.body_limit(UINT64_MAX);  // the service says later how much; 1.74 takes "none" for 0
  c.stream.expires_after(options.header_time);
  co_await beast::http::async_read_header(c.stream, c.buffer, parser, into(failure));
  if (failure) {
    auto refusal = answer_to(failure);
    const RequestHead nobody;
    if (refusal) co_await refuse(c, nobody, *refusal);
    co_return false;
  }
  auto head = head_of(parser, c.peer, options.behind_proxy ? &options.proxies : nullptr);
  if (!head) {
    Response refusal = error_response(400, "bad_input", head.error().what);
    const RequestHead nobody;
    co_await refuse(c, nobody, refusal);
    co_return false;
  }
  c.waited = false;
  if (service.converse && beast::websocket::is_upgrade(parser.get()))
    co_return co_await converse(c, parser, *head);
  const bool keep_alive = parser.get().keep_alive();
  SpooledFile spooled;
  std::optional<Response> refusal = co_await read_body(c, parser, *head, spooled);
  if (refusal) {
    co_await refuse(c, *head, *refusal);
    co_return false;
  }
  Response response;
  {
    Request request{*head, std::move(parser.get().body()), spooled.path};
    const int socket = c.stream.socket().native_handle();
    request.called_off = [this, socket] { return draining || is_closed_by_peer(socket); };
    c.stream.expires_never();
    response = co_await handle(request);
  }
  const bool stays = keep_alive && !draining;
  const bool written = co_await write(c, *head, response, stays);
  co_return written&& stays;
}

net::awaitable<Response> Server::State::handle(const Request& request) {
  const Lane lane = service.lane ? service.lane(request) : Lane::quick;
  if (lane == Lane::quick) co_return co_await on_workers(workers, Handling{&service, &request});
  Queue& queue = lane == Lane::hashing ? hashing : lane == Lane::remote ? remote : computing;
  co_return co_await handle_queued(queue, request);
}

/// Answers 503 at once when the lane's queue is full: whoever waits in it is answered soon.
net::awaitable<Response> Server::State::handle_queued(Queue& queue, const Request& request) {
  Ranked ranked = co_await on_workers(workers, Ranking{&service, &request});
  if (auto* refusal = std::get_if<Response>(&ranked)) co_return std::move(*refusal);
  if (!queue.has_room(std::get<Standing>(ranked)))
    co_return too_many("requests at the same time", 2);
  ++queue.taken;
  Response response = co_await on_workers(queue.threads, Handling{&service, &request});
  --queue.taken;
  co_return response;
}

net::awaitable<bool> Server::State::converse(Connection& c, const Parser& parser,
                                             const RequestHead& head) {
  c.stream.expires_never();
  Opening opened = co_await on_workers(workers, OpeningWebSocket{&service, &head});
  if (auto* refusal = std::get_if<Response>(&opened)) {
    co_await refuse(c, head, *refusal);
    co_return false;
  }
  if (c.buffer.size() > 0 || draining) co_return false;  // it spoke before it was let in
  if (!may_talk()) {
    Response full = too_many("open WebSockets", 10);
    co_await refuse(c, head, full);
    co_return false;
  }
  c.idle = c.talking = true;
  co_await hold_conversation(c.stream, parser.get(),
                             std::move(std::get<std::shared_ptr<WebSocketHandler>>(opened)),
                             workers, {options.silence_time, options.talk_write_time});
  co_return false;
}

net::awaitable<std::optional<Response>> Server::State::read_body(Connection& c, Parser& parser,
                                                                 const RequestHead& head,
                                                                 SpooledFile& spooled) {
  if (parser.is_done()) co_return std::nullopt;
  c.stream.expires_never();
  Admission admitted = co_await on_workers(workers, Admitting{&service, &head});
  if (auto* refusal = std::get_if<Response>(&admitted)) co_return std::move(*refusal);
  const Admitted& how = std::get<Admitted>(admitted);
  const std::uint64_t limit = how.limit_bytes;
  if (head.body_bytes > limit)
    co_return error_response(
        413, "too_large",
        fmt::format("the body has {} bytes, at most {} are allowed", head.body_bytes, limit));
  const bool to_file = how.to_file && options.scratch;
  if (to_file) {
    // A body that comes in pieces may be as long as the limit.
    auto share =
        options.scratch->reserve(how.client, head.body_bytes > 0 ? head.body_bytes : limit);
    if (!share) co_return error_response(503, "unavailable", share.error().what);
    spooled.share = std::move(*share);
  }
  parser.body_limit(limit);
  error_code failure;
  c.wait_for_peer();
  c.stream.expires_after(options.body_time);
  if (lower_case(parser.get()[beast::http::field::expect]) == "100-continue") {
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    co_await net::async_write(c.stream, net::buffer(kContinue), into(failure));
  }
  const SpoolLimits spool{options.scratch, limit,
                          options.body_time};  // no temporary: see on_workers
  if (!failure && to_file)
    failure = co_await spool_body(c.stream, c.buffer, parser, spool, workers, spooled);
  else if (!failure)
    co_await beast::http::async_read(c.stream, c.buffer, parser, into(failure));
  c.waited = false;
  if (spooled.broken)
    co_return error_response(503, "unavailable",
                             "the server has no disk space for this body now: try again later");
  if (!failure) co_return std::nullopt;
  auto refusal = answer_to(failure);
  if (!refusal)
    refusal = error_response(400, "bad_input", "the request ended before the end of its body");
  co_return refusal;
}

net::awaitable<bool> Server::State::write(Connection& c, const RequestHead& head,
                                          Response& response, bool keep_alive) {
  namespace bh = beast::http;
  add_security_headers(response);
  if (c.stream.is_tls() || options.behind_proxy) require_tls(response);
  const auto* slice = std::get_if<FileSlice>(&response.body);
  const auto* made = std::get_if<MadeBody>(&response.body);
  auto* text = std::get_if<std::string>(&response.body);
  bh::response<bh::string_body> message(bh::int_to_status(static_cast<unsigned>(response.status)),
                                        11);
  for (const auto& [name, value] : response.headers) message.insert(name, value);
  message.keep_alive(keep_alive);
  const bool bodiless = response.status == 204 || response.status == 304;
  const std::uint64_t size = slice ? slice->size : made ? made->size : text->size();
  if (!bodiless) message.content_length(size);
  const bool send_body = !bodiless && head.method != "HEAD";
  if (send_body && text) message.body() = std::move(*text);
  bh::response_serializer<bh::string_body> serializer(message);
  error_code failure;
  c.stream.expires_after(options.write_time);
  if (send_body && text)
    co_await bh::async_write(c.stream, serializer, into(failure));
  else
    co_await bh::async_write_header(c.stream, serializer, into(failure));
  if (failure) co_return false;
  if (send_body && slice) co_return co_await write_file(c, *slice);
  if (send_body && made) co_return co_await write_made(c, *made);
  co_return true;
}

net::awaitable<bool> Server::State::write_file(Connection& c, const FileSlice& slice) {
  const File file(slice.path);
  if (!file) co_return false;
  const File socket = File::again(c.stream.socket().native_handle());
  const bool plain = !c.stream.is_tls() && socket;
  std::string piece;
  for (std::uint64_t done = 0; done < slice.size;) {
    if (plain) {
      c.stream.expires_never();
      const auto sent = co_await on_workers(
          workers, SendingPiece{&file, &socket, slice.offset + done,
                                std::min<std::uint64_t>(kSent_bytes, slice.size - done)});
      if (!sent) co_return false;
      done += *sent;
      if (*sent > 0) continue;  // else it is full: the piece below waits for it
    }
    piece.resize(std::min<std::uint64_t>(kPiece_bytes, slice.size - done));
    c.stream.expires_never();
    const bool read =
        co_await on_workers(workers, ReadingPiece{&file, &piece, slice.offset + done});
    if (!read) co_return false;  // the length is already sent: closing is the only way to say so
    error_code failure;
    c.stream.expires_after(options.write_time);
    co_await net::async_write(c.stream, net::buffer(piece), into(failure));
    if (failure) co_return false;
    done += piece.size();
  }
  co_return true;
}

net::awaitable<bool> Server::State::write_made(Connection& c, const MadeBody& body) {
  std::string piece;
  for (std::uint64_t done = 0; done < body.size; done += piece.size()) {
    c.stream.expires_never();
    const bool read = co_await on_workers(workers, MakingPiece{body.source.get(), &piece});
    // The length is already sent: closing is the only way to say so.
    if (!read || piece.empty() || piece.size() > body.size - done) co_return false;
    error_code failure;
    c.stream.expires_after(options.write_time);
    co_await net::async_write(c.stream, net::buffer(piece), into(failure));
    if (failure) co_return false;
  }
  co_return true;
}

net::awaitable<void> Server::State::refuse(Connection& c, const RequestHead& head,
                                           Response& refusal) {
  co_await write(c, head, refusal, false);
  co_await linger(c);
}

/// Reads what the other side still sends, so that it sees the answer instead of a reset.
net::awaitable<void> Server::State::linger(Connection& c) {
  error_code failure;
  c.stream.socket().shutdown(tcp::socket::shutdown_send, failure);
  c.stream.expires_after(kLingering_time);
  std::string waste(64 * 1024, '\0');
  for (std::size_t read = 0; !failure && read < kLingering_bytes;)
    read += co_await c.stream.async_read_some(net::buffer(waste), into(failure));
}

void Server::State::drain() {
  if (draining) return;
  draining = true;
  error_code ignored;
  acceptor.close(ignored);
  for (Connection& connection : connections)
    if (connection.idle) connection.stream.socket().close(ignored);
  if (connections.empty()) return io.stop();
  drained.expires_after(options.drain_time);
  drained.async_wait([this](error_code failure) {
    if (!failure) io.stop();
  });
}

core::Result<Server> Server::open(const ServerOptions& options, Service service) {
  auto state = std::make_unique<State>(options, std::move(service));
  if (options.tls) {
    auto context = tls_context(options.tls->first, options.tls->second);
    if (!context) return context.error();
    state->tls.emplace(std::move(*context));
  }
  error_code failure;
  const auto address = net::ip::make_address(options.address, failure);
  if (failure)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: not an address to listen on", options.address)};
  const tcp::endpoint endpoint(address, options.port);
  auto& acceptor = state->acceptor;
  acceptor.open(endpoint.protocol(), failure);
  if (!failure) acceptor.set_option(tcp::acceptor::reuse_address(true), failure);
  if (!failure) acceptor.bind(endpoint, failure);
  if (!failure) acceptor.listen(tcp::socket::max_listen_connections, failure);
  if (failure)
    return core::Error{core::Errc::unavailable,
                       fmt::format("cannot listen on {}:{}: {}", options.address, options.port,
                                   failure.message())};
  return Server(std::move(state));
}

Server::Server(std::unique_ptr<State> state) : state_(std::move(state)) {}
Server::Server(Server&&) noexcept = default;
Server::~Server() = default;

std::uint16_t Server::port() const { return state_->acceptor.local_endpoint().port(); }

void Server::run() {
  net::co_spawn(state_->io, state_->accept_all(), net::detached);
  state_->io.run();
  state_->workers.join();
  for (Queue* queue : {&state_->hashing, &state_->remote, &state_->computing}) {
    queue->threads.stop();  // who waits in it has no connection any more
    queue->threads.join();
  }
}

void Server::stop() {
  net::post(state_->io, [state = state_.get()] { state->drain(); });
}

}  // namespace http
}  // namespace tractus
