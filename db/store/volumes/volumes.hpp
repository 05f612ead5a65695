/// CT volumes that people brought in: held, released or refused.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct VolumeRecord {
  std::string id, name;
  std::string source;            ///< where it came from and its licence, in its bringer's words
  std::string state = "held";    ///< "held", "released", "refused"
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

/// Errors: conflict when the same voxels are here already and were not refused, naming which.
core::Result<void> add_volume(Writing& tx, const VolumeRecord& volume);
core::Result<std::optional<VolumeRecord>> volume_of(Reading& tx, const std::string& id);
/// Newest first.
core::Result<std::vector<VolumeRecord>> all_volumes(Reading& tx);

/// Who decides what, and when.
struct Decision {
  std::string state;  ///< "released" or "refused"
  std::string by, reason;
  std::int64_t at_utc_us = 0;
};
/// Of a held volume, once. A refused one gives up its file: the answer is its SHA-256 when nothing
/// else names that object, whose row is then gone too; else empty.
/// Errors: not_found; conflict when it was decided already.
core::Result<std::string> decide_volume(Writing& tx, const std::string& id,
                                        const Decision& decision);

}  // namespace tractus::store
