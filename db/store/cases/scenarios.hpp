/// Versions of probing scenarios that people wrote on this server, one row per version.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct ScenarioVersion {
  std::string id;      ///< hash of its contents, 64 hexadecimal characters
  std::string sha256;  ///< of the object that is its file
  std::string name;
  std::string kind;                   ///< "hard", "soft", "lateral_breach", "in_out_in"
  std::optional<std::string> parent;  ///< version from which this version was made, if any
  bool published = false;             ///< assignments can use it
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

/// The object must be recorded before. Errors: conflict if the version exists.
core::Result<void> add_scenario_version(Writing& tx, const ScenarioVersion& version);
core::Result<std::optional<ScenarioVersion>> scenario_version_of(Reading& tx,
                                                                 const std::string& id);
/// Newest first.
core::Result<std::vector<ScenarioVersion>> all_scenario_versions(Reading& tx);
core::Result<void> set_scenario_published(Writing& tx, const std::string& id, bool published);

}  // namespace tractus::store
