/// core::Sha256 by libsodium in place of OpenSSL: an FMU is one shared object that needs nothing but
/// the C library, and what it hashes is small.
#include <sodium.h>

#include "core/bytes.hpp"

namespace tractus {
namespace core {

struct Sha256::State {
  crypto_hash_sha256_state sodium;
};

Sha256::Sha256() : state_(std::make_unique<State>()) { crypto_hash_sha256_init(&state_->sodium); }
Sha256::~Sha256() = default;
Sha256::Sha256(Sha256&&) noexcept = default;
Sha256& Sha256::operator=(Sha256&&) noexcept = default;
void Sha256::add(ByteView part) noexcept {
  crypto_hash_sha256_update(&state_->sodium, reinterpret_cast<const unsigned char*>(part.data()),
                            part.size());
}
std::string Sha256::hex() {
  std::array<std::byte, crypto_hash_sha256_BYTES> digest{};
  crypto_hash_sha256_final(&state_->sodium, reinterpret_cast<unsigned char*>(digest.data()));
  return core::hex(digest);
}

}  // namespace core
}  // namespace tractus
