#include "db/store/people/pseudonyms.hpp"

#include <sodium.h>

#include "core/bytes.hpp"

namespace tractus::store {

core::Result<Pseudonyms> Pseudonyms::of(const std::optional<PseudonymKey>& key) {
  if (key) return Pseudonyms(*key);
  return core::Error{
      core::Errc::unavailable,
      "this server does not have the key of its pseudonyms: exports are not possible"};
}

std::string Pseudonyms::hashed(char first, const std::string& text) const {
  std::array<std::byte, 16> hash{};
  const std::string message = first + text;
  crypto_generichash(reinterpret_cast<unsigned char*>(hash.data()), hash.size(),
                     reinterpret_cast<const unsigned char*>(message.data()), message.size(),
                     reinterpret_cast<const unsigned char*>(key_.data()), key_.size());
  return first + core::hex(hash).substr(0, 16);
}

std::string Pseudonyms::trial(const std::string& id) const { return hashed('T', id); }
std::string Pseudonyms::person(const std::string& id) const { return hashed('P', id); }

}  // namespace tractus::store
