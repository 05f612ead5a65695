/// Requests of the server to another server, for example to an OpenID Connect provider.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "core/result.hpp"

namespace tractus::api {

struct Fetched {
  int status = 0;
  std::string body;
};

struct Fetch {
  std::string url;  ///< https; http is allowed only to loopback addresses
  std::optional<std::map<std::string, std::string>> form = {};  ///< fields of a POST; none: GET
  std::string user = {}, password = {};  ///< credentials for HTTP basic authentication; empty: none
  std::filesystem::path authority = {};  ///< trusted PEM file; empty: the system's
  std::chrono::milliseconds patience{5000};  ///< time limit from the start to the last byte
};

/// Reads at most 1 MiB within `patience`, without redirects. Errors: bad_input (the address is not
/// allowed), unavailable (no answer), too_large.
core::Result<Fetched> fetch(const Fetch& what);

/// Whether the address is https, or http to a loopback address.
bool is_safe_address(const std::string& url);

/// "a b" is "a%20b".
std::string percent_encoded(const std::string& text);

}  // namespace tractus::api
