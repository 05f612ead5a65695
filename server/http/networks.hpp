/// IP addresses and networks, for example "10.0.0.0/8", of the proxies that a server trusts.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::http {

/// An IP address as 16 bytes; IPv4 as ::ffff:a.b.c.d. A zone ("%eth0") is ignored. Nothing if the
/// text is not an IP address.
std::optional<std::array<std::uint8_t, 16>> ip_address(const std::string& text);

class Networks {
 public:
  /// @param texts  addresses, or networks as ADDRESS/BITS. Errors: bad_input.
  static core::Result<Networks> parse(const std::vector<std::string>& texts);
  /// 127.0.0.0/8 and ::1.
  static Networks loopback();
  bool contain(const std::string& address) const;

 private:
  struct Network {
    std::array<std::uint8_t, 16> address;
    unsigned bits;  ///< of 128
  };
  static std::optional<Network> network(const std::string& text);
  std::vector<Network> networks_;
};

}  // namespace tractus::http
