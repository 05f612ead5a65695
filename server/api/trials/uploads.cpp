#include "server/api/trials/uploads.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/people/erasure.hpp"
#include "db/store/studies/study_slots.hpp"
#include "db/store/trials/uploads.hpp"
#include "server/api/backend.hpp"
#include "server/api/trials/commit.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::uint64_t kReserve_bytes = 256ull
                                         << 20;  ///< left free for the database and running trials
constexpr std::int64_t kReserved_us = 3'600'000'000;  ///< for what an upload announced

}  // namespace

std::uint64_t free_bytes(const Backend& backend) {
  if (backend.free_bytes) return backend.free_bytes();
  std::error_code failure;
  const auto space = std::filesystem::space(backend.partials.folder(), failure);
  return failure ? std::numeric_limits<std::uint64_t>::max() : space.available;
}

core::Result<void> check_disk(const Backend& backend, std::uint64_t size_bytes) {
  const std::uint64_t free = free_bytes(backend);
  if (free >= size_bytes && free - size_bytes >= kReserve_bytes) return {};
  return core::Error{
      core::Errc::unavailable,
      fmt::format("the server's disk has {} free bytes: too few for another trial", free)};
}

namespace {

/// What was announced together nearly always fits; only where it does not, each file is looked at
/// for what it holds already.
core::Result<void> check_room_in(store::Reading& tx, const Backend& backend,
                                 std::uint64_t size_bytes) {
  const std::int64_t since_utc_us = backend.now_utc_us() - kReserved_us;
  const auto announced_bytes = TRY(store::open_upload_bytes_since(tx, since_utc_us));
  if (check_disk(backend, size_bytes + announced_bytes)) return {};
  auto open = TRY(store::open_uploads_since(tx, since_utc_us));
  for (const store::Upload& upload : open) {
    const std::uint64_t here = backend.partials.size_of(upload.trial_id);
    size_bytes += upload.size_bytes - std::min(here, upload.size_bytes);
  }
  return check_disk(backend, size_bytes);
}

}  // namespace

core::Result<void> check_room(Backend& backend, std::uint64_t size_bytes) {
  return backend.store.read(
      [&](store::Reading& tx) { return check_room_in(tx, backend, size_bytes); });
}

