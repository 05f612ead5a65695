/// ATI Net F/T: a force/torque sensor on the network.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/clock.hpp"
#include "core/result.hpp"
#include "math/geometry.hpp"

namespace sensors {

/// What the sensor says of itself at http://HOST/netftapi2.xml.
struct NetFtCalibration {
  double counts_per_N = 0.0, counts_per_Nm = 0.0;
  double rate_Hz = 0.0;  ///< of its RDT stream, as configured there
  std::string serial;
};

/// Reads the page; counts are per the unit that it names (N, lbf, …), brought to SI here. Errors:
/// bad_input naming the tag that is missing or odd.
core::Result<NetFtCalibration> parse_netft_xml(std::string_view xml, const std::string& where);
/// Fetches and reads it, 5 s at most. Errors: unavailable, bad_input.
core::Result<NetFtCalibration> ask_calibration(const std::string& host, int http_port = 80);

/// One RDT record, in counts.
struct RdtRecord {
  std::uint32_t sequence = 0;     ///< of the stream: gaps are losses
  std::uint32_t ft_sequence = 0;  ///< of the sensor's own samples
  std::uint32_t status = 0;       ///< 0: all right
  std::array<std::int32_t, 6> counts{};
};
inline constexpr std::size_t kRdtBytes = 36;
/// Big-endian, as ATI documents it. Nothing when there are not 36 bytes.
std::optional<RdtRecord> parse_rdt(std::span<const std::byte> datagram) noexcept;
math::Wrench wrench_of(const RdtRecord& record, const NetFtCalibration& calibration) noexcept;

/// A stream, started when it is opened and stopped when this goes.
class NetFtStream {
 public:
  static constexpr int kPort = 49152;
  /// Errors: unavailable naming the host.
  static core::Result<std::unique_ptr<NetFtStream>> open(const std::string& host, int port = kPort);
  ~NetFtStream();
  NetFtStream(const NetFtStream&) = delete;
  NetFtStream& operator=(const NetFtStream&) = delete;

  /// The next record; nothing after `wait_ms` without one. Records that come late or twice are
  /// dropped; those that never came are counted.
  std::optional<RdtRecord> next(int wait_ms);
  std::uint64_t lost() const noexcept { return lost_; }

 private:
  explicit NetFtStream(int fd) : fd_(fd) {}
  void command(std::uint16_t what) const noexcept;
  int fd_;
  std::uint32_t last_ = 0;
  bool started_ = false;
  std::uint64_t lost_ = 0;
};

}  // namespace sensors
