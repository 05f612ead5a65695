/// Getting versions of models from the server: a better one can be felt minutes after it was found.
#pragma once

#include <filesystem>

#include "station/uplink/server.hpp"

namespace tractus::uplink {

/// A version on the disk: `models/<id>.json`, with its name in `models/names.json`.
struct KeptModel {
  std::string id, name, rig;
};

struct ModelReport {
  std::vector<std::string> fetched;  ///< names
  std::vector<std::string> present;
  std::vector<std::string> refused;   ///< one line each: name and why
  std::vector<std::string> recalled;  ///< names of versions that were taken back and are gone here
  core::Json to_json() const;
};

/// Fetches every version that was sent to this station and that `folder` lacks; each is checked
/// against its SHA-256 before it appears, and the server is told. Removes the versions that were
/// recalled. A server from before models were
/// sent has none. Errors: the server's, unavailable, io.
core::Result<ModelReport> sync_models(Server& server, const std::filesystem::path& folder);

/// The file of a version in `folder` by its name or by 8 or more characters of its id; the last
/// sent of several of one name. Errors: not_found naming what there is.
core::Result<std::filesystem::path> model_named(const std::filesystem::path& folder,
                                                const std::string& name);

}  // namespace tractus::uplink
