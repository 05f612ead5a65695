#include "server/api/learning/tool_key.hpp"

#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rsa.h>

#include <memory>

#include "core/bytes.hpp"
#include "core/require.hpp"
#include "core/try.hpp"
#include "db/store/learning/platforms.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;

template <auto kFree>
struct Releases {
  template <class T>
  void operator()(T* held) const {
    kFree(held);
  }
};
using PrivateKey = std::unique_ptr<EVP_PKEY, Releases<EVP_PKEY_free>>;
using Signing = std::unique_ptr<EVP_MD_CTX, Releases<EVP_MD_CTX_free>>;
using Memory = std::unique_ptr<BIO, Releases<BIO_free>>;

/// A parameter of the public key, big-endian, as base64url (RFC 7518 section 6.3.1).
std::string number_of(const EVP_PKEY* key, const char* which) {
  BIGNUM* value = nullptr;
  core::require(EVP_PKEY_get_bn_param(key, which, &value) == 1, "an RSA key has a modulus");
  std::vector<unsigned char> bytes(std::size_t(BN_num_bytes(value)));
  BN_bn2bin(value, bytes.data());
  BN_free(value);
  return core::base64url(std::as_bytes(std::span(bytes)));
}

std::string pem_of(EVP_PKEY* key) {
  const Memory out(BIO_new(BIO_s_mem()));
  core::require(out && PEM_write_bio_PKCS8PrivateKey(out.get(), key, nullptr, nullptr, 0, nullptr,
                                                     nullptr) == 1,
                "memory for a key");
  char* text = nullptr;
  const long size = BIO_get_mem_data(out.get(), &text);
  return {text, std::size_t(size)};
}

std::string part_of_token(const Json& json) { return core::base64url(core::bytes_of(json.dump())); }

}  // namespace

ToolKey new_tool_key() {
  const PrivateKey key(EVP_RSA_gen(2048));
  core::require(key != nullptr, "memory for an RSA key");
  const std::string n = number_of(key.get(), OSSL_PKEY_PARAM_RSA_N);
  const std::string kid = core::sha256(core::bytes_of(n)).substr(0, 16);
  return {.kid = kid,
          .pem = pem_of(key.get()),
          .jwk = {{"kty", "RSA"},
                  {"use", "sig"},
                  {"alg", "RS256"},
                  {"kid", kid},
                  {"n", n},
                  {"e", number_of(key.get(), OSSL_PKEY_PARAM_RSA_E)}}};
}

Result<ToolKey> tool_key(Backend& backend) {
  auto row = TRY(backend.store.read([](store::Reading& tx) { return store::tool_key_row(tx); }));
  if (!row) {
    const ToolKey made = new_tool_key();
    const store::ToolKeyRow wanted{made.kid, backend.secrets.sealed(made.pem), made.jwk.dump(),
                                   backend.now_utc_us()};
    row = TRY(
        backend.store.write([&](store::Writing& tx) -> Result<std::optional<store::ToolKeyRow>> {
          auto there = TRY(store::tool_key_row(tx));
          if (there) return there;  // another thread was faster
          TRY(store::add_tool_key(tx, wanted));
          return std::optional(wanted);
        }));
  }
  const auto pem = TRY(backend.secrets.opened(row->private_key));
  return ToolKey{row->kid, pem, core::stored_json(row->public_key)};
}

Result<std::string> signed_token(const ToolKey& key, const Json& claims) {
  const Memory in(BIO_new_mem_buf(key.pem.data(), int(key.pem.size())));
  const PrivateKey opened(in ? PEM_read_bio_PrivateKey(in.get(), nullptr, nullptr, nullptr)
                             : nullptr);
  const std::string text = part_of_token({{"alg", "RS256"}, {"typ", "JWT"}, {"kid", key.kid}}) +
                           "." + part_of_token(claims);
  const Signing context(EVP_MD_CTX_new());
  std::vector<unsigned char> signature(512);
  std::size_t size = signature.size();
  if (!opened || !context ||
      EVP_DigestSignInit(context.get(), nullptr, EVP_sha256(), nullptr, opened.get()) != 1 ||
      EVP_DigestSign(context.get(), signature.data(), &size,
                     reinterpret_cast<const unsigned char*>(text.data()), text.size()) != 1)
    return core::Error{core::Errc::corrupt, "the server's key for learning platforms is damaged"};
  signature.resize(size);
  return text + "." + core::base64url(std::as_bytes(std::span(signature)));
}

}  // namespace api
}  // namespace tractus
