/// Handing over what self-tests and calibrations left in the station's folder.
#pragma once

#include <filesystem>
#include <vector>

#include "station/uplink/server.hpp"

namespace tractus::uplink {

struct ReportsHanded {
  int handed_over = 0;
  std::vector<std::string> refused;  ///< one line each; the file is set aside as NAME.refused
};
/// Every `reports/*.json` (the body of POST /api/v1/station/report), oldest name first; a file goes
/// when the server has it. Repeating is harmless. Errors: the server's, when it does not answer.
core::Result<ReportsHanded> hand_over_reports(Server& server, const std::filesystem::path& folder);

}  // namespace tractus::uplink
