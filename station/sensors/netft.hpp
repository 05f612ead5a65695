/// ATI Net F/T: a force/torque sensor on the network. Protocol and page as in the vendor's
/// "Network F/T" manual (9620-05-Net FT, sections 9 and 10) and "Ethernet Axia" (9610-05, 4.8, 11).
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "math/geometry.hpp"
#include "station/sensors/socket.hpp"

namespace tractus::sensors {

/// What the bits of a status mean: a Net F/T box and an Ethernet Axia have a table each.
enum class NetFtStatus { box, axia };

/// What the sensor says of itself at http://HOST/netftapi2.xml.
struct NetFtCalibration {
  double counts_per_N = 0.0, counts_per_Nm = 0.0;
  double rate_Hz = 0.0;  ///< of its RDT stream as configured there; it may round it up
  std::string serial;    ///< of the calibration; empty if the page does not say
  std::string product;   ///< "Net F/T", "Ethernet Axia", …; empty if the page does not say
  NetFtStatus status = NetFtStatus::box;  ///< axia: its product says so, or its `setrate`
};

/// Reads the page; counts are per the unit that it names (N, lbf, …), brought to SI here. Errors:
/// bad_input naming the tag that is missing or odd, or that RDT is switched off.
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

/// Does the status say that the sample is no good: its bit 31, "any error"? A threshold of the
/// user's that was passed is none; a box raises bit 31 for it too (0x80010000).
bool is_faulty(std::uint32_t status) noexcept;
/// Was it beyond what the sensor can measure? An Axia's bits 27 (a gage) and 30 (a force or
/// torque), a box's bit 17.
bool is_saturated(std::uint32_t status, NetFtStatus of) noexcept;
/// "0xc0000000 (force or torque out of range)": the bits that have a name. An Axia's are those of
/// its manual (9610-05, table 4.7); a box's as public drivers for it name them, which follow its
/// manual's "System Status Code": never seen from a real one.
std::string status_words(std::uint32_t status, NetFtStatus of);

/// A stream, started when it is opened and stopped when this goes. One thread.
class NetFtStream {
 public:
  static constexpr int kPort = 49152;
  /// `bias`: the sensor takes what it feels now as its zero (RDT's 0x0042), until it is switched
  /// off. Errors: unavailable naming the host.
  static core::Result<std::unique_ptr<NetFtStream>> open(const std::string& host, int port = kPort,
                                                         bool bias = false);
  ~NetFtStream();
  NetFtStream(const NetFtStream&) = delete;
  NetFtStream& operator=(const NetFtStream&) = delete;

  /// The next record; nothing after `wait_ms` without one. Records that come late or twice are
  /// dropped. Until the first has come, each call without one asks anew. Errors: unavailable:
  /// nobody is there any more, or the sensor began to count anew.
  core::Result<std::optional<RdtRecord>> next(int wait_ms);
  /// Sequence numbers before the last record's for which none was given, late ones among them.
  std::uint64_t lost() const noexcept { return lost_; }
  std::uint64_t late() const noexcept { return late_; }
  /// Of the last record, from the first one's: what RDT's sequence counts, without its wrap.
  std::uint64_t index() const noexcept { return index_; }

 private:
  explicit NetFtStream(Socket socket) : socket_(std::move(socket)) {}
  void command(std::uint16_t what) const noexcept;
  Socket socket_;
  std::uint32_t last_ = 0;
  bool started_ = false;
  std::uint64_t index_ = 0, lost_ = 0, late_ = 0;
};

}  // namespace tractus::sensors
