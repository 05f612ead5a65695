#include "server/api/people/id_token.hpp"

#include <openssl/bn.h>
#include <openssl/core_names.h>
#include <openssl/ecdsa.h>
#include <openssl/evp.h>
#include <openssl/param_build.h>

#include <array>
#include <memory>

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::size_t kMostToken_bytes = 16 * 1024, kMostSubject = 255;

template <class T, void (*kFree)(T*)>
struct Frees {
  void operator()(T* held) const { kFree(held); }
};
using Key = std::unique_ptr<EVP_PKEY, Frees<EVP_PKEY, EVP_PKEY_free>>;
using KeyContext = std::unique_ptr<EVP_PKEY_CTX, Frees<EVP_PKEY_CTX, EVP_PKEY_CTX_free>>;
using Digest = std::unique_ptr<EVP_MD_CTX, Frees<EVP_MD_CTX, EVP_MD_CTX_free>>;
using Number = std::unique_ptr<BIGNUM, Frees<BIGNUM, BN_free>>;
using Builder = std::unique_ptr<OSSL_PARAM_BLD, Frees<OSSL_PARAM_BLD, OSSL_PARAM_BLD_free>>;
using Parameters = std::unique_ptr<OSSL_PARAM, Frees<OSSL_PARAM, OSSL_PARAM_free>>;
using Signature = std::unique_ptr<ECDSA_SIG, Frees<ECDSA_SIG, ECDSA_SIG_free>>;

Error refused(const std::string& why) {
  return {Errc::unauthorised, "the provider's id_token " + why};
}

const unsigned char* raw(core::ByteView bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

Key made(const char* kind, OSSL_PARAM_BLD* builder) {
  const Parameters parameters(OSSL_PARAM_BLD_to_param(builder));
  const KeyContext context(EVP_PKEY_CTX_new_from_name(nullptr, kind, nullptr));
  EVP_PKEY* key = nullptr;
  if (!parameters || !context || EVP_PKEY_fromdata_init(context.get()) <= 0 ||
      EVP_PKEY_fromdata(context.get(), &key, EVP_PKEY_PUBLIC_KEY, parameters.get()) <= 0)
    return nullptr;
  return Key(key);
}

/// RFC 7518 section 6.3.1. Keys under 2048 bits are none (section 3.3).
Key rsa_key(const Json& jwk) {
  const auto n = core::base64url_decoded(core::text_member(jwk, "n")),
             e = core::base64url_decoded(core::text_member(jwk, "e"));
  if (!n || !e || n->empty() || e->empty() || n->size() > 1024 || e->size() > 8) return nullptr;
  const Number modulus(BN_bin2bn(raw(*n), int(n->size()), nullptr)),
      exponent(BN_bin2bn(raw(*e), int(e->size()), nullptr));
  if (!modulus || !exponent || BN_num_bits(modulus.get()) < 2048) return nullptr;
  const Builder builder(OSSL_PARAM_BLD_new());
  OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_N, modulus.get());
  OSSL_PARAM_BLD_push_BN(builder.get(), OSSL_PKEY_PARAM_RSA_E, exponent.get());
  return made("RSA", builder.get());
}

/// RFC 7518 section 6.2.1, P-256 alone.
Key ec_key(const Json& jwk) {
  const auto x = core::base64url_decoded(core::text_member(jwk, "x")),
             y = core::base64url_decoded(core::text_member(jwk, "y"));
  if (core::text_member(jwk, "crv") != "P-256" || !x || !y || x->size() != 32 || y->size() != 32)
    return nullptr;
  core::Bytes point{std::byte{4}};  // uncompressed, SEC 1 section 2.3.3
  for (const auto& part : {*x, *y}) point.insert(point.end(), part.begin(), part.end());
  const Builder builder(OSSL_PARAM_BLD_new());
  OSSL_PARAM_BLD_push_utf8_string(builder.get(), OSSL_PKEY_PARAM_GROUP_NAME, "prime256v1", 0);
  OSSL_PARAM_BLD_push_octet_string(builder.get(), OSSL_PKEY_PARAM_PUB_KEY, point.data(),
                                   point.size());
  return made("EC", builder.get());
}

