/// A case: what a trainee is given to palpate, and apart from it the truth.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/signing.hpp"
#include "models/model.hpp"
#include "volume/tract.hpp"

namespace cases {

/// A file of the bundle, named by its content.
struct Part {
  std::string name;  ///< "volume.tvol", "truth.json", "picture.png"
  std::string sha256;
  std::uint64_t size_bytes = 0;
  bool secret = false;  ///< never leaves the server for a station or a trainee
};

/// `case.json`, format `tractus-case/1`. A bundle is a folder: case.json, case.sig (Ed25519 over
/// the bytes of case.json, with the maker's public key) and the parts. The case's id is the SHA-256
/// of case.json.
struct Case {
  std::string title;
  std::string source;  ///< where the volume came from, licence
  std::int64_t made_utc_us = 0;
  volume::Tract tract;
  models::PalpationModel model;  ///< probe, transfer function, factors
  std::vector<Part> parts;

  core::Json to_json() const;
  static core::Result<Case> from_json(const core::Json& json, const std::string& where);
};

/// `truth.json`, format `tractus-truth/1`: which wall is breached and where. Carries 32 random
/// bytes, so that its hash in the open manifest tells nothing.
struct Truth {
  std::optional<volume::Wall> breached;
  std::optional<math::Vec3> breach_m;  ///< centre of the hole in the wall, in V
  double breach_depth_m = 0.0;         ///< how far the tool went beyond the bone
  double wall_thickness_m = 0.0;       ///< of the bone there before it gave way
  std::string salt_hex;

  core::Json to_json() const;
  static core::Result<Truth> from_json(const core::Json& json, const std::string& where);
};

struct OpenedCase {
  std::string id;
  Case definition;
  std::string signer_public_hex;
  std::filesystem::path folder;
};

/// Opens and verifies a bundle: signature, and size and SHA-256 of every part that is there. A
/// secret part may be absent (a station has none); any other absence, surplus or difference is
/// Errc::corrupt by name.
core::Result<OpenedCase> open_case(const std::filesystem::path& folder);

}  // namespace cases
