#include "station/sensors/netft.hpp"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <fmt/format.h>
#include <sys/socket.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace sensors {
namespace {
using core::Errc;
using core::Error;

constexpr std::size_t kMaxPage = 256 * 1024;
constexpr std::uint16_t kStart = 0x0002, kStop = 0x0000, kBias = 0x0042, kHeader = 0x1234;
constexpr int kMostPacketsPassed = 1000;  // datagrams without a record in one call
constexpr std::int32_t kAnew = 1000;      // a record this far back is no late one

/// What stands between <tag> and </tag>, blanks taken off.
std::optional<std::string_view> inside(std::string_view xml, const std::string& tag) {
  const auto from = xml.find("<" + tag + ">");
  if (from == std::string_view::npos) return std::nullopt;
  const auto start = from + tag.size() + 2, end = xml.find("</" + tag + ">", start);
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view out = xml.substr(start, end - start);
  while (!out.empty() && std::isspace(static_cast<unsigned char>(out.front())))
    out.remove_prefix(1);
  while (!out.empty() && std::isspace(static_cast<unsigned char>(out.back()))) out.remove_suffix(1);
  return out;
}

struct Unit {
  std::string_view name;
  double si;
};
constexpr std::array<Unit, 6> kForces{{{"N", 1.0},
                                       {"kN", 1000.0},
                                       {"lbf", 4.4482216152605},
                                       {"klbf", 4448.2216152605},
                                       {"kgf", 9.80665},
                                       {"gf", 0.00980665}}};
constexpr std::array<Unit, 6> kTorques{{{"Nm", 1.0},
                                        {"Nmm", 1e-3},
                                        {"kNm", 1000.0},
                                        {"lbf-in", 0.1129848290276167},
                                        {"lbf-ft", 1.3558179483314004},
                                        {"kgf-cm", 0.0980665}}};

template <std::size_t N>
std::optional<double> si_of(const std::array<Unit, N>& units, std::string_view name) {
  // "N-m", "N-mm" and "lb" are written too.
  std::string plain(name);
  if (plain == "N-m") plain = "Nm";
  if (plain == "N-mm") plain = "Nmm";
  if (plain == "lb") plain = "lbf";
  if (plain == "in-lb") plain = "lbf-in";
  if (plain == "ft-lb") plain = "lbf-ft";
  for (const Unit& unit : units)
    if (unit.name == plain) return unit.si;
  return std::nullopt;
}

core::Result<double> positive(std::string_view xml, const char* tag, const std::string& where) {
  const auto text = inside(xml, tag);
  if (!text) return Error{Errc::bad_input, fmt::format("{}: <{}> is missing", where, tag)};
  double value = 0.0;
  const auto [end, failed] = std::from_chars(text->data(), text->data() + text->size(), value);
  if (failed != std::errc() || !(value > 0.0) || !std::isfinite(value))
    return Error{Errc::bad_input, fmt::format("{}: <{}>: '{}': a number above 0 is expected", where,
                                              tag, core::one_line(*text, 64))};
  return value;
}

std::uint32_t word(std::span<const std::byte> bytes, std::size_t at) noexcept {
  std::uint32_t out = 0;
  for (std::size_t k = 0; k < 4; ++k) out = out << 8 | std::uint32_t(bytes[at + k]);
  return out;
}

std::size_t take(char* data, std::size_t one, std::size_t count, void* into) {
  auto& page = *static_cast<std::string*>(into);
  if (page.size() + one * count > kMaxPage) return 0;
  page.append(data, one * count);
  return one * count;
}
}  // namespace

core::Result<NetFtCalibration> parse_netft_xml(std::string_view xml, const std::string& where) {
  const auto per_force = TRY(positive(xml, "cfgcpf", where));
  const auto per_torque = TRY(positive(xml, "cfgcpt", where));
  if (inside(xml, "comrdte").value_or("Enabled") == "Disabled")
    return Error{Errc::bad_input,
                 fmt::format("{}: RDT is switched off; enable it on the sensor's page "
                             "Communications",
                             where)};
  const auto rate = TRY(positive(xml, "comrdtrate", where));
  const auto force = inside(xml, "scfgfu"), torque = inside(xml, "scfgtu");
  const auto force_si = si_of(kForces, force.value_or("")),
             torque_si = si_of(kTorques, torque.value_or(""));
  if (!force_si || !torque_si)
    return Error{Errc::bad_input, fmt::format("{}: units '{}' and '{}' are not known", where,
                                              core::one_line(force.value_or(""), 64),
                                              core::one_line(torque.value_or(""), 64))};
  // The active configuration's calibration is named here; `calsn` is the calibration page's word.
  const auto serial = inside(xml, "cfgcalsn");
  const auto product = inside(xml, "prodname").value_or("");
  const bool axia = product.find("Axia") != std::string_view::npos || inside(xml, "setrate");
  return NetFtCalibration{
      .counts_per_N = per_force / *force_si,
      .counts_per_Nm = per_torque / *torque_si,
      .rate_Hz = rate,
      .serial = core::one_line(serial ? *serial : inside(xml, "calsn").value_or(""), 64),
      .product = core::one_line(product, 64),
      .status = axia ? NetFtStatus::axia : NetFtStatus::box};
}