/// The two numbers of 32 bytes (RFC 7518 section 3.4) as OpenSSL takes them.
Result<core::Bytes> der_of(const core::Bytes& both) {
  if (both.size() != 64) return refused("has a signature of the wrong length");
  const Signature signature(ECDSA_SIG_new());
  ECDSA_SIG_set0(signature.get(), BN_bin2bn(raw(both), 32, nullptr),
                 BN_bin2bn(raw(both) + 32, 32, nullptr));
  unsigned char* der = nullptr;
  const int size = i2d_ECDSA_SIG(signature.get(), &der);
  if (size <= 0) return refused("has an invalid signature");
  const auto bytes = std::as_bytes(std::span(der, std::size_t(size)));
  core::Bytes out(bytes.begin(), bytes.end());
  OPENSSL_free(der);
  return out;
}

bool verifies(EVP_PKEY* key, std::string_view message, const core::Bytes& signature) {
  const Digest digest(EVP_MD_CTX_new());
  return digest && EVP_DigestVerifyInit(digest.get(), nullptr, EVP_sha256(), nullptr, key) == 1 &&
         EVP_DigestVerify(digest.get(), raw(signature), signature.size(),
                          reinterpret_cast<const unsigned char*>(message.data()),
                          message.size()) == 1;
}

/// The set's keys that may have signed: of the kind, for signatures, by the name if one is given.
std::vector<const Json*> candidates(const Json& keys, const std::string& kind,
                                    const std::string& algorithm, const std::string& kid) {
  std::vector<const Json*> out;
  const auto list = keys.find("keys");
  if (list == keys.end() || !list->is_array()) return out;
  for (const Json& key : *list) {
    if (!key.is_object() || core::text_member(key, "kty") != kind) continue;
    const std::string use = core::text_member(key, "use"), alg = core::text_member(key, "alg");
    if ((use.empty() || use == "sig") && (alg.empty() || alg == algorithm) &&
        (kid.empty() || core::text_member(key, "kid") == kid))
      out.push_back(&key);
  }
  return out;
}

Result<void> check_signature(std::string_view signed_part, const core::Bytes& signature,
                             const Json& header, const Json& keys) {
  const std::string algorithm = core::text_member(header, "alg");
  if (algorithm != "RS256" && algorithm != "ES256")
    return refused("is not signed with RS256 or ES256");
  if (header.contains("crit"))
    return refused("requires extensions (crit), which are not supported");
  const bool rsa = algorithm == "RS256";
  const auto fitting =
      candidates(keys, rsa ? "RSA" : "EC", algorithm, core::text_member(header, "kid"));
  if (fitting.empty())
    return Error{Errc::not_found, "the provider's id_token is signed with an unknown key"};
  if (fitting.size() > 1 && core::text_member(header, "kid").empty())
    return refused("does not name the key (kid) with which it is signed");
  const Key key = rsa ? rsa_key(*fitting.front()) : ec_key(*fitting.front());
  if (!key) return refused("is signed with an invalid key");
  if (rsa)
    return verifies(key.get(), signed_part, signature) ? Result<void>()
                                                       : refused("is not signed by the provider");
  const auto der = TRY(der_of(signature));
  return verifies(key.get(), signed_part, der) ? Result<void>()
                                               : refused("is not signed by the provider");
}

std::int64_t seconds_field(const Json& claims, const char* key) {
  const auto at = claims.find(key);
  if (at == claims.end() || !at->is_number()) return -1;
  const double seconds = at->get<double>();
  return seconds >= 0.0 && seconds < 1e12 ? static_cast<std::int64_t>(seconds) : -1;
}

Result<void> check_audience(const Json& claims, const std::string& client_id) {
  const Json audience = claims.value("aud", Json());
  const bool one = audience == Json(client_id);
  bool among = false;
  if (audience.is_array())
    for (const Json& each : audience) among = among || each == Json(client_id);
  if (!one && !among) return refused("is for another client (aud)");
  const std::string party = core::text_member(claims, "azp");
  if (audience.is_array() && audience.size() > 1 && party.empty())
    return refused("is for several clients and does not name the authorised client (azp)");
  if (!party.empty() && party != client_id) return refused("was issued to another client (azp)");
  return {};
}

