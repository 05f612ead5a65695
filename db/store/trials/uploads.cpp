#include "db/store/trials/uploads.hpp"

#include "core/try.hpp"
#include "db/store/people/erasure.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kUpload =
    "select trial_id, station_id, case_id, size_bytes, sha256, state from uploads ";

core::Result<Upload> upload_from(const Row& row) {
  const auto state = TRY(row.word<UploadPhase>(5, "uploads.state"));
  return Upload{row.text(0), row.text(1), row.text(2), row.count(3), row.text(4), state};
}

}  // namespace

core::Result<std::optional<Upload>> upload_of(Reading& tx, const std::string& trial_id) {
  return one_of(tx.query(std::string(kUpload) + "where trial_id = ?", {trial_id}), upload_from);
}

namespace {

constexpr const char* kStaying =
    "select trial_id, station_id, case_id, size_bytes, sha256, state, (select count(*) "
    "from erased_trials e where e.trial_id = uploads.trial_id) from uploads where trial_id = ?";

/// Whether the rows of kStaying do not say by themselves that the trial stays.
bool may_be_erased(const Rows& rows) { return rows.empty() || rows.front().count(6) > 0; }

}  // namespace

core::Result<std::optional<Upload>> staying_upload_of(Reading& tx, const std::string& trial_id) {
  const auto rows = TRY(tx.query(kStaying, {trial_id}));
  if (may_be_erased(rows)) TRY(check_trial_stays(tx, trial_id));
  return one_of(core::Result<Rows>(rows), upload_from);
}

std::string upload_lock(const std::string& trial_id) { return "upload " + trial_id; }

core::Result<HeldUpload> hold_staying_upload(Store& store, const std::string& trial_id) {
  auto [lock, rows] =
      TRY(store.hold_and_query(upload_lock(trial_id), {.sql = kStaying, .values = {trial_id}}));
  if (may_be_erased(rows))
    TRY(store.read([&](Reading& tx) { return check_trial_stays(tx, trial_id); }));
  return HeldUpload{std::move(lock), TRY(one_of(core::Result<Rows>(rows), upload_from))};
}

core::Result<std::vector<Upload>> open_uploads(Reading& tx) {
  return open_uploads_since(tx, INT64_MIN);
}

core::Result<std::vector<Upload>> open_uploads_since(Reading& tx, std::int64_t utc_us) {
  return all_of(
      tx.query(std::string(kUpload) + "where state = 'receiving' and announced_utc_us > ? "
                                      "order by announced_utc_us, trial_id",
               {utc_us}),
      upload_from);
}

core::Result<std::uint64_t> open_upload_bytes_since(Reading& tx, std::int64_t utc_us) {
  auto rows =
      TRY(tx.query("select cast(coalesce(sum(size_bytes), 0) as bigint) from uploads "
                   "where state = 'receiving' and announced_utc_us > ?",
                   {utc_us}));
  return rows.front().count(0);
}

core::Result<std::uint64_t> open_upload_count(Reading& tx, const std::string& station_id) {
  auto rows = TRY(tx.query(
      "select count(*) from uploads where station_id = ? and state = 'receiving'", {station_id}));
  return rows.front().count(0);
}

core::Result<void> add_upload(Writing& tx, const Upload& upload, std::int64_t now_utc_us) {
  return done(
      tx.query("insert into uploads (trial_id, station_id, case_id, size_bytes, sha256, state, "
               "announced_utc_us) values (?, ?, ?, ?, ?, ?, ?)",
               {upload.trial_id, upload.station_id, upload.case_id, count_value(upload.size_bytes),
                upload.sha256, name_value(upload.state), now_utc_us}));
}

core::Result<void> complete_upload(Writing& tx, const std::string& trial_id) {
  return done(tx.query("update uploads set state = 'complete' where trial_id = ?", {trial_id}));
}

}  // namespace store
}  // namespace tractus
