/// From an upload's bytes to a volume among the objects.
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

/// Reads and de-identifies the call's body (Backend::import_volume) in a folder of its own that is
/// gone afterwards, and puts the volume among the objects. One at a time: it takes the memory of a
/// volume. Errors: unavailable while another is read; those of jobs::import_volume.
core::Result<ImportedVolume> take_in(const Call& call);

}  // namespace tractus::api