/// Texts of the claim "groups"; what is no list of texts gives nobody anything.
std::vector<std::string> groups_in(const Json& claims) {
  constexpr std::size_t kMostGroups = 1000;
  const auto list = claims.find("groups");
  std::vector<std::string> out;
  if (list == claims.end() || !list->is_array() || list->size() > kMostGroups) return out;
  for (const Json& one : *list)
    if (one.is_string()) out.push_back(one.get<std::string>());
  return out;
}

std::string name_in(const Json& claims) {
  constexpr std::size_t kMaxClaim = 200;
  std::string name = core::text_member(claims, "name");
  if (name.empty()) name = core::text_member(claims, "preferred_username");
  return name.size() <= kMaxClaim ? name : std::string();
}

Result<void> check_claims(const Json& claims, const Expected& expected) {
  if (core::text_member(claims, "iss") != expected.issuer)
    return refused("has another issuer (iss)");
  TRY(check_audience(claims, expected.client_id));
  const std::int64_t expires = seconds_field(claims, "exp"), made_at = seconds_field(claims, "iat");
  if (expires < 0 || expected.now_s > expires + kSkew_s) return refused("has expired");
  if (made_at < 0 || made_at > expected.now_s + kSkew_s)
    return refused("was issued in the future (iat)");
  if (expected.now_s - made_at > kMostAge_s) return refused("is too old");
  if (const std::int64_t from = seconds_field(claims, "nbf"); from > expected.now_s + kSkew_s)
    return refused("is not valid yet (nbf)");
  if (expected.nonce.empty() || core::text_member(claims, "nonce") != expected.nonce)
    return refused("is not the answer to this sign-in");
  const std::string subject = core::text_member(claims, "sub");
  if (subject.empty() || subject.size() > kMostSubject) return refused("names no person (sub)");
  return {};
}

Result<Json> part(std::string_view text) {
  const auto bytes = core::base64url_decoded(text);
  if (!bytes) return refused("is not a valid JSON Web Token");
  auto out = core::parse_json(core::text_of(*bytes), "ID token");
  if (!out || !out->is_object()) return refused("is not a valid JSON Web Token");
  return out;
}

}  // namespace

Result<Json> claims_of(std::string_view token, const Json& keys, const Expected& expected) {
  if (token.size() > kMostToken_bytes) return refused("is too long");
  const auto first = token.find('.'), last = token.rfind('.');
  if (first == std::string_view::npos || first == last || token.find('.', first + 1) != last)
    return refused("is not a valid JSON Web Token");
  const auto header = TRY(part(token.substr(0, first)));
  const auto signature = core::base64url_decoded(token.substr(last + 1));
  if (!signature) return refused("is not a valid JSON Web Token");
  TRY(check_signature(token.substr(0, last), *signature, header, keys));
  auto claims = TRY(part(token.substr(first + 1, last - first - 1)));
  TRY(check_claims(claims, expected));
  return claims;
}

Result<Json> claims_by(const KeysOfAge& keys, std::string_view token, const Expected& expected) {
  constexpr std::int64_t kKept_s = 3600, kAgain_s = 10;
  auto known = TRY(keys(kKept_s));
  auto claims = claims_of(token, known, expected);
  if (claims || claims.error().code != Errc::not_found) return claims;
  known = TRY(keys(kAgain_s));  // the other server may have a new key
  claims = claims_of(token, known, expected);
  if (!claims && claims.error().code == Errc::not_found)
    return Error{Errc::unauthorised, claims.error().what};
  return claims;
}

Identity identity_in(const Json& claims) {
  return {core::text_member(claims, "sub"), core::text_member(claims, "sid"), name_in(claims),
          groups_in(claims)};
}

Result<Identity> identity_of(std::string_view token, const Json& keys, const Expected& expected) {
  const auto claims = TRY(claims_of(token, keys, expected));
  return identity_in(claims);
}

}  // namespace api
}  // namespace tractus
