#include "study/sealed_law.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/json.hpp"

namespace tractus {
namespace study {
namespace {
using core::Errc;
using core::Error;
using core::Json;
using core::Result;

constexpr std::string_view kContext = "tractus-sealed-law/1";
constexpr std::size_t kNonce = crypto_secretbox_xchacha20poly1305_NONCEBYTES;
constexpr std::size_t kTag = crypto_secretbox_xchacha20poly1305_MACBYTES;
constexpr std::size_t kBox_bytes = kNonce + kTag + kPlain_bytes;
static_assert((kBox_bytes + 2) / 3 * 4 == kSealed_characters);
static_assert(crypto_secretbox_xchacha20poly1305_KEYBYTES == crypto_generichash_BYTES);

const unsigned char* raw(std::string_view text) {
  return reinterpret_cast<const unsigned char*>(text.data());
}
unsigned char* raw(std::string& text) { return reinterpret_cast<unsigned char*>(text.data()); }

std::string hash(std::string_view text, std::string_view key) {
  core::require(sodium_init() >= 0, "libsodium starts");
  std::string out(crypto_generichash_BYTES, '\0');
  crypto_generichash(raw(out), out.size(), raw(text), text.size(), raw(key), key.size());
  return out;
}

Json to_json(const laws::ProbingParameters& law) {
  Json layers = Json::array(), walls = Json::array();
  for (const auto& l : law.layers)
    layers.push_back(
        {l.start_m, l.thickness_m, l.stiffness_N_per_m, l.damping_Ns_per_m, l.equilibrium_m});
  for (const auto& w : law.walls)
    walls.push_back({w.position_m, w.resistance_interval_m, w.resistance_factor_per_m,
                     w.breach_interval_m, w.breach_damping_Ns_per_m});
  const auto& r = law.rotary;
  return Json::array({layers, walls,
                      Json::array({r.viscous_Nms_per_rad, r.detent_Nm, r.detent_pitch_rad}),
                      Json::array({law.travel_m, law.min_turning_rad_s, law.max_speed_m_s})});
}

/// @pre made by `to_json`: the seal held, so nobody else wrote it.
Result<laws::ProbingParameters> from_json(const Json& json) {
  laws::ProbingParameters out;
  const auto row = [](const Json& values, std::size_t size) {
    return values.is_array() && values.size() == size &&
           std::ranges::all_of(values, [](const Json& v) { return v.is_number(); });
  };
  const Error odd{Errc::corrupt, "a sealed trial holds other numbers than this program knows"};
  if (!json.is_array() || json.size() != 4 || !row(json[2], 3) || !row(json[3], 3)) return odd;
  for (const Json& l : json[0]) {
    if (!row(l, 5)) return odd;
    out.layers.push_back({l[0], l[1], l[2], l[3], l[4]});
  }
  for (const Json& w : json[1]) {
    if (!row(w, 5)) return odd;
    out.walls.push_back({w[0], w[1], w[2], w[3], w[4]});
  }
  out.rotary = {json[2][0], json[2][1], json[2][2]};
  out.travel_m = json[3][0];
  out.min_turning_rad_s = json[3][1];
  out.max_speed_m_s = json[3][2];
  return out;
}

}  // namespace

StationKey::StationKey(std::string_view token_sha256) : bytes_(hash(kContext, token_sha256)) {}

Result<std::string> sealed_law(const laws::ProbingParameters& law, std::string_view trial,
                               const StationKey& key) {
  std::string plain = to_json(law).dump();
  if (plain.size() > kPlain_bytes)
    return Error{Errc::too_large,
                 fmt::format("{} layers are more than a blind trial can carry", law.layers.size())};
  plain.resize(kPlain_bytes, '\0');
  std::string box(kBox_bytes, '\0');
  randombytes_buf(box.data(), kNonce);
  crypto_secretbox_xchacha20poly1305_easy(raw(box) + kNonce, raw(plain), plain.size(), raw(box),
                                          raw(hash(trial, key.bytes_)));
  return core::base64(core::bytes_of(box));
}

Result<laws::ProbingParameters> opened_law(std::string_view sealed, std::string_view trial,
                                           const StationKey& key) {
  const Error broken{Errc::corrupt,
                     "the trial was not sealed for this station, or changed since: ask the server "
                     "for it again"};
  std::string plain(kPlain_bytes, '\0');
  if (sealed.size() != kSealed_characters) return broken;
  const auto bytes = core::base64_decoded(sealed);
  if (!bytes || bytes->size() != kBox_bytes) return broken;
  const auto* box = raw(core::text_of(*bytes));
  if (crypto_secretbox_xchacha20poly1305_open_easy(raw(plain), box + kNonce, kBox_bytes - kNonce,
                                                   box, raw(hash(trial, key.bytes_))) != 0)
    return broken;
  plain.resize(plain.find_last_not_of('\0') + 1);
  auto json = core::parse_json(plain, "sealed trial");
  if (!json) return broken;
  return from_json(*json);
}

}  // namespace study
}  // namespace tractus
