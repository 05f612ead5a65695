#include "station/devices/modbus_rig.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <modbus/modbus.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <optional>

#include "station/devices/rig_image.hpp"

namespace tractus {
namespace devices {
namespace {

using core::Errc;
using core::Error;

constexpr std::uint32_t kConnect_s = 1;
constexpr std::uint32_t kSerialAnswer_us = 20'000;  // 60 bytes at 115200 baud take 6 ms
constexpr std::uint8_t kWriteAndRead = 23;
constexpr std::size_t kHeader = 7;  // MBAP
constexpr std::size_t kAnswer = kHeader + 2 + 2 * rig::kReadingCount;
constexpr std::size_t kRequest = 1 + 10 + 2 * rig::kCommandCount;  // unit, then FC 23's fields

struct FreeContext {
  void operator()(modbus_t* context) const {
    modbus_close(context);
    modbus_free(context);
  }
};
using Context = std::unique_ptr<modbus_t, FreeContext>;

class ModbusRig : public RigDevice {
 public:
  ModbusRig(std::string address, Context context)
      : address_(std::move(address)), context_(std::move(context)) {}
  ~ModbusRig() override { close_line(); }

  core::Result<RigIdentity> open() override {
    modbus_set_slave(context_.get(), rig::kUnit);
    modbus_set_response_timeout(context_.get(), kConnect_s, 0);
    if (modbus_connect(context_.get()) < 0) return refused(modbus_strerror(errno));
    open_ = true;
    std::array<std::uint16_t, rig::kIdentityCount> found{};
    if (modbus_read_registers(context_.get(), rig::kIdentityStart, rig::kIdentityCount,
                              found.data()) != rig::kIdentityCount)
      return refused(fmt::format("does not answer as a rig: {}", modbus_strerror(errno)));
    const auto at = [&](int address) { return found.data() + (address - rig::kIdentityStart); };
    if (*at(rig::kVersion) != rig::kMapVersion)
      return refused(fmt::format("register map version {}, {} is expected", *at(rig::kVersion),
                                 rig::kMapVersion));
    const RigIdentity identity = identity_of(found.data());
    prepare(identity.bus_clock ? kPatient_ms : kAnswer_ms);
    return identity;
  }

  void close() noexcept override { close_line(); }

 protected:
  /// Once connected: time-outs.
  virtual void prepare(int answer_ms) = 0;

  Error refused(const std::string& why) const {
    return {Errc::unavailable, fmt::format("rig at {}: {}", address_, why)};
  }

  void put(const RigCommand& command, std::uint16_t* at) noexcept {
    put_command(command, ++sequence_, at);
  }

  void close_line() noexcept {
    if (!open_) return;
    open_ = false;
    std::array<std::uint16_t, rig::kCommandCount> still{};
    modbus_write_registers(context_.get(), rig::kCommandStart, rig::kCommandCount, still.data());
    modbus_close(context_.get());
  }

  std::string address_;
  Context context_;
  std::uint16_t sequence_ = 0;
  bool open_ = false;
};

class TcpRig final : public ModbusRig {
 public:
  using ModbusRig::ModbusRig;

  Exchange exchange(const RigCommand& command, RigReading& reading) noexcept override {
    std::array<std::uint16_t, rig::kCommandCount> block{};
    put(command, block.data());
    std::array<std::uint8_t, kRequest> request{rig::kUnit,
                                               kWriteAndRead,
                                               0,
                                               rig::kReadingStart,
                                               0,
                                               rig::kReadingCount,
                                               0,
                                               rig::kCommandStart,
                                               0,
                                               rig::kCommandCount,
                                               2 * rig::kCommandCount};
    for (std::size_t k = 0; k < block.size(); ++k) {
      request[11 + 2 * k] = static_cast<std::uint8_t>(block[k] >> 8);
      request[12 + 2 * k] = static_cast<std::uint8_t>(block[k] & 0xffu);
    }
    if (modbus_send_raw_request(context_.get(), request.data(), int(request.size())) < 0)
      return Exchange::gone;
    return answer(reading);
  }

 private:
  void prepare(int answer_ms) override {
    const int socket = modbus_get_socket(context_.get());
    const timeval longest{answer_ms / 1000, answer_ms % 1000 * 1000};
    ::fcntl(socket, F_SETFL, ::fcntl(socket, F_GETFL) & ~O_NONBLOCK);  // libmodbus would select()
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &longest, sizeof longest);
    modbus_set_response_timeout(context_.get(), std::uint32_t(answer_ms / 1000),
                                std::uint32_t(answer_ms % 1000 * 1000));
  }

