/// Versions of models that were sent to stations: what a station is to have, and what it has.
#pragma once

#include "db/store/lab/lab.hpp"

namespace tractus::store {

struct SentModel {
  std::string station_id, station_name;
  std::optional<std::int64_t> asked_utc_us;  ///< nothing: it was not sent there
  std::string asked_by;
  std::optional<std::int64_t> there_utc_us;  ///< nothing: the station has not said so yet
};

/// Sent again: as it stands. Errors: not_found for a station that there is not, or that is revoked.
core::Result<void> send_model(Writing& tx, const std::string& model_id,
                              const std::string& station_id, const std::string& by,
                              std::int64_t now_utc_us);
/// Every station that is not revoked, by name, and whether a version was sent there.
core::Result<std::vector<SentModel>> sent_to(Reading& tx, const std::string& model_id);
/// What a station is to have, the first sent first.
core::Result<std::vector<ModelVersion>> models_for(Reading& tx, const std::string& station_id);
/// The station has it. Errors: not_found when it was not sent there.
core::Result<void> note_model_there(Writing& tx, const std::string& model_id,
                                    const std::string& station_id, std::int64_t now_utc_us);

}  // namespace tractus::store
