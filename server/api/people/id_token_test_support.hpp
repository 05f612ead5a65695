/// A provider's key that signs id_tokens.
#pragma once

#include <gtest/gtest.h>
#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/evp.h>
#include <openssl/rsa.h>

#include "core/bytes.hpp"
#include "server/api/people/id_token.hpp"

namespace tractus::api::testing {

inline std::string encoded(std::string_view text) { return core::base64url(core::bytes_of(text)); }

/// An RSA key of the test's own.
class Signer {
 public:
  Signer() : key_(EVP_RSA_gen(2048)) {}
  ~Signer() { EVP_PKEY_free(key_); }
  Signer(const Signer&) = delete;
  Signer& operator=(const Signer&) = delete;

  core::Json jwk(const std::string& kid = "k1") const {
    return {{"kty", "RSA"}, {"use", "sig"},     {"alg", "RS256"},
            {"kid", kid},   {"n", number("n")}, {"e", number("e")}};
  }
  std::string token(const core::Json& claims,
                    const core::Json& header = {{"alg", "RS256"}, {"kid", "k1"}}) const {
    const std::string text = encoded(header.dump()) + "." + encoded(claims.dump());
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    std::string signature(256, '\0');
    std::size_t size = signature.size();
    EXPECT_EQ(EVP_DigestSignInit(context, nullptr, EVP_sha256(), nullptr, key_), 1);
    EXPECT_EQ(EVP_DigestSign(context, reinterpret_cast<unsigned char*>(signature.data()), &size,
                             reinterpret_cast<const unsigned char*>(text.data()), text.size()),
              1);
    EVP_MD_CTX_free(context);
    return text + "." + encoded(signature);
  }

 private:
  std::string number(const char* which) const {
    BIGNUM* value = nullptr;
    EXPECT_EQ(EVP_PKEY_get_bn_param(key_, which, &value), 1);
    std::string bytes(std::size_t(BN_num_bytes(value)), '\0');
    BN_bn2bin(value, reinterpret_cast<unsigned char*>(bytes.data()));
    BN_free(value);
    return encoded(bytes);
  }
  EVP_PKEY* key_;
};

}  // namespace tractus::api::testing
