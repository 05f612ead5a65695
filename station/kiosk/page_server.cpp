#include "station/kiosk/page_server.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <optional>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "server/http/static_files.hpp"

namespace tractus {
namespace kiosk {
namespace {
constexpr std::size_t kSecret_bytes = 32;
constexpr const char* kLivePath = "/kiosk/live";
constexpr auto kBetweenStates = std::chrono::milliseconds(50);

/// Whose messages count: the page that was opened last.
struct Seat {
  std::mutex mutex;
  std::shared_ptr<http::WebSocketSender> page;

  /// The one before is told to end.
  void take(const std::shared_ptr<http::WebSocketSender>& newest) {
    const std::lock_guard held(mutex);
    if (page) page->end();
    page = newest;
  }
  bool holds(const http::WebSocketSender* asked) {
    const std::lock_guard held(mutex);
    return page.get() == asked;
  }
};

/// One page's WebSocket: states go out, commands come in.
class PageSocket final : public http::WebSocketHandler {
 public:
  PageSocket(Desk& desk, std::shared_ptr<Seat> seat) : desk_(desk), seat_(std::move(seat)) {}

  http::WebSocketLimits limits() const override {
    return {.max_message_bytes = 1024, .messages_per_s = 20.0, .pause = kBetweenStates};
  }

  void begin(std::shared_ptr<http::WebSocketSender> sender) override {
    sender_ = sender;
    seat_->take(sender);
    desk_.listen([sender](const std::string& shown) {
      sender->send("state", std::make_shared<const std::string>(shown));
    });
  }

  bool on_message(std::string_view text) override {
    if (!seat_->holds(sender_.get())) return false;
    const auto json = core::parse_json(text, "command");
    if (!json) return false;
    auto command = Command::from_json(*json);
    if (!command) return false;
    // A command that came too late for its screen changes nothing; the page shows what holds.
    static_cast<void>(desk_.take(*command));
    return true;
  }

  bool still_allowed() override { return true; }

  void ended(http::CloseReason) override {
    if (seat_->holds(sender_.get())) desk_.listen({});
  }

 private:
  Desk& desk_;
  std::shared_ptr<Seat> seat_;
  std::shared_ptr<http::WebSocketSender> sender_;
};

http::Response refused(std::string_view why) {
  http::Response out = http::error_response(403, "forbidden", why);
  http::add_security_headers(out);
  return out;
}

bool same_secret(const std::string& given, const std::string& right) {
  return given.size() == right.size() &&
         sodium_memcmp(given.data(), right.data(), right.size()) == 0;
}

/// What every request is held against.
struct Gate {
  std::string secret;
  std::string authority;  ///< "127.0.0.1:PORT"; set before the first request is served

  /// Nothing, or why it is refused.
  std::optional<http::Response> refusal(const http::RequestHead& head) const {
    if (head.header("host") != authority) return refused("Host: another address is expected");
    const auto origin = head.header("origin");
    if (!origin.empty() && origin != "http://" + authority)
      return refused("Origin: only the kiosk's own page is served");
    return std::nullopt;
  }
  std::optional<http::Response> refusal_of_socket(const http::RequestHead& head) const {
    if (auto refusal_of_head = refusal(head)) return refusal_of_head;
    const auto key = head.query.find("key");
    if (head.path != kLivePath || key == head.query.end() || !same_secret(key->second, secret))
      return refused("the kiosk is opened by the address that the station gives at its start");
    if (head.header("origin").empty()) return refused("Origin: is needed");
    return std::nullopt;
  }
};

}  // namespace

struct PageServer::Parts {
  std::shared_ptr<Gate> gate;
  http::Server server;
  std::thread thread;
};

core::Result<std::unique_ptr<PageServer>> PageServer::open(Desk& desk,
                                                           const std::filesystem::path& web,
                                                           std::uint16_t port) {
  std::error_code failure;
  if (!std::filesystem::is_regular_file(web / "kiosk.html", failure))
    return core::Error{core::Errc::not_found,
                       fmt::format("--web {}: has no kiosk.html; name the folder of the built "
                                   "pages (npm --prefix web run build makes web/dist)",
                                   web.string())};
  auto gate = std::make_shared<Gate>();
  gate->secret = core::hex(core::random_bytes(kSecret_bytes));
  const auto files = std::make_shared<const http::StaticFiles>(web);
  const auto seat = std::make_shared<Seat>();
  http::Service service;
  service.admit =
      [gate](const http::RequestHead& head) -> std::variant<http::Admitted, http::Response> {
    if (auto refusal = gate->refusal(head)) return std::move(*refusal);
    return http::Admitted{};
  };
  service.handle = [gate, files](const http::Request& request) {
    if (auto refusal = gate->refusal(request)) return std::move(*refusal);
    http::Response out = files->answer(request);
    http::add_security_headers(out);
    return out;
  };
  service.converse = [gate, seat, &desk](const http::RequestHead& head)
      -> std::variant<http::Response, std::shared_ptr<http::WebSocketHandler>> {
    if (auto refusal = gate->refusal_of_socket(head)) return std::move(*refusal);
    return std::make_shared<PageSocket>(desk, seat);
  };
  constexpr http::LaneLimits kUnused{.threads = 1, .waiting_strangers = 1, .waiting = 1};
  const http::ServerOptions options{.address = "127.0.0.1",
                                    .port = port,
                                    .tls = std::nullopt,
                                    .workers = 2,
                                    .hashing = kUnused,
                                    .remote = kUnused,
                                    .computing = kUnused,
                                    .max_connections = 32,
                                    .drain_time = std::chrono::milliseconds(500)};
  auto server = TRY(http::Server::open(options, std::move(service)));
  gate->authority = fmt::format("127.0.0.1:{}", server.port());
  auto parts = std::make_unique<Parts>(std::move(gate), std::move(server), std::thread());
  http::Server& serving = parts->server;
  parts->thread = std::thread([&serving] { serving.run(); });
  return std::unique_ptr<PageServer>(new PageServer(std::move(parts)));
}

PageServer::PageServer(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

PageServer::~PageServer() {
  parts_->server.stop();
  parts_->thread.join();
}

std::uint16_t PageServer::port() const noexcept { return parts_->server.port(); }

std::string PageServer::address() const {
  return fmt::format("http://{}/kiosk.html#{}", parts_->gate->authority, parts_->gate->secret);
}

}  // namespace kiosk
}  // namespace tractus
