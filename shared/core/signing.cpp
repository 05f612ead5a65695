#include "core/signing.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include "core/file.hpp"
#include "core/try.hpp"

namespace tractus {
namespace core {
namespace {
const unsigned char* unsigned_bytes(ByteView bytes) {
  return reinterpret_cast<const unsigned char*>(bytes.data());
}

std::string public_part(const Bytes& secret) {
  std::array<std::byte, crypto_sign_PUBLICKEYBYTES> key{};
  crypto_sign_ed25519_sk_to_pk(reinterpret_cast<unsigned char*>(key.data()),
                               unsigned_bytes(secret));
  return hex(key);
}
}  // namespace

KeyPair KeyPair::generate() {
  require(sodium_init() >= 0, "libsodium starts");
  std::array<unsigned char, crypto_sign_PUBLICKEYBYTES> open_key{};
  KeyPair pair;
  pair.secret.resize(crypto_sign_SECRETKEYBYTES);
  crypto_sign_keypair(open_key.data(), reinterpret_cast<unsigned char*>(pair.secret.data()));
  pair.public_hex = public_part(pair.secret);
  return pair;
}

KeyPair KeyPair::from_seed(const std::array<std::byte, 32>& seed) {
  static_assert(crypto_sign_SEEDBYTES == 32);
  std::array<unsigned char, crypto_sign_PUBLICKEYBYTES> open_key{};
  KeyPair pair;
  pair.secret.resize(crypto_sign_SECRETKEYBYTES);
  crypto_sign_seed_keypair(open_key.data(), reinterpret_cast<unsigned char*>(pair.secret.data()),
                           unsigned_bytes(seed));
  pair.public_hex = public_part(pair.secret);
  return pair;
}

Result<KeyPair> KeyPair::open_or_make(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) {
    KeyPair pair = generate();
    std::error_code failure;
    if (path.has_parent_path()) std::filesystem::create_directories(path.parent_path(), failure);
    TRY(write_file(path, pair.secret));
    std::filesystem::permissions(
        path, std::filesystem::perms::owner_read | std::filesystem::perms::owner_write, failure);
    return pair;
  }
  auto secret = TRY(read_file(path, 4096));
  if (secret.size() != crypto_sign_SECRETKEYBYTES)
    return Error{Errc::corrupt, fmt::format("{}: {} bytes, a signing key has {}", path.string(),
                                            secret.size(), crypto_sign_SECRETKEYBYTES)};
  return KeyPair{public_part(secret), std::move(secret)};
}

std::string sign(ByteView message, const KeyPair& key) {
  std::array<std::byte, crypto_sign_BYTES> signature{};
  crypto_sign_detached(reinterpret_cast<unsigned char*>(signature.data()), nullptr,
                       unsigned_bytes(message), message.size(), unsigned_bytes(key.secret));
  return hex(signature);
}

bool verify(ByteView message, std::string_view signature_hex,
            std::string_view public_hex) noexcept {
  if (signature_hex.size() != 2 * crypto_sign_BYTES ||
      public_hex.size() != 2 * crypto_sign_PUBLICKEYBYTES)
    return false;
  const auto signature = hex_decoded(signature_hex), open_key = hex_decoded(public_hex);
  return signature && open_key &&
         crypto_sign_verify_detached(unsigned_bytes(*signature), unsigned_bytes(message),
                                     message.size(), unsigned_bytes(*open_key)) == 0;
}

}  // namespace core
}  // namespace tractus
