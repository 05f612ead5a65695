/// The learning record store (xAPI) to which statements of trials are sent, and of which trials.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct RecordStore {
  std::string id, endpoint;
  std::string key;     ///< name with which the server signs in there
  std::string secret;  ///< encrypted
  std::int64_t made_utc_us = 0;
  std::string made_by;
};
core::Result<std::optional<RecordStore>> record_store(Reading& tx);
/// Replaces an earlier one, whose waiting statements are withdrawn.
core::Result<void> set_record_store(Writing& tx, const RecordStore& wanted);
/// Errors: not_found if there is none.
core::Result<void> remove_record_store(Writing& tx, std::int64_t now_utc_us);

struct StatementTrial {
  std::string trial_id, study_id;
};
/// Trials to be told of: scored trials of assignments that count, received since the store was
/// stated, whose results are released, of people who consented to the tier metrics, and of which no
/// statement was queued. At most 200.
core::Result<std::vector<StatementTrial>> trials_to_state(Reading& tx);
/// Queues a delivery (deliveries.hpp) for each of trials_to_state.
core::Result<void> queue_statements(Writing& tx, std::int64_t now_utc_us);
/// Of a delivery; none if the results are held again, or the trial or the store was removed.
core::Result<std::optional<StatementTrial>> stated_trial(Reading& tx,
                                                         const std::string& delivery_id);

}  // namespace tractus::store
