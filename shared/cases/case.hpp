/// A case: what a trainee is given to palpate, and apart from it the truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "cases/certificate.hpp"
#include "core/json.hpp"
#include "core/signing.hpp"
#include "models/model.hpp"
#include "volume/tract.hpp"
#include "volume/volume_file.hpp"

namespace tractus::cases {

inline constexpr const char* kVolumePart = "volume.tvol";
inline constexpr const char* kTruthPart = "truth.json";
inline constexpr const char* kPicturePart = "picture.png";
inline constexpr const char* kCertificatePart = "certificate.json";

/// A file of the bundle, named by its content.
struct Part {
  std::string name;  ///< "volume.tvol", "truth.json", "picture.png", "certificate.json"
  std::string sha256;
  std::uint64_t size_bytes = 0;
  bool secret = false;  ///< never leaves the server for a station or a trainee
};

/// `case.json`, format `tractus-case/1`. A bundle is a folder: case.json, case.sig
/// (`tractus-signature/1`: Ed25519 over the bytes of case.json, with the maker's public key) and
/// the parts. The case's id is the SHA-256 of case.json.
struct Case {
  std::string title;
  std::string source;  ///< where the volume came from, licence
  std::int64_t made_utc_us = 0;
  volume::Tract tract = {};
  bool planned = false;  ///< the tract is a plan alone: the bone is whole, a channel is to be made
  volume::Preparation preparation = volume::Preparation::published;  ///< of the volume's bone
  /// Whether an ideal observer can tell a breach of every wall; nothing for a case that was made
  /// without being tried.
  std::optional<bool> certified = {};
  models::PalpationModel model = {};  ///< probe, transfer function, factors
  std::vector<Part> parts =
      {};  ///< the volume open, the truth secret, the picture (it shows the breach) secret

  core::Json to_json() const;
  /// @param where  leads every message, as "case.json: ". Errors: bad_input naming the field.
  static core::Result<Case> from_json(const core::Json& json, const std::string& where);
};

/// `truth.json`, format `tractus-truth/1`: which wall is breached and where. Carries 32 random
/// bytes, so that its hash in the open manifest tells nothing; the picture carries others for the
/// same reason.
struct Truth {
  std::optional<volume::Wall> breached;
  std::optional<math::Vec3> breach_m;  ///< centre of the hole in the wall, in V
  double breach_depth_m = 0.0;         ///< how far the tool went beyond the bone
  double wall_thickness_m = 0.0;       ///< of the bone there before it gave way
  std::string salt_hex = {};

  core::Json to_json() const;
  static core::Result<Truth> from_json(const core::Json& json, const std::string& where);
};

struct OpenedCase {
  std::string id;
  Case definition;
  std::string signer_public_hex;
  std::filesystem::path folder;
};

/// What a bundle is made of. `definition.parts`, `definition.certified` and `truth.salt_hex` are
/// filled by `write_case`.
struct NewCase {
  Case definition;
  Truth truth;
  const volume::Volume& volume;
  volume::VolumeMeta meta;
  /// Draws the picture into a file; may be empty: then the bundle has none.
  std::function<core::Result<void>(const std::filesystem::path&)> draw;
  std::optional<Certificate> certificate = {};  ///< a secret part: it shows where the breach is
};

/// Makes the bundle whole or not at all. Errors: conflict (`folder` is there already), io,
/// cancelled.
core::Result<OpenedCase> write_case(const std::filesystem::path& folder, NewCase made,
                                    const core::KeyPair& key, const core::Progress& progress = {});

/// Opens and verifies a bundle: signature, and size and SHA-256 of every part that is there. A
/// secret part may be absent (a station has none); any other absence, surplus or difference is
/// Errc::corrupt by name. That the signature holds says that nobody changed the case since; whether
/// its signer is trusted is for the caller to say.
core::Result<OpenedCase> open_case(const std::filesystem::path& folder);

/// The truth of an opened case, checked against the manifest again. Errors: not_found where the
/// bundle has none.
core::Result<Truth> read_truth(const OpenedCase& opened);
/// The certificate of an opened case as JSON (cases::Certificate), checked in the same way. Errors:
/// not_found where the bundle has none.
core::Result<core::Json> read_certificate(const OpenedCase& opened);

}  // namespace tractus::cases
