/// Uploads under way: what a station announced, and how much of it is safely on the disk.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace store {

struct Upload {
  std::string trial_id;
  std::string station_id;
  std::string case_id;
  std::uint64_t size_bytes = 0;
  std::string sha256;
  std::uint64_t offset_bytes = 0;  ///< acknowledged: flushed to the disk before this was written
  std::uint32_t crc32c = 0;        ///< of those bytes
  std::string state;               ///< "receiving" or "complete"
};

core::Result<std::optional<Upload>> upload_of(Reading& tx, const std::string& trial_id);
/// All that are still receiving.
core::Result<std::vector<Upload>> open_uploads(Reading& tx);
core::Result<std::uint64_t> open_upload_count(Reading& tx, const std::string& station_id);
core::Result<void> add_upload(Writing& tx, const Upload& upload, std::int64_t now_utc_us);
/// So many bytes from the start of the file are on the disk now, `before` of them already then.
/// Right beside other writes (Store::write_beside). Errors: conflict when `before` is not what is
/// there: another process took over meanwhile.
core::Result<void> set_upload_offset(Writing& tx, const std::string& trial_id, std::uint64_t before,
                                     std::uint64_t offset_bytes, std::uint32_t crc32c);
core::Result<void> complete_upload(Writing& tx, const std::string& trial_id);

}  // namespace store
