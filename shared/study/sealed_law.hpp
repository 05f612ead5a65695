/// What a station is given of a blind trial.
#pragma once

#include <string>
#include <string_view>

#include "core/result.hpp"
#include "laws/probing_law.hpp"

namespace tractus::study {

/// The law's numbers as text of one size, whatever they are: JSON without names, filled up with
/// zeros, sealed by XChaCha20-Poly1305 (libsodium's secretbox) with a fresh nonce, in base64.
/// Holds layers and walls as numbers; neither a scenario's name nor its kind nor its version.
inline constexpr std::size_t kPlain_bytes = 16 * 1024;
inline constexpr std::size_t kSealed_characters = 21900;  ///< 4 ⌈(24 + 16 + kPlain_bytes) / 3⌉

/// The key of one station: a keyed hash of what the server keeps of its token, which the station
/// can make from the token.
/// @param token_sha256  64 hexadecimal characters, SHA-256 of the token
class StationKey {
 public:
  explicit StationKey(std::string_view token_sha256);

 private:
  friend core::Result<std::string> sealed_law(const laws::ProbingParameters&, std::string_view,
                                              const StationKey&);
  friend core::Result<laws::ProbingParameters> opened_law(std::string_view, std::string_view,
                                                          const StationKey&);
  std::string bytes_;
};

/// @param trial  the name of the trial it is for: opened under another name it does not hold.
/// Errors: too_large when the numbers do not fit (about 130 layers).
core::Result<std::string> sealed_law(const laws::ProbingParameters& law, std::string_view trial,
                                     const StationKey& key);
/// Errors: corrupt (not sealed for this trial with this key, or changed since).
core::Result<laws::ProbingParameters> opened_law(std::string_view sealed, std::string_view trial,
                                                 const StationKey& key);

}  // namespace tractus::study
