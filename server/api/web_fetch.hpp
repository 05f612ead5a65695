/// The server as a client of another: of a provider of identities.
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
  std::string url;  ///< https; plain http to this machine's own addresses alone
  std::optional<std::map<std::string, std::string>> form = {};  ///< sent by POST
  std::string user = {}, password = {};                         ///< basic credentials; empty: none
  std::filesystem::path authority = {};      ///< PEM file to trust; empty: the system's
  std::chrono::milliseconds patience{5000};  ///< from the start to the last byte
};

/// At most 1 MiB within `patience`, no redirects. Errors: bad_input (not such an address),
/// unavailable (no answer), too_large.
core::Result<Fetched> fetch(const Fetch& what);

/// Is it https, or http to this machine's own addresses?
bool is_safe_address(const std::string& url);

/// "a b" is "a%20b".
std::string percent_encoded(const std::string& text);

}  // namespace tractus::api
