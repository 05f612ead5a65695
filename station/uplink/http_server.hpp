/// A server over HTTP, by libcurl: the one place where it is used.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "station/uplink/server.hpp"

namespace tractus::uplink {

/// Only http and https; redirects are refused (a token is for one server); 5 s to connect, 30 s
/// without a byte, 120 s in all; answers no larger than asked for. The certificate is checked.
class HttpServer final : public Server {
 public:
  /// @param url    "https://host:port", without a path
  /// @param token  sent as "Authorization: Bearer …"; never written anywhere
  /// @param authority  PEM file of the certificate authority to trust, and no other; empty: the
  ///                   system's
  /// Errors: bad_input (another scheme, a path, a token with odd characters).
  static core::Result<std::unique_ptr<HttpServer>> make(
      const std::string& url, const std::string& token,
      const std::filesystem::path& authority = {});
  /// One that has no token yet: for enrolling.
  static core::Result<std::unique_ptr<HttpServer>> make_nameless(
      const std::string& url, const std::filesystem::path& authority = {});
  ~HttpServer() override;
  core::Result<HttpResponse> send(const Request& request) override;

 private:
  struct Connection;
  explicit HttpServer(std::unique_ptr<Connection> connection);
  std::unique_ptr<Connection> connection_;
};

}  // namespace tractus::uplink
