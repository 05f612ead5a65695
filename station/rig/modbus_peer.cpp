#include "station/rig/modbus_peer.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <list>
#include <span>
#include <thread>
#include <vector>

#include "station/rig/request.hpp"

namespace tractus {
namespace rig {
namespace {

using core::Errc;
using core::Error;

constexpr int kMostClients = 8;
constexpr int kIdle_us = 200'000;  ///< how long a thread waits before it looks whether to stop
constexpr int kByte_us = 50'000;   ///< within a request

struct FreeContext {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using Context = std::unique_ptr<modbus_t, FreeContext>;

struct FreeMapping {
  void operator()(modbus_mapping_t* mapping) const { modbus_mapping_free(mapping); }
};
using Mapping = std::unique_ptr<modbus_mapping_t, FreeMapping>;

/// Registers that libmodbus replies from; a copy per connection, so that a client which does not
/// read holds up nobody else.
Mapping mapping_of(int unit) {
  Mapping mapping(modbus_mapping_new(0, 0, Electronics::count(unit), 0));
  core::require(mapping != nullptr, "memory for 48 registers");
  return mapping;
}

/// Requests as they arrive on a TCP connection, one system call each: libmodbus takes six.
class Incoming {
 public:
  enum class Got { request, nothing, gone, garbage };

  /// Waits for the next request, at most the socket's own time-out; `adu` stays valid until the
  /// next call.
  Got take(int socket, std::span<const std::uint8_t>& adu) {
    std::memmove(bytes_.data(), bytes_.data() + taken_, held_ - taken_);
    held_ -= taken_;
    taken_ = 0;
    while (true) {
      if (held_ >= kHeader && !is_header()) return Got::garbage;
      if (held_ >= kHeader && held_ >= size()) break;
      const ssize_t came = ::recv(socket, bytes_.data() + held_, bytes_.size() - held_, 0);
      if (came > 0) {
        held_ += std::size_t(came);
        continue;
      }
      if (held_ > 0) return Got::garbage;  // and no more of it
      const bool idle = came < 0 && (errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR);
      return idle ? Got::nothing : Got::gone;
    }
    taken_ = size();
    adu = {bytes_.data(), taken_};
    return Got::request;
  }

 private:
  static constexpr std::size_t kHeader = 6;  // up to and with the length
  std::size_t size() const { return kHeader + std::size_t(bytes_[4] << 8 | bytes_[5]); }
  /// Protocol number 0, and a length that the standard allows [Modbus TCP, 3.1.3].
  bool is_header() const {
    return bytes_[2] == 0 && bytes_[3] == 0 && size() > kHeader + 1 && size() <= bytes_.size();
  }
  std::array<std::uint8_t, MODBUS_TCP_MAX_ADU_LENGTH> bytes_{};
  std::size_t held_ = 0, taken_ = 0;
};

/// One connection: takes requests apart, has them carried out, replies.
class Exchange {
 public:
  Exchange(Electronics& electronics, Traffic& traffic, modbus_t* context, bool tcp)
      : electronics_(electronics), traffic_(traffic), context_(context), tcp_(tcp) {}

  /// False: this was not Modbus, or the other side is gone.
  bool answer(std::span<const std::uint8_t> adu) {
    const int header = modbus_get_header_length(context_);
    const int tail = tcp_ ? 0 : 2;  // the checksum, which libmodbus has judged
    if (int(adu.size()) <= header + tail) return false;
    const int unit = adu[std::size_t(header - 1)];
    const auto pdu = adu.subspan(std::size_t(header), adu.size() - std::size_t(header + tail));
    if (!tcp_ && unit == MODBUS_BROADCAST_ADDRESS) return true;  // heard, never obeyed
    if (Electronics::count(unit) == 0) return refuse(adu, MODBUS_EXCEPTION_GATEWAY_TARGET);
    if (!is_offered(pdu[0])) return refuse(adu, MODBUS_EXCEPTION_ILLEGAL_FUNCTION);
    const auto request = parse_request(pdu);
    if (!request) return refuse(adu, MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
    if (request->read_start + request->read_count > Electronics::count(unit) ||
        (!request->values.empty() &&
         !electronics_.write(unit, request->write_start, request->values)))
      return refuse(adu, MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
    return reply(adu, unit);
  }

 private:
  bool refuse(std::span<const std::uint8_t> adu, unsigned exception) {
    traffic_.refused += 1;
    return modbus_reply_exception(context_, adu.data(), exception) >= 0;
  }

  bool reply(std::span<const std::uint8_t> adu, int unit) {
    modbus_mapping_t* mapping = (unit == devices::rig::kUnit ? rig_ : world_).get();
    electronics_.read(unit, {mapping->tab_registers, std::size_t(mapping->nb_registers)});
    traffic_.answered += 1;
    return modbus_reply(context_, adu.data(), int(adu.size()), mapping) >= 0;
  }

  Electronics& electronics_;
  Traffic& traffic_;
  modbus_t* context_;
  bool tcp_;
  Mapping rig_ = mapping_of(devices::rig::kUnit), world_ = mapping_of(devices::rig::kWorldUnit);
};

void serve_client(std::stop_token stop, int socket, Electronics& electronics, Traffic& traffic) {
  Context context(modbus_new_tcp("127.0.0.1", 1));  // an address is asked for and not used
  core::require(context != nullptr, "memory for a connection");
  modbus_set_socket(context.get(), socket);
  const timeval idle{0, kIdle_us};
  ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &idle, sizeof idle);
  Exchange exchange(electronics, traffic, context.get(), true);
  Incoming incoming;
  std::span<const std::uint8_t> adu;
  while (!stop.stop_requested()) {
    const Incoming::Got got = incoming.take(socket, adu);
    if (got == Incoming::Got::nothing) continue;
    if (got == Incoming::Got::gone) break;
    if (got == Incoming::Got::request && exchange.answer(adu)) continue;
    traffic.garbage += 1;
    break;
  }
}

/// A listening socket and a thread per client.
class TcpPeer final : public ModbusPeer {
 public:
  TcpPeer(Electronics& electronics, Traffic& traffic, int listener, int port)
      : electronics_(electronics), traffic_(traffic), listener_(listener), port_(port) {
    thread_ = std::jthread([this](std::stop_token stop) { accept_clients(std::move(stop)); });
  }
  ~TcpPeer() override {
    thread_ = {};  // asks it to stop and waits
    ::close(listener_);
  }
  int port() const override { return port_; }

