#include "server/http/networks.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/words.hpp"

namespace tractus {
namespace http {
namespace {

constexpr unsigned kBits = 128, kBitsBeforeIpv4 = 96;

bool is_ipv4(const std::string& text) { return text.find(':') == std::string::npos; }

bool has_same_start(const std::array<std::uint8_t, 16>& a, const std::array<std::uint8_t, 16>& b,
                    unsigned bits) {
  for (unsigned i = 0; i < bits; ++i)
    if (((a[i / 8] ^ b[i / 8]) >> (7 - i % 8) & 1) != 0) return false;
  return true;
}

}  // namespace

std::optional<std::array<std::uint8_t, 16>> ip_address(const std::string& text) {
  std::array<std::uint8_t, 16> out{};
  if (is_ipv4(text)) {
    out[10] = out[11] = 0xff;
    if (::inet_pton(AF_INET, text.c_str(), &out[12]) != 1) return std::nullopt;
    return out;
  }
  const std::string without_zone = text.substr(0, text.find('%'));
  if (::inet_pton(AF_INET6, without_zone.c_str(), out.data()) != 1) return std::nullopt;
  return out;
}

std::optional<Networks::Network> Networks::network(const std::string& text) {
  const auto slash = std::min(text.find('/'), text.size());
  const std::string address = text.substr(0, slash);
  const auto bytes = ip_address(address);
  if (!bytes) return std::nullopt;
  if (slash == text.size()) return Network{*bytes, kBits};
  unsigned bits = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, failure] = std::from_chars(text.data() + slash + 1, end, bits);
  const unsigned before = is_ipv4(address) ? kBitsBeforeIpv4 : 0;
  if (failure != std::errc() || stopped != end || bits > kBits - before) return std::nullopt;
  return Network{*bytes, before + bits};
}

core::Result<Networks> Networks::parse(const std::vector<std::string>& texts) {
  Networks out;
  for (const std::string& text : texts) {
    const auto one = network(text);
    if (!one)
      return core::Error{core::Errc::bad_input,
                         fmt::format("'{}': an address or ADDRESS/BITS is expected, as 10.1.0.0/16",
                                     core::one_line(text, 80))};
    out.networks_.push_back(*one);
  }
  return out;
}

Networks Networks::loopback() { return std::move(*parse({"127.0.0.0/8", "::1"})); }

bool Networks::contain(const std::string& address) const {
  const auto bytes = ip_address(address);
  return bytes && std::ranges::any_of(networks_, [&](const Network& network) {
           return has_same_start(network.address, *bytes, network.bits);
         });
}

}  // namespace http
}  // namespace tractus
