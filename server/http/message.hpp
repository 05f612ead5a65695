/// Requests and responses as the rest of the server sees them: plain values, no sockets.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "core/result.hpp"

namespace tractus::http {

/// "%2F" and "+" undone. Errors: bad_input for an escape that is none, and for a zero byte.
core::Result<std::string> percent_decoded(std::string_view text);

/// What stands before the body.
struct RequestHead {
  std::string method;                          ///< "GET"
  std::string path;                            ///< still escaped, begins with '/'
  std::map<std::string, std::string> query;    ///< decoded
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string peer;                            ///< address of the other side, without port
  std::uint64_t body_bytes = 0;  ///< as announced; 0 when none is or it comes in pieces

  /// The header's value, or "".
  std::string_view header(std::string_view lower_case_name) const;
  /// The value of a cookie, or "".
  std::string_view cookie(std::string_view name) const;
};

/// Splits "/path?query" into `head`. Errors: bad_input.
core::Result<void> read_target(std::string_view target, RequestHead& head);

/// Whom a proxy names last in X-Forwarded-For: what stands before that anybody may have written.
/// Without the header, or when what it names is no address: the peer itself.
std::string forwarded_peer(const RequestHead& head);

struct Request : RequestHead {
  std::string body;
  /// Where a large body lies instead, for as long as the request is handled; empty: in `body`.
  std::filesystem::path body_file = {};
};

/// Part of a file, sent in pieces.
struct FileSlice {
  std::filesystem::path path;
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
  std::shared_ptr<const void> owner = {};  ///< kept until it is sent: as http::ScratchFile
};

struct Response {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::variant<std::string, FileSlice> body;

  Response& with(std::string name, std::string value) {
    headers.emplace_back(std::move(name), std::move(value));
    return *this;
  }
  /// The value of a header set with exactly this name, or "".
  std::string_view header(std::string_view name) const;
};

/// {"error": text, "code": code} as JSON.
Response error_response(int status, std::string_view code, std::string_view text);

/// Bytes [first, last] of a "Range: bytes=…" header for a file of `size` bytes. Nothing: no range
/// asked, or one of a form we need not honour (several ranges, another unit). Errors: out_of_range
/// when it lies wholly beyond the end (416).
core::Result<std::optional<std::pair<std::uint64_t, std::uint64_t>>> byte_range(
    std::string_view header, std::uint64_t size);

/// The file, or the part of it that the request's Range names: 200, 206 or 416. Errors: not_found,
/// io.
core::Result<Response> file_response(const std::filesystem::path& path, const RequestHead& request,
                                     std::string content_type);

}  // namespace tractus::http