namespace {

/// The file is the truth: what it holds was flushed before it was acknowledged.
wire::UploadState state_of(const Backend& backend, const store::Upload& upload) {
  const bool complete = upload.state == store::UploadPhase::complete;
  return {complete ? upload.size_bytes : backend.partials.size_of(upload.trial_id), upload.state};
}

core::Error unknown(const std::string& trial_id) {
  return {core::Errc::not_found,
          fmt::format("upload {}: not announced by this station", trial_id.substr(0, 32))};
}

core::Result<store::Upload> own_upload(Backend& backend, const Caller& station,
                                       const std::string& trial_id) {
  if (!core::is_id(trial_id)) return unknown(trial_id);
  auto upload = TRY(backend.store.read(
      [&](store::Reading& tx) { return store::staying_upload_of(tx, trial_id); }));
  if (!upload || upload->station_id != station.id) return unknown(trial_id);
  return std::move(*upload);
}

/// An upload of this station while nobody else works on it. Another station's upload is not waited
/// for.
struct OwnUpload {
  std::unique_ptr<store::NamedLock> lock;
  store::Upload upload;
};
core::Result<OwnUpload> hold_own_upload(Backend& backend, const Caller& station,
                                        const std::string& trial_id) {
  if (!backend.upload_owners.knows(trial_id, station.id)) {
    TRY(own_upload(backend, station, trial_id));
    backend.upload_owners.note(trial_id, station.id);
  }
  auto held = TRY(store::hold_staying_upload(backend.store, trial_id));
  if (!held.upload || held.upload->station_id != station.id) return unknown(trial_id);
  return OwnUpload{std::move(held.lock), std::move(*held.upload)};
}

/// The case that an announcement means: one by its id, or that of a study's slot, which is all that
/// a station knows of it. A slot that was never handed to the station is as if it were not there.
core::Result<std::string> case_meant(store::Reading& tx, const Caller& station,
                                     const std::string& announced,
                                     std::optional<store::Slot>& slot) {
  const core::Error absent{core::Errc::not_found,
                           "case_id: no case " + announced + " on this server"};
  auto found = TRY(store::slot_of(tx, announced));
  slot = std::move(found);
  if (slot) {
    auto own = TRY(store::was_handed_to(tx, *slot, station.name));
    return own ? core::Result<std::string>(slot->case_id) : absent;
  }
  TRY(store::check_slot_stays(tx, announced));
  auto known = TRY(store::case_of(tx, announced));
  return known ? core::Result<std::string>(announced) : absent;
}

core::Result<void> insert(store::Writing& tx, const Backend& backend, const Caller& station,
                          const std::string& trial_id, const wire::UploadAnnouncement& announced) {
  TRY(check_room_in(tx, backend, announced.size_bytes));
  const std::int64_t now_utc_us = backend.now_utc_us();
  std::optional<store::Slot> slot;
  auto case_id = TRY(case_meant(tx, station, announced.case_id, slot));
  auto open = TRY(store::open_upload_count(tx, station.id));
  if (open >= kMaxOpenUploads)
    return core::Error{
        core::Errc::unavailable,
        fmt::format("{} uploads of this station are unfinished: finish some first", open)};
  const store::Upload upload{trial_id,         station.id,
                             case_id,          announced.size_bytes,
                             announced.sha256, store::UploadPhase::receiving};
  TRY(store::add_upload(tx, upload, now_utc_us));
  return slot ? store::announce_for_slot(tx, trial_id, slot->id, now_utc_us) : core::Result<void>();
}

/// Where the same upload stands; nothing when there is none of this id. Errors: not_found (another
/// station's), conflict (another announcement).
core::Result<std::optional<store::Upload>> announced_before(
    store::Reading& tx, const Caller& station, const std::string& trial_id,
    const wire::UploadAnnouncement& announced) {
  TRY(store::check_trial_stays(tx, trial_id));
  auto upload = store::upload_of(tx, trial_id);
  if (!upload) return upload.error();
  if (!*upload) return upload;
  const store::Upload& known = **upload;
  if (known.station_id != station.id) return unknown(trial_id);
  auto slot = TRY(store::slot_of_trial(tx, trial_id));
  const std::string& case_id = slot ? slot->id : known.case_id;
  if (case_id == announced.case_id && known.size_bytes == announced.size_bytes &&
      known.sha256 == announced.sha256)
    return upload;
  return core::Error{core::Errc::conflict,
                     fmt::format("trial {} was announced before with other data", trial_id)};
}

}  // namespace

core::Result<std::unique_ptr<store::NamedLock>> hold_upload(Backend& backend,
                                                            const std::string& trial_id) {
  return backend.store.hold(store::upload_lock(trial_id));
}

core::Result<wire::UploadState> announce_upload(Backend& backend, const Caller& station,
                                                const std::string& trial_id,
                                                const wire::UploadAnnouncement& announced) {
  if (!core::is_id(trial_id))
    return core::Error{core::Errc::bad_input, "trial_id: 32 hexadecimal characters are expected"};
  if (announced.size_bytes > kMaxTrial_bytes)
    return core::Error{core::Errc::too_large,
                       fmt::format("size_bytes: {} bytes, at most {} are allowed",
                                   announced.size_bytes, kMaxTrial_bytes)};
  const auto held = TRY(hold_upload(backend, trial_id));
  // What is known already changes nothing, and is no row of the audit trail.
  auto known = TRY(backend.store.read(
      [&](store::Reading& tx) { return announced_before(tx, station, trial_id, announced); }));
  if (known) return state_of(backend, *known);
  TRY(backend.store.write([&](store::Writing& tx) -> core::Result<void> {
    auto again = TRY(announced_before(tx, station, trial_id, announced));
    if (again) return {};
    return insert(tx, backend, station, trial_id, announced);
  }));
  return wire::UploadState{backend.partials.size_of(trial_id), store::UploadPhase::receiving};
}

