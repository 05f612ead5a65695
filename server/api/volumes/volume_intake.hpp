/// Imports an uploaded volume: from the bytes of the upload to a volume among the objects.
#pragma once

#include "core/json.hpp"
#include "server/api/route.hpp"

namespace tractus::api {

inline constexpr std::uint64_t kMaxVolume_bytes = 1ull << 30;

struct ImportedVolume {
  std::string sha256;
  std::uint64_t size_bytes = 0;
  core::Json facts, report;  ///< as jobs::import_volume answers
};

/// Reads and de-identifies the body of the call (Backend::import_volume) in a temporary folder, and
/// stores the volume among the objects. Only one import runs at a time, because it needs the memory
/// of a volume. Errors: unavailable while another import runs; those of jobs::import_volume.
core::Result<ImportedVolume> take_in(const Call& call);

}  // namespace tractus::api
