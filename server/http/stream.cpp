#include "server/http/stream.hpp"

#include <fmt/format.h>

namespace tractus::http {

core::Result<boost::asio::ssl::context> tls_context(const std::filesystem::path& certificate,
                                                    const std::filesystem::path& key) {
  boost::asio::ssl::context out(boost::asio::ssl::context::tls_server);
  SSL_CTX_set_min_proto_version(out.native_handle(), TLS1_2_VERSION);
  SSL_CTX_set_options(out.native_handle(), SSL_OP_NO_RENEGOTIATION | SSL_OP_NO_COMPRESSION |
                                               SSL_OP_CIPHER_SERVER_PREFERENCE);
  // Forward secrecy and AEAD alone: no CBC suites, no key exchange by RSA. TLS 1.3 has no others.
  core::require(SSL_CTX_set_cipher_list(out.native_handle(), "ECDHE+AESGCM:ECDHE+CHACHA20") == 1,
                "OpenSSL knows the cipher suites");
  boost::system::error_code failure;
  out.use_certificate_chain_file(certificate.string(), failure);
  if (failure)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: {}", certificate.string(), failure.message())};
  out.use_private_key_file(key.string(), boost::asio::ssl::context::pem, failure);
  if (failure || SSL_CTX_check_private_key(out.native_handle()) != 1)
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: is not the key of {}", key.string(), certificate.string())};
  return out;
}

}  // namespace tractus::http
