#include "server/http/websocket.hpp"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket.hpp>
#include <map>
#include <mutex>
#include <vector>

#include "server/http/coroutine.hpp"

namespace tractus {
namespace http {

std::string_view text_of(CloseReason parting) {
  switch (parting) {
    case CloseReason::disconnected:
      return "the other side closed the connection";
    case CloseReason::timed_out:
      return "nothing was received in time";
    case CloseReason::too_large:
      return "a message exceeded the size limit";
    case CloseReason::flood:
      return "too many messages per second";
    case CloseReason::invalid_message:
      return "a message was invalid";
    case CloseReason::no_longer_allowed:
      return "the credentials are no longer valid";
    case CloseReason::too_slow:
      return "the receiver did not read the messages in time";
    case CloseReason::closed_by_server:
      return "dismissed";
  }
  return "";
}

namespace {
namespace net = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;
using Clock = std::chrono::steady_clock;
using Text = std::shared_ptr<const std::string>;

/// The connection's stream, lent to Beast, which wants one of its own.
struct Lent {
  using executor_type = Stream::executor_type;
  Stream* stream;

  executor_type get_executor() noexcept { return stream->get_executor(); }
  template <class Buffers, class Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return stream->async_read_some(buffers, std::forward<Token>(token));
  }
  template <class Buffers, class Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return stream->async_write_some(buffers, std::forward<Token>(token));
  }
};
void hang_up(Stream& stream) {
  error_code ignored;
  stream.socket().shutdown(net::ip::tcp::socket::shutdown_both, ignored);
  stream.socket().close(ignored);
}
void beast_close_socket(Lent& lent) { hang_up(*lent.stream); }
/// The connection's owner says goodbye by TLS; nothing is left to do here.
template <class Handler>
void async_teardown(beast::role_type, Lent& lent, Handler&& handler) {
  net::post(lent.get_executor(),
            beast::bind_front_handler(std::forward<Handler>(handler), error_code()));
}

using Socket = websocket::stream<Lent, false>;

/// So many a second, and as many in one go.
class Allowance {
 public:
  explicit Allowance(double per_s) : per_s_(per_s), left_(2.0 * per_s) {}
  bool take() {
    const auto now = Clock::now();
    left_ += std::chrono::duration<double>(now - last_).count() * per_s_;
    left_ = std::min(left_, 2.0 * per_s_) - 1.0;
    last_ = now;
    return left_ >= 0.0;
  }

 private:
  double per_s_, left_;
  Clock::time_point last_ = Clock::now();
};

/// What is to be said, and the coroutine that says it. But for `say` and `end`, touched by the
/// input/output thread alone.
class Talk final : public WebSocketSender, public std::enable_shared_from_this<Talk> {
 public:
  explicit Talk(const Socket::executor_type& executor)
      : executor_(executor), pulse_(executor), deadline_(executor), gone_(executor) {}

  void send(const std::string& key, Text text) override {
    {
      const std::lock_guard held(mutex_);
      if (over_) return;
      if (waiting_.size() >= kMostWaiting && !waiting_.contains(key)) overrun_ = true;
      if (!overrun_) waiting_.insert_or_assign(key, std::move(text));
    }
    wake();
  }
  void end() override {
    {
      const std::lock_guard held(mutex_);
      ending_ = true;
    }
    wake();
  }
  /// Nothing is taken any more; the writing coroutine ends.
  void be_over() {
    {
      const std::lock_guard held(mutex_);
      over_ = true;
      waiting_.clear();
    }
    stir();
  }

  net::awaitable<void> write_all(Socket& socket, Stream& stream, WebSocketHandler& with,
                                 net::thread_pool& workers, WebSocketTimes times);
  void written_all() {
    writing_ = false;
    gone_.cancel();
  }
  net::awaitable<void> until_written() {
    error_code ignored;
    while (writing_) {
      gone_.expires_at(Clock::time_point::max());
      co_await gone_.async_wait(into(ignored));
    }
  }
  void part(CloseReason why) {
    if (!parting_) parting_ = why;
  }
  std::optional<CloseReason> parting() const { return parting_; }

 private:
  void wake() {
    {
      const std::lock_guard held(mutex_);
      if (woken_) return;
      woken_ = true;
    }
    net::post(executor_, [self = shared_from_this()] { self->stir(); });
  }
  void stir() {
    {
      const std::lock_guard held(mutex_);
      woken_ = false;
    }
    if (sleeping_) pulse_.cancel();
  }
  net::awaitable<void> sleep_until(Clock::time_point when) {
    error_code ignored;
    pulse_.expires_at(when);
    co_await pulse_.async_wait(into(ignored));
  }
  std::vector<Text> taken(bool& over, bool& ending);
  net::awaitable<bool> write(Socket& socket, Stream& stream, Text text,
                             std::chrono::milliseconds patience);

  Socket::executor_type executor_;
  net::steady_timer pulse_, deadline_, gone_;
  bool sleeping_ = false, writing_ = true;
  std::optional<CloseReason> parting_;

