/// SHA-256 by OpenSSL, which uses the processor's instructions for it where there are any (ADR-0065).
#include <openssl/evp.h>

#include "core/bytes.hpp"
#include "core/require.hpp"

namespace tractus {
namespace core {
namespace {

/// Looked up once: OpenSSL searches its providers each time.
const EVP_MD* sha256_method() {
  static const EVP_MD* const method = EVP_MD_fetch(nullptr, "SHA256", nullptr);
  return method;
}

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

}  // namespace

struct Sha256::State {
  std::unique_ptr<EVP_MD_CTX, FreeContext> context{EVP_MD_CTX_new()};
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  require(EVP_DigestInit_ex(state_->context.get(), sha256_method(), nullptr) == 1,
          "OpenSSL has SHA-256");
}
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
void Sha256::add(ByteView part) noexcept {
  require(EVP_DigestUpdate(state_->context.get(), part.data(), part.size()) == 1,
          "a hash takes bytes until it is ended");
}
std::string Sha256::hex() {
  std::array<std::byte, 32> digest{};
  require(EVP_DigestFinal_ex(state_->context.get(), reinterpret_cast<unsigned char*>(digest.data()),
                             nullptr) == 1,
          "a hash is ended once");
  return core::hex(digest);
}

}  // namespace core
}  // namespace tractus