core::Result<NetFtCalibration> ask_calibration(const std::string& host, int http_port) {
  const std::string url = fmt::format("http://{}:{}/netftapi2.xml", host, http_port);
  static const bool ready = curl_global_init(CURL_GLOBAL_DEFAULT) == CURLE_OK;
  CURL* curl = ready ? curl_easy_init() : nullptr;
  if (!curl) return Error{Errc::unavailable, "libcurl does not start"};
  std::string page;
  curl_easy_setopt(curl, CURLOPT_URL, url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http");
  curl_easy_setopt(curl, CURLOPT_TIMEOUT, 5L);
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_FAILONERROR, 1L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &page);
  const CURLcode done = curl_easy_perform(curl);
  curl_easy_cleanup(curl);
  if (done != CURLE_OK)
    return Error{Errc::unavailable, fmt::format("{}: {}", url, curl_easy_strerror(done))};
  return parse_netft_xml(page, url);
}

std::optional<RdtRecord> parse_rdt(std::span<const std::byte> datagram) noexcept {
  if (datagram.size() != kRdtBytes) return std::nullopt;
  RdtRecord out{.sequence = word(datagram, 0),
                .ft_sequence = word(datagram, 4),
                .status = word(datagram, 8),
                .counts = {}};
  for (std::size_t k = 0; k < 6; ++k)
    out.counts[k] = static_cast<std::int32_t>(word(datagram, 12 + 4 * k));
  return out;
}

math::Wrench wrench_of(const RdtRecord& record, const NetFtCalibration& by) noexcept {
  const auto& c = record.counts;
  return {math::Vec3(c[0], c[1], c[2]) / by.counts_per_N,
          math::Vec3(c[3], c[4], c[5]) / by.counts_per_Nm};
}

core::Result<std::unique_ptr<NetFtStream>> NetFtStream::open(const std::string& host, int port,
                                                             bool bias) {
  auto socket = TRY(Socket::connect("force sensor", host, port, Transport::udp));
  std::unique_ptr<NetFtStream> out(new NetFtStream(std::move(socket)));
  if (bias) out->command(kBias);
  out->command(kStart);
  return out;
}

NetFtStream::~NetFtStream() { command(kStop); }

void NetFtStream::command(std::uint16_t what) const noexcept {
  // Header, command, and as many samples as there are until it is stopped: 0.
  const std::array<std::uint16_t, 4> request{htons(kHeader), htons(what), 0, 0};
  static_cast<void>(::send(socket_.fd(), request.data(), sizeof request, MSG_NOSIGNAL));
}

core::Result<std::optional<RdtRecord>> NetFtStream::next(int wait_ms) {
  for (int passed = 0; passed < kMostPacketsPassed && socket_.readable(wait_ms); ++passed) {
    std::array<std::byte, 256> datagram;
    const ssize_t size = ::recv(socket_.fd(), datagram.data(), datagram.size(), 0);
    if (size < 0 && (errno == EAGAIN || errno == EINTR)) continue;
    if (size < 0)
      return Error{Errc::unavailable,
                   fmt::format("the force sensor is gone: {}", std::strerror(errno))};
    const auto record = parse_rdt(std::span(datagram.data(), std::size_t(size)));
    if (!record) continue;
    const auto ahead = static_cast<std::int32_t>(record->sequence - last_);
    if (started_ && ahead < -kAnew)
      return Error{Errc::unavailable, "the force sensor began to count anew: was it switched off?"};
    if (started_ && ahead <= 0) {
      ++late_;
      continue;
    }
    if (started_) {
      lost_ += std::uint64_t(ahead - 1);
      index_ += std::uint64_t(ahead);
    }
    started_ = true;
    last_ = record->sequence;
    return std::optional(*record);
  }
  if (!started_) command(kStart);  // it may have been lost on the way, as all of UDP
  return std::optional<RdtRecord>();
}

}  // namespace sensors
}  // namespace tractus
