#include "db/store/volumes/pacs_imports.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr std::int64_t kMinute_us = 60'000'000, kDay_us = 24 * 60 * kMinute_us;
constexpr std::int64_t kFetchingSilence_us = 2 * kMinute_us, kReadingSilence_us = 20 * kMinute_us;

core::Result<PacsImport> pacs_import_from(const Row& row) {
  PacsImport out;
  out.id = row.text(0);
  out.account_id = row.text(1);
  out.state = TRY(row.word<PacsImportState>(2, "pacs_imports.state"));
  out.files = row.count(3);
  out.size_bytes = row.count(4);
  out.error = row.text(5);
  out.volume_id = row.text_or_null(6);
  out.changed_utc_us = row.integer(7);
  return out;
}

bool is_left(const PacsImport& import, std::int64_t now_utc_us) {
  const std::int64_t silent_us = now_utc_us - import.changed_utc_us;
  return (import.state == PacsImportState::fetching && silent_us > kFetchingSilence_us) ||
         (import.state == PacsImportState::reading && silent_us > kReadingSilence_us);
}

}  // namespace

core::Result<void> add_pacs_import(Writing& tx, const PacsImport& import) {
  TRY(tx.query("delete from pacs_imports where changed_utc_us < ?",
               {import.changed_utc_us - kDay_us}));
  return done(tx.query(
      "insert into pacs_imports (id, account_id, state, files, size_bytes, error, volume_id, "
      "changed_utc_us) values (?, ?, ?, ?, ?, ?, ?, ?)",
      {import.id, import.account_id, name_value(import.state), count_value(import.files),
       count_value(import.size_bytes), import.error, text_or_null(import.volume_id.value_or("")),
       import.changed_utc_us}));
}

core::Result<void> change_pacs_import(Writing& tx, const PacsImport& import) {
  return done(tx.query(
      "update pacs_imports set state = ?, files = ?, size_bytes = ?, error = ?, volume_id = ?, "
      "changed_utc_us = ? where id = ?",
      {name_value(import.state), count_value(import.files), count_value(import.size_bytes),
       import.error, text_or_null(import.volume_id.value_or("")), import.changed_utc_us,
       import.id}));
}

core::Result<std::optional<PacsImport>> pacs_import_of(Reading& tx, const std::string& account_id,
                                                       const std::string& id,
                                                       std::int64_t now_utc_us) {
  auto found = TRY(one_of(
      tx.query("select id, account_id, state, files, size_bytes, error, volume_id, changed_utc_us "
               "from pacs_imports where id = ? and account_id = ?",
               {id, account_id}),
      pacs_import_from));
  if (found && is_left(*found, now_utc_us)) {
    found->state = PacsImportState::failed;
    found->error = "the server ended while it imported the series: import it again";
  }
  return found;
}

}  // namespace store
}  // namespace tractus
