/// Getting cases from the server.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "station/uplink/server.hpp"

namespace tractus::uplink {

struct SyncReport {
  std::vector<std::string> fetched;  ///< case ids
  std::vector<std::string> present;
  std::vector<std::string> refused;  ///< one line each: id and why
  std::uint64_t bytes_fetched = 0;   ///< of parts, over the line
  std::uint64_t bytes_of_cases = 0;  ///< of parts, of the cases that were fetched

  core::Json to_json() const;
};

/// What a synchronisation may take.
struct SyncLimits {
  std::uint64_t reserve_bytes = 400ull << 20;      ///< left free for trials: ten minutes at 4 kHz
  std::function<std::uint64_t()> free_bytes = {};  ///< none: the disk is asked
};

/// Fetches every case that `cases_folder` lacks: the signed manifest, its signature and each part
/// that is not secret (a secret one is not even asked for), into `incoming/<id>` beside it. A cut,
/// of the line or of this process, costs what was under way alone: the next call goes on within the
/// part. Parts, and bricks of volumes, that another case here holds are not fetched. Verified whole
/// (cases::open_case, the name is the content, the signer is one of `trusted`) before it appears as
/// `cases_folder/<id>` in one step. A case that does not hold is refused by name, nothing of it
/// stays, and the next is taken. Errors: the server's, unavailable, io (a disk without room: before
/// anything is fetched).
core::Result<SyncReport> sync_cases(Server& server, const std::filesystem::path& cases_folder,
                                    const std::vector<std::string>& trusted,
                                    const core::Progress& progress = {},
                                    const SyncLimits& limits = {});

}  // namespace tractus::uplink
