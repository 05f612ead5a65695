#include "server/api/people/secrets.hpp"

#include <sodium.h>

#include <algorithm>

#include "core/require.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::uint64_t kAudit = 1, kSealing = 2, kCases = 3, kIdentifiers = 4;

unsigned char* raw(std::byte* bytes) { return reinterpret_cast<unsigned char*>(bytes); }
const unsigned char* raw(const std::byte* bytes) {
  return reinterpret_cast<const unsigned char*>(bytes);
}

}  // namespace

Secrets Secrets::random() {
  const core::Bytes bytes = core::random_bytes(32);
  Key key{};
  std::ranges::copy(bytes, key.begin());
  return Secrets(key);
}

Secrets::Key Secrets::derived(std::uint64_t purpose) const {
  static_assert(crypto_kdf_KEYBYTES == 32);
  Key out{};
  const int failed = crypto_kdf_derive_from_key(raw(out.data()), out.size(), purpose, "tractus1",
                                                raw(master_.data()));
  core::require(failed == 0, "a key of 32 bytes can be derived");
  return out;
}

Secrets::Key Secrets::audit_key() const { return derived(kAudit); }

core::KeyPair Secrets::case_key() const { return core::KeyPair::from_seed(derived(kCases)); }

Secrets::Key Secrets::uid_key() const { return derived(kIdentifiers); }

std::string Secrets::sealed(std::string_view text) const {
  const Key key = derived(kSealing);
  core::Bytes out = core::random_bytes(crypto_secretbox_NONCEBYTES);
  out.resize(crypto_secretbox_NONCEBYTES + crypto_secretbox_MACBYTES + text.size());
  crypto_secretbox_easy(raw(out.data() + crypto_secretbox_NONCEBYTES),
                        reinterpret_cast<const unsigned char*>(text.data()), text.size(),
                        raw(out.data()), raw(key.data()));
  return core::hex(out);
}

core::Result<std::string> Secrets::opened(const std::string& sealed_text) const {
  const core::Error wrong{core::Errc::corrupt,
                          "a sealed secret does not open with this server's key"};
  constexpr std::size_t kOver = crypto_secretbox_NONCEBYTES + crypto_secretbox_MACBYTES;
  const auto bytes = core::hex_decoded(sealed_text);
  if (!bytes || bytes->size() < kOver) return wrong;
  const Key key = derived(kSealing);
  std::string out(bytes->size() - kOver, '\0');
  if (crypto_secretbox_open_easy(reinterpret_cast<unsigned char*>(out.data()),
                                 raw(bytes->data()) + crypto_secretbox_NONCEBYTES,
                                 bytes->size() - crypto_secretbox_NONCEBYTES, raw(bytes->data()),
                                 raw(key.data())) != 0)
    return wrong;
  return out;
}

}  // namespace api
}  // namespace tractus