core::Result<wire::UploadState> upload_state(Backend& backend, const Caller& station,
                                             const std::string& trial_id) {
  const auto held = TRY(hold_own_upload(backend, station, trial_id));  // no piece is half written
  return state_of(backend, held.upload);
}

core::Result<Appended> append_upload(Backend& backend, const Caller& station,
                                     const std::string& trial_id, std::uint64_t offset_bytes,
                                     std::uint32_t crc32c, core::ByteView bytes) {
  const auto held = TRY(hold_own_upload(backend, station, trial_id));
  const store::Upload& upload = held.upload;
  if (upload.state != store::UploadPhase::receiving)
    return core::Error{core::Errc::conflict, fmt::format("trial {} is complete", trial_id)};
  const std::uint64_t there = backend.partials.size_of(trial_id);
  if (offset_bytes != there) return Appended{{there, upload.state}, false};
  if (bytes.empty()) return core::Error{core::Errc::bad_input, "the chunk is empty"};
  if (bytes.size() > upload.size_bytes - std::min(there, upload.size_bytes))
    return core::Error{core::Errc::out_of_range,
                       fmt::format("{} bytes at offset {} exceed the announced size of {} bytes",
                                   bytes.size(), offset_bytes, upload.size_bytes)};
  if (core::crc32c(bytes) != crc32c)
    return core::Error{core::Errc::corrupt,
                       fmt::format("X-Crc32c: the body's checksum is {:08x}, not {:08x}",
                                   core::crc32c(bytes), crc32c)};
  TRY(backend.partials.append(trial_id, there, bytes));
  return Appended{{there + bytes.size(), upload.state}, true};
}

core::Result<wire::UploadState> commit_upload(Backend& backend, const Caller& station,
                                              const std::string& trial_id,
                                              const std::string& traceparent) {
  const auto held = TRY(hold_own_upload(backend, station, trial_id));
  const store::Upload& upload = held.upload;
  if (upload.state == store::UploadPhase::complete) return state_of(backend, upload);
  if (const std::uint64_t there = backend.partials.size_of(trial_id); there < upload.size_bytes)
    return core::Error{core::Errc::conflict,
                       fmt::format("the server has {} of {} bytes: send the rest first", there,
                                   upload.size_bytes)};
  auto trial = checked_trial(backend, upload);
  if (!trial) {
    const auto code = trial.error().code;
    if (code != core::Errc::corrupt && code != core::Errc::bad_input &&
        code != core::Errc::too_large)
      return trial.error();
    backend.partials.remove(trial_id);  // it begins again
    return trial.error();
  }
  TRY(store_trial(backend, upload, *trial, traceparent));
  backend.partials.remove(trial_id);
  backend.work_waits();
  return wire::UploadState{upload.size_bytes, store::UploadPhase::complete};
}

namespace {

/// Under its lock and by what the database says then: another server may be at it.
core::Result<void> reconcile_one(Backend& backend, const std::string& trial_id) {
  const auto held = TRY(hold_upload(backend, trial_id));
  auto upload =
      TRY(backend.store.read([&](store::Reading& tx) { return store::upload_of(tx, trial_id); }));
  if (upload && upload->state == store::UploadPhase::receiving)
    return backend.partials.flush(trial_id);
  return backend.partials.remove(trial_id), core::Result<void>();
}

}  // namespace

core::Result<void> reconcile_uploads(Backend& backend) {
  for (const std::string& id : backend.partials.ids()) TRY(reconcile_one(backend, id));
  return {};
}

}  // namespace api
}  // namespace tractus
