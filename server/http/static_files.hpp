/// A folder of built web pages.
#pragma once

#include <filesystem>

#include "server/http/message.hpp"

namespace tractus::http {

/// Serves the files of one folder and nothing outside it: a path is split into names, and a name
/// that is "..", hidden, or contains a separator is answered with 404. A path without extension
/// belongs to the web application and is answered with index.html.
class StaticFiles {
 public:
  explicit StaticFiles(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Allows only GET and HEAD (else 405). Browsers may cache files with a content hash in their
  /// name for ever, and revalidate other files on each request (ETag, 304). Where FILE.br or
  /// FILE.gz lies beside a file and the request accepts that coding, that copy is sent instead.
  Response answer(const RequestHead& request) const;

 private:
  std::filesystem::path folder_;
};

/// Adds the headers of every response: no content sniffing, no framing, only scripts of this server
/// (vtk.js needs WebAssembly and blob workers). A response without Cache-Control gets
/// "Cache-Control: no-store".
void add_security_headers(Response& response);
/// Adds Strict-Transport-Security: a browser then uses only TLS for a year (RFC 6797).
void require_tls(Response& response);

}  // namespace tractus::http