  std::mutex mutex_;  ///< guards what follows
  std::map<std::string, Text> waiting_;
  bool over_ = false, ending_ = false, overrun_ = false, woken_ = false;
};

std::vector<Text> Talk::taken(bool& over, bool& ending) {
  const std::lock_guard held(mutex_);
  if (overrun_) part(CloseReason::too_slow), over_ = true;
  std::vector<Text> out;
  for (auto& [_, text] : waiting_) out.push_back(std::move(text));
  waiting_.clear();
  over = over_;
  ending = ending_;
  return out;
}

net::awaitable<bool> Talk::write(Socket& socket, Stream& stream, Text text,
                                 std::chrono::milliseconds patience) {
  deadline_.expires_after(patience);
  deadline_.async_wait([self = shared_from_this(), &stream](error_code stopped) {
    if (stopped) return;
    self->part(CloseReason::too_slow);
    hang_up(stream);
  });
  error_code failure;
  co_await socket.async_write(net::buffer(*text), into(failure));
  deadline_.cancel();
  co_return !failure;
}

struct MayStay {
  WebSocketHandler* with;
  bool operator()() const try {
    return with->still_allowed();
  } catch (const std::exception&) {  // out of memory: asked again later
    return true;
  }
};

net::awaitable<void> Talk::write_all(Socket& socket, Stream& stream, WebSocketHandler& with,
                                     net::thread_pool& workers, WebSocketTimes times) {
  const auto pause = with.limits().pause;
  auto recheck = Clock::now() + WebSocketHandler::kRecheck;
  for (bool over = false, ending = false; !over;) {
    std::vector<Text> texts = taken(over, ending);
    for (std::size_t i = 0; i < texts.size() && !over; ++i)
      over = !co_await write(socket, stream, std::move(texts[i]), times.write);
    if (over) break;
    if (ending) {
      part(CloseReason::closed_by_server);
      break;
    }
    if (Clock::now() >= recheck) {
      recheck = Clock::now() + WebSocketHandler::kRecheck;
      if (!co_await on_workers(workers, MayStay{&with})) {
        part(CloseReason::no_longer_allowed);
        break;
      }
    }
    if (!texts.empty()) co_await sleep_until(Clock::now() + pause);
    bool more = false;
    {
      const std::lock_guard held(mutex_);
      more = !waiting_.empty() || over_ || ending_;
    }
    if (more) continue;
    sleeping_ = true;
    co_await sleep_until(recheck);
    sleeping_ = false;
  }
  if (parting_ && socket.is_open()) {
    deadline_.expires_after(std::chrono::seconds(1));
    deadline_.async_wait([self = shared_from_this(), &stream](error_code stopped) {
      if (!stopped) hang_up(stream);
    });
    error_code ignored;
    const auto code = *parting_ == CloseReason::closed_by_server
                          ? websocket::close_code::going_away
                          : websocket::close_code::policy_error;
    co_await socket.async_close({code, std::string(text_of(*parting_))}, into(ignored));
    deadline_.cancel();
  }
  hang_up(stream);
}

CloseReason parting_of(error_code failure) {
  if (failure == websocket::error::message_too_big || failure == websocket::error::buffer_overflow)
    return CloseReason::too_large;
  if (failure == beast::error::timeout) return CloseReason::timed_out;
  if (failure == websocket::condition::protocol_violation) return CloseReason::invalid_message;
  return CloseReason::disconnected;
}

/// Words in, until there are none.
net::awaitable<CloseReason> hear_all(Socket& socket, WebSocketHandler& with) {
  const WebSocketLimits limits = with.limits();
  Allowance allowance(limits.messages_per_s);
  bool flooded = false;
  socket.control_callback(
      [&](websocket::frame_type, beast::string_view) { flooded = flooded || !allowance.take(); });
  beast::flat_buffer buffer;
  while (true) {
    error_code failure;
    buffer.clear();
    do {  // by pieces, each counted: a message of a thousand fragments is a thousand messages
      co_await socket.async_read_some(buffer, 0, into(failure));
      flooded = flooded || !allowance.take();
    } while (!failure && !flooded && !socket.is_message_done());
    if (failure) co_return parting_of(failure);
    if (flooded) co_return CloseReason::flood;
    const auto bytes = buffer.cdata();
    if (!socket.got_text() ||
        !with.on_message({static_cast<const char*>(bytes.data()), bytes.size()}))
      co_return CloseReason::invalid_message;
  }
}

void configure(Socket& socket, const WebSocketHandler& with, WebSocketTimes times) {
  websocket::stream_base::timeout patience;
  patience.handshake_timeout = times.write;
  patience.idle_timeout = times.silence;
  patience.keep_alive_pings = true;
  socket.set_option(patience);
  socket.read_message_max(with.limits().max_message_bytes);
  socket.text(true);
}

}  // namespace

net::awaitable<void> hold_conversation(
    Stream& stream, const beast::http::request<beast::http::string_body>& upgrade,
    std::shared_ptr<WebSocketHandler> with, net::thread_pool& workers, WebSocketTimes times) {
  Socket socket{Lent{&stream}};
  configure(socket, *with, times);
  stream.expires_never();
  error_code failure;
  co_await socket.async_accept(upgrade, into(failure));
  if (failure) co_return;
  const auto talk = std::make_shared<Talk>(stream.get_executor());
  with->begin(talk);
  net::co_spawn(stream.get_executor(), talk->write_all(socket, stream, *with, workers, times),
                [talk](const std::exception_ptr&) { talk->written_all(); });
  const CloseReason heard = co_await hear_all(socket, *with);
  talk->part(heard);
  talk->be_over();
  co_await talk->until_written();
  with->ended(talk->parting().value_or(heard));
}

}  // namespace http
}  // namespace tractus
