/// A user's own effect as it comes: a file, or JSON that was sent.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "core/result.hpp"

namespace tractus::lab_io {

struct OwnEffect {
  core::Json definition;  ///< tractus-effect/1
  std::string where;      ///< leads every message: "my.json: "
};

/// Errors: those of reading, too_large over 64 KiB.
core::Result<OwnEffect> read_own(const std::filesystem::path& path);

/// The ids ("expression:my_drag"), each checked for a rig (probing or palpation): units, ranges.
/// Errors: bad_input naming the place.
core::Result<std::vector<std::string>> ids_of(const std::vector<OwnEffect>& own,
                                              const std::string& rig);

}  // namespace tractus::lab_io
