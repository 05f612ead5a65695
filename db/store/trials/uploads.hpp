/// Uploads in progress: the announcement of the station. The size of the partial file
/// (PartialFiles) is the number of received bytes.
#pragma once

#include <vector>

#include "db/store/store.hpp"
#include "trial/upload_phase.hpp"

namespace tractus::store {

using trial::UploadPhase;

struct Upload {
  std::string trial_id;
  std::string station_id;
  std::string case_id;
  std::uint64_t size_bytes = 0;
  std::string sha256;
  UploadPhase state = UploadPhase::receiving;
};

core::Result<std::optional<Upload>> upload_of(Reading& tx, const std::string& trial_id);
/// The same by one statement; for a trial whose person has left the error of check_trial_stays.
core::Result<std::optional<Upload>> staying_upload_of(Reading& tx, const std::string& trial_id);
/// The same while its name is held (Store::hold), until the lock goes.
struct HeldUpload {
  std::unique_ptr<NamedLock> lock;
  std::optional<Upload> upload;
};
core::Result<HeldUpload> hold_staying_upload(Store& store, const std::string& trial_id);
/// The name by which an upload is held.
std::string upload_lock(const std::string& trial_id);
/// All that are still receiving.
core::Result<std::vector<Upload>> open_uploads(Reading& tx);
/// Those of them that were announced after `utc_us`.
core::Result<std::vector<Upload>> open_uploads_since(Reading& tx, std::int64_t utc_us);
/// What they announced together, bytes.
core::Result<std::uint64_t> open_upload_bytes_since(Reading& tx, std::int64_t utc_us);
core::Result<std::uint64_t> open_upload_count(Reading& tx, const std::string& station_id);
core::Result<void> add_upload(Writing& tx, const Upload& upload, std::int64_t now_utc_us);
core::Result<void> complete_upload(Writing& tx, const std::string& trial_id);

}  // namespace tractus::store
