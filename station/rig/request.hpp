/// A Modbus request as bytes, judged before anything is done with it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace tractus::rig {

/// Reads registers, writes them, or first writes and then reads (FC 3, 6, 16, 23).
struct Request {
  int read_start = 0, read_count = 0;  ///< count 0: nothing is read
  int write_start = 0;
  std::vector<std::uint16_t> values;  ///< empty: nothing is written
};

/// @param pdu  function code and what follows it, without checksum.
/// @returns nothing where its parts contradict one another or the standard's limits (125 registers
/// read, 123 written, 121 with FC 23); the code of a function that is not offered is not judged
/// here.
std::optional<Request> parse_request(std::span<const std::uint8_t> pdu);

/// Is it a function that the rig offers?
bool is_offered(std::uint8_t function) noexcept;

}  // namespace tractus::rig
