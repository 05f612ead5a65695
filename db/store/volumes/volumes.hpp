/// CT volumes that people uploaded: held, released or refused.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

enum class VolumeState {
  held,      ///< nobody has decided about it
  released,  ///< cases may be made of it
  refused,
};
constexpr auto words(VolumeState) {
  using enum VolumeState;
  return std::to_array<core::Word<VolumeState>>(
      {{held, "held"}, {released, "released"}, {refused, "refused"}});
}

struct VolumeRecord {
  std::string id, name;
  std::string source;  ///< origin and licence, as the uploading person stated them
  VolumeState state = VolumeState::held;
  std::string sha256;            ///< of its .tvol among the objects; empty once refused
  std::uint64_t size_bytes = 0;  ///< of that file
  std::string facts = "{}";      ///< JSON: format, modality, geometry, range, suspicions, notes
  std::string report = "{}";     ///< JSON: tractus-deidentification/1
  std::int64_t made_utc_us = 0;
  std::string made_by, made_by_id;
  std::optional<std::int64_t> decided_utc_us = {};
  std::optional<std::string> decided_by = {};
  std::string reason = {};  ///< of a refusal
};

/// Errors: conflict, naming the volume, if the same voxels are already stored and were not refused.
core::Result<void> add_volume(Writing& tx, const VolumeRecord& volume);
core::Result<std::optional<VolumeRecord>> volume_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<VolumeRecord>> all_volumes(Reading& tx);

/// A decision about a held volume.
struct Decision {
  VolumeState state = VolumeState::released;  ///< or refused
  std::string by, reason;
  std::int64_t at_utc_us = 0;
};
/// Decides about a held volume, once. Returns the SHA-256 of a refused volume's file if no other
/// record uses this object, whose row is then deleted; else an empty text. Errors: not_found;
/// conflict if the volume was decided before.
core::Result<std::string> decide_volume(Writing& tx, const std::string& id,
                                        const Decision& decision);

}  // namespace tractus::store
