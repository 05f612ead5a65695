/// What station, server and web say to one another over HTTP as JSON, version 1. Times UTC in
/// microseconds; units in the names.
#pragma once

#include <cstdint>
#include <string>

#include "core/json.hpp"
#include "trial/upload_phase.hpp"

namespace tractus::wire {

/// Where an upload stands.
struct UploadState {
  std::uint64_t offset_bytes = 0;
  trial::UploadPhase state = trial::UploadPhase::receiving;

  core::Json to_json() const;
  static core::Result<UploadState> from_json(const core::Json& json, const std::string& where);
};

/// What a station announces before the first byte. The same announcement twice is the same upload.
struct UploadAnnouncement {
  std::string case_id;           ///< SHA-256 of case.json
  std::uint64_t size_bytes = 0;  ///< of the trial file
  std::string sha256;            ///< of the trial file

  core::Json to_json() const;
  static core::Result<UploadAnnouncement> from_json(const core::Json& json,
                                                    const std::string& where);
};

/// Largest chunk a server takes in one request.
inline constexpr std::uint64_t kMaxChunk_bytes = 4u << 20;

}  // namespace tractus::wire
