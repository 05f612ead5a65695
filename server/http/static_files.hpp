/// A folder of built web pages.
#pragma once

#include <filesystem>

#include "server/http/message.hpp"

namespace tractus::http {

/// Serves files of one folder and nothing above it: a path is taken apart into names, and a name
/// that is "..", hidden, or holds a separator is not found. A path without extension is the
/// application's own and answers index.html.
class StaticFiles {
 public:
  explicit StaticFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// GET and HEAD alone (405 else). Files named with their content's hash may be kept for ever, the
  /// rest is asked for again each time (ETag, 304).
  Response answer(const RequestHead& request) const;

 private:
  std::filesystem::path folder_;
};

/// Headers that every response carries: no sniffing, no framing, no scripts but our own (vtk.js
/// needs WebAssembly and blob workers). An answer that does not say how long it may be kept is not
/// kept at all (Cache-Control: no-store).
void add_security_headers(Response& response);
/// A browser that was answered by TLS once asks by TLS alone, for a year (RFC 6797).
void require_tls(Response& response);

}  // namespace tractus::http
