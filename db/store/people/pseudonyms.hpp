/// Pseudonyms of people and trials for research: keyed hashes (BLAKE2b), the same in every export.
/// The key is in a separate file; without the key nobody can link pseudonyms with people, even with
/// the database.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "core/result.hpp"

namespace tractus::store {

using PseudonymKey = std::array<std::byte, 32>;

class Pseudonyms {
 public:
  explicit Pseudonyms(const PseudonymKey& key) : key_(key) {}
  /// Errors: unavailable without a key.
  static core::Result<Pseudonyms> of(const std::optional<PseudonymKey>& key);
  std::string trial(const std::string& id) const;  ///< "T" and 16 hexadecimal characters
  /// "P" and 16 hexadecimal characters. @param id  as store::ConsentBook::person_of says
  std::string person(const std::string& id) const;

 private:
  std::string hashed(char first, const std::string& text) const;
  PseudonymKey key_;
};

}  // namespace tractus::store
