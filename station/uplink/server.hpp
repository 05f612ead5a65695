/// The server as the uplink sees it: one request, one answer. Behind it libcurl (http_server.hpp)
/// or a test's double.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/bytes.hpp"
#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::uplink {

struct Request {
  std::string method;  ///< "GET", "PUT", "PATCH", "POST"
  std::string path;    ///< "/api/v1/…", with its query
  std::vector<std::pair<std::string, std::string>> headers = {};
  core::ByteView body = {};
  std::uint64_t max_answer_bytes = 1u << 20;
};

struct HttpResponse {
  int status = 0;
  core::Bytes body;
};

class Server {
 public:
  virtual ~Server() = default;
  /// Errors: unavailable (no connection, no answer in time), too_large (the answer), bad_input (no
  /// HTTP). An answer of any status is an answer.
  virtual core::Result<HttpResponse> send(const Request& request) = 0;
};

/// What an HTTP status that is no success means.
core::Errc error_code_of(int status);

/// The answer's body as JSON when the status is 2xx; else the server's own one line as an Error of
/// the status' kind (5xx and 429: unavailable).
core::Result<core::Json> json_of(const Request& request, const HttpResponse& answer);
/// The Error that a status outside 2xx means.
core::Error error_of(const Request& request, const HttpResponse& answer);

}  // namespace tractus::uplink
