/// Getting cases from the server.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/progress.hpp"
#include "station/uplink/server.hpp"

namespace uplink {

struct SyncReport {
  std::vector<std::string> fetched;  ///< case ids
  std::vector<std::string> present;
  std::vector<std::string> refused;  ///< one line each: id and why

  core::Json to_json() const;
};

/// Fetches every case that `cases_folder` lacks: the signed manifest, its signature and each part
/// that is not secret (a secret one is not even asked for), into a scratch folder; verified whole
/// (cases::open_case, the name is the content, the signer is one of `trusted`) before it appears as
/// `cases_folder/<id>`. A case that does not hold is refused by name and the next is taken. Errors:
/// the server's, unavailable, io.
core::Result<SyncReport> sync_cases(Server& server, const std::filesystem::path& cases_folder,
                                    const std::vector<std::string>& trusted,
                                    const core::Progress& progress = {});

}  // namespace uplink
