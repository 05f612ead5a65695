/// Imports of series from a PACS: progress and result, for the person who began each.
#pragma once

#include "core/named.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

enum class PacsImportState {
  fetching,  ///< files come from the PACS
  reading,   ///< the files are being de-identified and made a volume
  done,
  failed,
};
constexpr auto words(PacsImportState) {
  using enum PacsImportState;
  return std::to_array<core::Word<PacsImportState>>(
      {{fetching, "fetching"}, {reading, "reading"}, {done, "done"}, {failed, "failed"}});
}

struct PacsImport {
  std::string id, account_id;
  PacsImportState state = PacsImportState::fetching;
  std::uint64_t files = 0, size_bytes = 0;    ///< that have come
  std::string error = {};                     ///< reason for the failure, one line
  std::optional<std::string> volume_id = {};  ///< once it is done
  std::int64_t changed_utc_us = 0;
};

/// Also deletes those that were last changed more than a day ago.
core::Result<void> add_pacs_import(Writing& tx, const PacsImport& import);
/// Writes state, counts, error, volume and time of change.
core::Result<void> change_pacs_import(Writing& tx, const PacsImport& import);
/// Nothing for that of another account. One that its server no longer works on has failed: it was
/// not changed for two minutes while files came, or for twenty while they were read.
core::Result<std::optional<PacsImport>> pacs_import_of(Reading& tx, const std::string& account_id,
                                                       const std::string& id,
                                                       std::int64_t now_utc_us);

}  // namespace tractus::store