  /// One recv() where the answer comes whole, as it does. What is left of an answer that came too
  /// late is finished first.
  Exchange answer(RigReading& reading) noexcept {
    const int socket = modbus_get_socket(context_.get());
    for (;;) {
      while (held_ < kAnswer) {
        const ssize_t came = ::recv(socket, bytes_.data() + held_, bytes_.size() - held_, 0);
        if (came == 0) return Exchange::gone;
        if (came < 0 && errno == EINTR) continue;
        if (came < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return Exchange::silent;
        if (came < 0) return Exchange::gone;
        held_ += std::size_t(came);
        if (held_ >= kHeader + 2 && !is_ours()) return Exchange::garbage;
      }
      std::array<std::uint16_t, rig::kReadingCount> image{};
      for (std::size_t k = 0; k < image.size(); ++k)
        image[k] = static_cast<std::uint16_t>(bytes_[kHeader + 2 + 2 * k] << 8 |
                                              bytes_[kHeader + 3 + 2 * k]);
      held_ -= kAnswer;
      std::copy_n(bytes_.begin() + kAnswer, held_, bytes_.begin());
      if (image[rig::kSequenceEcho - rig::kReadingStart] == sequence_)
        return take_reading(image.data(), reading);
    }
  }

  /// Protocol 0, the length of a whole answer, our unit, FC 23, as many bytes as were asked for.
  bool is_ours() const noexcept {
    return bytes_[2] == 0 && bytes_[3] == 0 &&
           std::size_t(bytes_[4] << 8 | bytes_[5]) == kAnswer - (kHeader - 1) &&
           bytes_[6] == rig::kUnit && bytes_[7] == kWriteAndRead &&
           bytes_[8] == 2 * rig::kReadingCount;
  }

  std::array<std::uint8_t, 4 * kAnswer> bytes_{};
  std::size_t held_ = 0;
};

class SerialRig final : public ModbusRig {
 public:
  using ModbusRig::ModbusRig;

  Exchange exchange(const RigCommand& command, RigReading& reading) noexcept override {
    std::array<std::uint16_t, rig::kCommandCount> block{};
    put(command, block.data());
    std::array<std::uint16_t, rig::kReadingCount> image{};
    if (modbus_write_and_read_registers(context_.get(), rig::kCommandStart, rig::kCommandCount,
                                        block.data(), rig::kReadingStart, rig::kReadingCount,
                                        image.data()) == rig::kReadingCount)
      return image[rig::kSequenceEcho - rig::kReadingStart] == sequence_
                 ? take_reading(image.data(), reading)
                 : Exchange::garbage;
    if (errno == ETIMEDOUT) return Exchange::silent;
    return errno >= MODBUS_ENOBASE ? Exchange::garbage : Exchange::gone;
  }

 private:
  void prepare(int) override {
    modbus_set_response_timeout(context_.get(), 0, kSerialAnswer_us);
    modbus_set_byte_timeout(context_.get(), 0, kSerialAnswer_us);
  }
};

Error no_address(const std::string& address) {
  return {
      Errc::bad_input,
      fmt::format("--address {}: HOST:PORT or a serial line /dev/…[@BAUD] is expected", address)};
}

std::optional<int> number_of(std::string_view text, int low, int high) {
  int value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || value < low || value > high)
    return std::nullopt;
  return value;
}

}  // namespace

core::Result<std::unique_ptr<RigDevice>> modbus_rig(const std::string& address) {
  if (address.starts_with('/')) {
    const auto at = address.find('@');
    const auto baud = at == std::string::npos
                          ? std::optional(115200)
                          : number_of(std::string_view(address).substr(at + 1), 1200, 4'000'000);
    if (!baud) return no_address(address);
    Context context(modbus_new_rtu(address.substr(0, at).c_str(), *baud, 'E', 8, 1));
    if (!context) return no_address(address);
    return std::unique_ptr<RigDevice>(std::make_unique<SerialRig>(address, std::move(context)));
  }
  const auto colon = address.rfind(':');
  if (colon == std::string::npos || colon == 0) return no_address(address);
  const std::string host = address.substr(0, colon), port = address.substr(colon + 1);
  if (!number_of(port, 1, 65535)) return no_address(address);
  Context context(modbus_new_tcp_pi(host.c_str(), port.c_str()));
  if (!context) return no_address(address);
  return std::unique_ptr<RigDevice>(std::make_unique<TcpRig>(address, std::move(context)));
}

}  // namespace devices
}  // namespace tractus
