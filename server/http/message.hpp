/// Requests and responses as plain values without sockets, for the rest of the server.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
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

/// Decodes percent escapes ("%2F") and "+". Errors: bad_input for an invalid escape and for a zero
/// byte.
core::Result<std::string> percent_decoded(std::string_view text);

/// The part of a request before the body.
struct RequestHead {
  std::string method;                          ///< "GET"
  std::string path;                            ///< begins with '/', not decoded
  std::map<std::string, std::string> query;    ///< decoded
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string peer;                            ///< network address of the client, without port
  std::uint64_t body_bytes = 0;                ///< announced length; 0 without a body or if chunked

  /// The value of the header, or "".
  std::string_view header(std::string_view lower_case_name) const;
  /// The value of a cookie, or "".
  std::string_view cookie(std::string_view name) const;
};

/// Splits "/path?query" into `head`. Errors: bad_input.
core::Result<void> read_target(std::string_view target, RequestHead& head);

/// The last address in X-Forwarded-For, which the proxy wrote; anybody may have written the
/// addresses before it. Without the header, or if the last entry is not an address: the peer
/// itself.
std::string forwarded_peer(const RequestHead& head);

struct Request : RequestHead {
  std::string body;
  /// File with a large body, which exists while the request is handled; empty: the body is in
  /// `body`.
  std::filesystem::path body_file = {};
  /// True once nobody waits for the answer any more: the client closed its connection, or the server
  /// stops. For a handler that works for long; may be called from any thread while the request is
  /// handled. Empty: somebody waits.
  std::function<bool()> called_off = {};
};

/// A part of a file, which is sent in pieces.
struct FileSlice {
  std::filesystem::path path;
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
  std::shared_ptr<const void> owner = {};  ///< kept alive until the file is sent
};

/// A body that is made while it is sent, so that its size is not bounded by memory or disk.
class BodySource {
 public:
  virtual ~BodySource() = default;
  /// Replaces `piece` by the next bytes, at least one, until the whole body was handed out. Called
  /// on worker threads, one call after the other, and only when the client took the piece before.
  /// An error closes the connection before the announced end, which is how the client is told.
  virtual core::Result<void> read(std::string& piece) = 0;
};

struct MadeBody {
  std::shared_ptr<BodySource> source;
  std::uint64_t size = 0;
};

struct Response {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::variant<std::string, FileSlice, MadeBody> body;

  Response& with(std::string name, std::string value) {
    headers.emplace_back(std::move(name), std::move(value));
    return *this;
  }
  /// The value of a header set with exactly this name, or "".
  std::string_view header(std::string_view name) const;
};

/// {"error": text, "code": code} as JSON.
Response error_response(int status, std::string_view code, std::string_view text);

/// Bytes [first, last] of a "Range: bytes=…" header for a file of `size` bytes. Nothing if there is
/// no range, or a range of an unsupported form (several ranges, another unit). Errors: out_of_range
/// if the range lies wholly beyond the end (416).
core::Result<std::optional<std::pair<std::uint64_t, std::uint64_t>>> byte_range(
    std::string_view header, std::uint64_t size);

/// The part of a representation of `size` bytes that the request wants: `response` becomes 200, 206
/// or 416, with the headers of a range. With a header If-Range other than `entity_tag` the whole.
/// Returns the first byte and the number of bytes; nothing for 416.
std::optional<std::pair<std::uint64_t, std::uint64_t>> wanted_part(const RequestHead& request,
                                                                   std::uint64_t size,
                                                                   std::string_view entity_tag,
                                                                   Response& response);

/// A response with the file, or with the part that the request's Range header names: 200, 206 or
/// 416. Errors: not_found, io.
core::Result<Response> file_response(const std::filesystem::path& path, const RequestHead& request,
                                     std::string content_type);

}  // namespace tractus::http
