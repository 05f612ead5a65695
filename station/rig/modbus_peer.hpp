/// The electronics on Modbus: TCP for several clients, RTU on a serial line. The only file that
/// knows libmodbus is modbus_peer.cpp.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <string>

#include "core/result.hpp"
#include "station/rig/electronics.hpp"

namespace tractus::rig {

/// What came over the wire so far.
struct Traffic {
  std::atomic<std::uint64_t> answered = 0;  ///< requests that were carried out
  std::atomic<std::uint64_t> refused = 0;   ///< answered with an exception
  std::atomic<std::uint64_t> garbage = 0;   ///< not Modbus: TCP closes the connection, RTU drops it
};

/// Answers until it is destroyed. Borrows what it is made of; each connection has a thread.
class ModbusPeer {
 public:
  virtual ~ModbusPeer() = default;
  /// Of the TCP peer; 0 for RTU.
  virtual int port() const = 0;
};

/// Listens on an address of this machine; port 0 takes a free one. At most 8 clients at a time,
/// further ones are hung up on. Errors: unavailable, naming address and port.
core::Result<std::unique_ptr<ModbusPeer>> listen_tcp(Electronics& electronics, Traffic& traffic,
                                                     const std::string& address, int port);

/// Opens a serial line, 8 data bits, even parity, one stop bit: the standard's default. Only the
/// unit of the electronics answers there. Errors: unavailable, naming the device.
core::Result<std::unique_ptr<ModbusPeer>> open_rtu(Electronics& electronics, Traffic& traffic,
                                                   const std::string& device, int baud);

}  // namespace tractus::rig
