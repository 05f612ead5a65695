/// Versions of models that were sent to stations, and whether a station has stored them.
#pragma once

#include "db/store/lab/lab.hpp"

namespace tractus::store {

struct SentModel {
  std::string station_id, station_name;
  std::optional<std::int64_t> asked_utc_us;  ///< nothing: the version was not sent
  std::string asked_by;
  std::optional<std::int64_t> there_utc_us;  ///< nothing: the station has not confirmed it yet
};

/// Sending a version again changes nothing. Errors: not_found for an unknown or revoked station.
core::Result<void> send_model(Writing& tx, const std::string& model_id,
                              const std::string& station_id, const std::string& by,
                              std::int64_t now_utc_us);
/// Takes a version back: the station forgets it at its next request. Errors: not_found if it was not
/// sent to the station.
core::Result<void> recall_model(Writing& tx, const std::string& model_id,
                                const std::string& station_id);
/// Every station that is not revoked, sorted by name, and whether the version was sent to it.
core::Result<std::vector<SentModel>> sent_to(Reading& tx, const std::string& model_id);
/// The versions that were sent to a station, oldest first.
core::Result<std::vector<ModelVersion>> models_for(Reading& tx, const std::string& station_id);
/// Records that the station has stored the version. Errors: not_found if it was not sent to the
/// station.
core::Result<void> note_model_there(Writing& tx, const std::string& model_id,
                                    const std::string& station_id, std::int64_t now_utc_us);

}  // namespace tractus::store