 private:
  struct Client {
    std::atomic<bool> gone = false;
    std::jthread thread;
  };

  void accept_clients(std::stop_token stop) {
    std::list<Client> clients;
    while (!stop.stop_requested()) {
      pollfd waiting{listener_, POLLIN, 0};
      if (::poll(&waiting, 1, kIdle_us / 1000) <= 0) continue;
      const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
      if (socket < 0) continue;
      clients.remove_if([](const Client& client) { return client.gone.load(); });
      if (clients.size() >= kMostClients) {
        ::close(socket);
        continue;
      }
      const int on = 1;
      ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
      Client& client = clients.emplace_back();
      client.thread = std::jthread([this, socket, &client](std::stop_token end) {
        serve_client(std::move(end), socket, electronics_, traffic_);
        client.gone = true;
      });
    }
    for (Client& client : clients)
      client.thread.request_stop();  // all at once, then each is joined
  }

  Electronics& electronics_;
  Traffic& traffic_;
  int listener_, port_;
  std::jthread thread_;
};

/// A serial line, opened anew when it breaks.
class RtuPeer final : public ModbusPeer {
 public:
  RtuPeer(Electronics& electronics, Traffic& traffic, Context context)
      : electronics_(electronics), traffic_(traffic), context_(std::move(context)) {
    thread_ = std::jthread([this](std::stop_token stop) { serve(std::move(stop)); });
  }
  int port() const override { return 0; }

 private:
  void serve(std::stop_token stop) {
    Exchange exchange(electronics_, traffic_, context_.get(), false);
    std::uint8_t query[MODBUS_RTU_MAX_ADU_LENGTH];
    while (!stop.stop_requested()) {
      pollfd waiting{modbus_get_socket(context_.get()), POLLIN, 0};
      const int ready = ::poll(&waiting, 1, kIdle_us / 1000);
      if (ready <= 0) continue;
      if (!(waiting.revents & POLLIN)) {  // hung up
        reopen();
        continue;
      }
      const int length = modbus_receive(context_.get(), query);
      if (length == 0) continue;  // for another unit
      if (length > 0 && exchange.answer({query, std::size_t(length)})) continue;
      traffic_.garbage += 1;
      modbus_flush(context_.get());
    }
  }

  void reopen() {
    modbus_close(context_.get());
    ::poll(nullptr, 0, kIdle_us / 1000);
    modbus_connect(context_.get());
  }

  Electronics& electronics_;
  Traffic& traffic_;
  Context context_;
  std::jthread thread_;
};

}  // namespace

core::Result<std::unique_ptr<ModbusPeer>> listen_tcp(Electronics& electronics, Traffic& traffic,
                                                     const std::string& address, int port) {
  const auto refused = [&](const char* why) {
    return Error{Errc::unavailable, fmt::format("Modbus TCP on {}:{}: {}", address, port, why)};
  };
  in_addr parsed{};
  if (::inet_pton(AF_INET, address.c_str(), &parsed) != 1)
    return refused("an IPv4 address is expected, as 127.0.0.1");
  const Context context(modbus_new_tcp(address.c_str(), port));
  if (!context) return refused(modbus_strerror(errno));
  const int listener = modbus_tcp_listen(context.get(), kMostClients);
  if (listener < 0) return refused(std::strerror(errno));
  sockaddr_in bound{};
  socklen_t size = sizeof bound;
  ::getsockname(listener, reinterpret_cast<sockaddr*>(&bound), &size);
  return std::unique_ptr<ModbusPeer>(
      std::make_unique<TcpPeer>(electronics, traffic, listener, ntohs(bound.sin_port)));
}

core::Result<std::unique_ptr<ModbusPeer>> open_rtu(Electronics& electronics, Traffic& traffic,
                                                   const std::string& device, int baud) {
  const auto refused = [&] {
    return Error{Errc::unavailable,
                 fmt::format("Modbus RTU on {}: {}", device, modbus_strerror(errno))};
  };
  Context context(modbus_new_rtu(device.c_str(), baud, 'E', 8, 1));
  if (!context) return refused();
  modbus_set_slave(context.get(), devices::rig::kUnit);
  modbus_set_byte_timeout(context.get(), 0, kByte_us);
  if (modbus_connect(context.get()) < 0) return refused();
  return std::unique_ptr<ModbusPeer>(
      std::make_unique<RtuPeer>(electronics, traffic, std::move(context)));
}

}  // namespace rig
}  // namespace tractus
