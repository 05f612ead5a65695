/// Uploads of trials: announced, received in chunks, committed.
#pragma once

#include "core/bytes.hpp"
#include "server/api/route.hpp"
#include "wire/messages.hpp"

namespace tractus::api {

inline constexpr std::uint64_t kMaxTrial_bytes = 512ull << 20;
inline constexpr std::uint64_t kMaxTrialSamples =
    3'600'000;                                         ///< 15 minutes at 4 kHz, 490 MB decoded
inline constexpr std::uint64_t kMaxOpenUploads = 256;  ///< per station

/// All functions return not_found for an upload of another station, so that a station learns
/// nothing about other stations. The same announcement again gives the same upload. Errors:
/// conflict (another announcement with this id), not_found (no such case), too_large, unavailable
/// (the disk is full, or the station has too many unfinished uploads).
core::Result<wire::UploadState> announce_upload(Backend& backend, const Caller& station,
                                                const std::string& trial_id,
                                                const wire::UploadAnnouncement& announcement);
core::Result<wire::UploadState> upload_state(Backend& backend, const Caller& station,
                                             const std::string& trial_id);

struct Appended {
  wire::UploadState state;
  bool taken = false;  ///< false: another offset was expected, nothing was written
};
/// Appends the chunk that begins at `offset_bytes`. When the function returns, the bytes are
/// durable. Errors: corrupt (wrong checksum), out_of_range (more bytes than announced), conflict
/// (already complete), io.
core::Result<Appended> append_upload(Backend& backend, const Caller& station,
                                     const std::string& trial_id, std::uint64_t offset_bytes,
                                     std::uint32_t crc32c, core::ByteView bytes);

/// Checks size, SHA-256 and the whole trial file, and that its id and case equal the announcement;
/// then stores the trial, its file and the job that scores it atomically. A second call has no
/// effect. Errors: conflict (bytes are missing), corrupt or bad_input (not the announced file, or
/// not a complete trial: the upload then starts again at 0).
/// @param traceparent  of the job; empty: none
core::Result<wire::UploadState> commit_upload(Backend& backend, const Caller& station,
                                              const std::string& trial_id,
                                              const std::string& traceparent = {});

/// Free bytes on the disk on which trials are stored.
std::uint64_t free_bytes(const Backend& backend);
/// Checks that the disk has space for `size_bytes` more, besides the reserve for running work.
/// Errors: unavailable.
core::Result<void> check_disk(const Backend& backend, std::uint64_t size_bytes);
/// The same, besides the bytes that uploads of the last hour announced and have not sent yet (an
/// older upload is slow or abandoned). Thus a trial is refused before it begins rather than lost at
/// its end.
core::Result<void> check_room(Backend& backend, std::uint64_t size_bytes);
/// Space for a trial that is about to begin: ten minutes at 4 kHz with 160 B per sample.
inline constexpr std::uint64_t kTrialToCome_bytes = 384ull << 20;

/// Recovery at the start, after a crash: flushes the partial files, whose sizes are the offsets of
/// the uploads, and deletes files without an open upload. The commit later checks their contents
/// with the SHA-256 of the whole file.
core::Result<void> reconcile_uploads(Backend& backend);

}  // namespace tractus::api
