#include "db/store/trials/uploads.hpp"

#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kUpload =
    "select trial_id, station_id, case_id, size_bytes, sha256, state from uploads ";

Upload upload_from(const Row& row) {
  return {row.text(0), row.text(1), row.text(2), row.count(3), row.text(4), row.text(5)};
}

core::Result<void> done(const core::Result<Rows>& rows) {
  if (!rows) return rows.error();
  return {};
}

}  // namespace

core::Result<std::optional<Upload>> upload_of(Reading& tx, const std::string& trial_id) {
  auto rows = TRY(tx.query(std::string(kUpload) + "where trial_id = ?", {trial_id}));
  if (rows.empty()) return std::optional<Upload>();
  return std::optional(upload_from(rows.front()));
}

core::Result<std::vector<Upload>> open_uploads(Reading& tx) {
  return open_uploads_since(tx, INT64_MIN);
}

core::Result<std::vector<Upload>> open_uploads_since(Reading& tx, std::int64_t utc_us) {
  auto rows = TRY(tx.query(
      std::string(kUpload) + "where state = 'receiving' and announced_utc_us > ? order by trial_id",
      {utc_us}));
  std::vector<Upload> out;
  for (const Row& row : rows) out.push_back(upload_from(row));
  return out;
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
                upload.sha256, upload.state, now_utc_us}));
}

core::Result<void> complete_upload(Writing& tx, const std::string& trial_id) {
  return done(tx.query("update uploads set state = 'complete' where trial_id = ?", {trial_id}));
}

}  // namespace store
}  // namespace tractus
