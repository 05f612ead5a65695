/// Requests of the server to another server: an OpenID Connect provider, a learning platform, a webhook, a PACS.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "server/http/networks.hpp"

namespace tractus::api {

struct Fetched {
  int status = 0;
  std::string content_type = {};  ///< as the other server states it
  std::string body = {};
};

struct Fetch {
  std::string url;  ///< https; http is allowed only to loopback addresses
  std::optional<std::map<std::string, std::string>> form = {};  ///< fields of a POST
  std::optional<std::string> body = {};   ///< of a POST without `form`; neither: GET
  std::vector<std::string> headers = {};  ///< "Name: value"
  std::string user = {}, password = {};  ///< credentials for HTTP basic authentication; empty: none
  std::filesystem::path authority = {};  ///< trusted PEM file; empty: the system's
  std::chrono::milliseconds patience{5000};  ///< time limit from the start to the last byte
  /// If given: only public addresses and these are connected to, without a proxy. The address is
  /// checked when it is connected to, so that a name cannot lead elsewhere later.
  std::optional<http::Networks> networks = {};
  std::string who = "the provider";  ///< the other server, for messages
  /// If given: gets the body of an answer of status 200 piece by piece, without the limit of 1 MiB;
  /// Fetched::body stays empty. Its error ends the transfer and is that of `fetch`.
  std::function<core::Result<void>(const Fetched& head, std::string_view piece)> take = {};
  std::function<bool()> may_go_on = {};  ///< if given: asked every second at least; false ends it
  std::chrono::seconds silence{0};  ///< if given: less than 1 KiB/s over this time is no answer
};

/// Reads at most 1 MiB within `patience`, without redirects. Errors: bad_input (the address is not
/// allowed), unavailable (no answer), too_large, cancelled (`may_go_on`), those of `take`.
core::Result<Fetched> fetch(const Fetch& what);

/// A password, token or other secret: what a file holds, without white space at its end. Errors:
/// those of reading; bad_input if it is empty.
core::Result<std::string> secret_in(const std::filesystem::path& path);

/// Whether the address is https, or http to a loopback address.
bool is_safe_address(const std::string& url);

/// Whether `fetch` with these networks may be asked for the address: is_safe_address without spaces
/// and control characters, of at most 2000 bytes; http only to a loopback address of `networks`.
bool is_callable(const std::string& url, const http::Networks& networks);

/// "a b" is "a%20b".
std::string percent_encoded(const std::string& text);

/// The address with these fields added to its query.
std::string with_query(std::string url,
                       const std::vector<std::pair<std::string, std::string>>& fields);

}  // namespace tractus::api
