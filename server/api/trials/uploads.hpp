/// Trials on their way in: announced, received in pieces, committed.
#pragma once

#include "core/bytes.hpp"
#include "server/api/route.hpp"
#include "wire/messages.hpp"

namespace tractus::api {

inline constexpr std::uint64_t kMaxTrial_bytes = 512ull << 20;
inline constexpr std::uint64_t kMaxTrialSamples =
    3'600'000;                                         ///< 15 minutes at 4 kHz, 490 MB decoded
inline constexpr std::uint64_t kMaxOpenUploads = 256;  ///< of one station

/// All answer not_found for an upload that another station announced: one station learns nothing of
/// another. The same announcement again is the same upload. Errors: conflict (a different one under
/// this id), not_found (no such case), too_large, unavailable (the disk is full, or the station
/// leaves too many unfinished).
core::Result<wire::UploadState> announce_upload(Backend& backend, const Caller& station,
                                                const std::string& trial_id,
                                                const wire::UploadAnnouncement& announcement);
core::Result<wire::UploadState> upload_state(Backend& backend, const Caller& station,
                                             const std::string& trial_id);

struct Appended {
  wire::UploadState state;
  bool taken =
      false;  ///< false: `offset_bytes` was not where the upload stands, nothing was written
};
/// Takes the piece that begins at `offset_bytes`. When it returns, the bytes are on the disk.
/// Errors: corrupt (the checksum is not theirs), out_of_range (more than announced), conflict
/// (complete already), io.
core::Result<Appended> append_upload(Backend& backend, const Caller& station,
                                     const std::string& trial_id, std::uint64_t offset_bytes,
                                     std::uint32_t crc32c, core::ByteView bytes);

/// Checks size, SHA-256 and the whole trial file, and that its id and case are those announced;
/// then the trial, its file and the job that scores it are there together, or none is. Repeating it
/// is harmless. Errors: conflict (bytes are missing), corrupt or bad_input (not the announced file,
/// or not a whole trial: the upload then begins again at 0).
core::Result<wire::UploadState> commit_upload(Backend& backend, const Caller& station,
                                              const std::string& trial_id);

/// Left on the disk that trials go to.
std::uint64_t free_bytes(const Backend& backend);
/// Is there room for `size_bytes` more, with the reserve for what is already running? Errors:
/// unavailable.
core::Result<void> check_disk(const Backend& backend, std::uint64_t size_bytes);
/// The same beside what uploads of the last hour announced and have not sent yet (an older one is
/// slow or abandoned). A trial is refused before it begins rather than lost when it ends.
core::Result<void> check_room(Backend& backend, std::uint64_t size_bytes);
/// What a trial that is about to begin may need: ten minutes at 4 kHz of 160 B.
inline constexpr std::uint64_t kTrialToCome_bytes = 384ull << 20;

/// For the start, after a crash: what partial files hold is flushed, for they say from now on how
/// much of an upload is here; files that belong to no open upload go. Whether they hold what they
/// should, the commit finds by the SHA-256 of the whole.
core::Result<void> reconcile_uploads(Backend& backend);

}  // namespace tractus::api
