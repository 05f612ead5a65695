/// Handing trials over: resumable, and each exactly once.
#pragma once

#include <functional>

#include "core/clock.hpp"
#include "core/progress.hpp"
#include "station/uplink/clock_offset.hpp"
#include "station/uplink/outbox.hpp"
#include "station/uplink/server.hpp"
#include "tracing/tracer.hpp"

namespace tractus::uplink {

/// One trial, from wherever the server says it stands: announce → chunks, each with its CRC-32C →
/// commit. `entry` follows what the server acknowledged. May be repeated at will: a trial that the
/// server holds is not sent again. Errors: the server's, unavailable, corrupt (the file is not what
/// was queued).
/// @param offset  this station's clock, noted with the trial
/// @param may_commit  asked once the server has every piece; false: the trial waits (cancelled)
core::Result<void> upload_trial(Server& server, const std::filesystem::path& trial_file,
                                OutboxEntry& entry, const core::Progress& progress = {},
                                const std::optional<ClockOffset>& offset = {},
                                const std::function<bool()>& may_commit = {});

struct UploadReport {
  int handed_over = 0;  ///< now
  int refused = 0;      ///< by the server, for good; the trials stay where they are
  int waiting = 0;      ///< not handed over yet
  std::string why;      ///< of waiting, one line

  core::Json to_json() const;
};

struct Patience {
  core::Instant_ns first_wait_ns = 1'000'000'000;
  core::Instant_ns longest_wait_ns = 60'000'000'000;
  core::Instant_ns give_up_after_ns = 0;  ///< since the last progress; 0: at the first failure
};

/// How many trials of a backlog are on their way at a time, as many as a server has threads for
/// requests: while one is committed, which waits for the disk, others send their pieces (ADR-0065).
inline constexpr std::size_t kUploadConnections = 4;

/// Everything queued, oldest first, order kept: when the server does not answer, nothing younger
/// is committed before. Waits between tries double. Nothing is ever deleted. Errors: io and
/// bad_input of the outbox, unauthorised. That the server does not answer is no Error but
/// `waiting`.
/// @param connections  to the same server, at least one: as many trials send their pieces at a
///                     time; each is committed after all older ones
/// @param progress  called by one thread at a time, of several
/// @param tracer  each trial is a trace, with all its requests; null: none
core::Result<UploadReport> upload_all(const std::vector<Server*>& connections, const Outbox& outbox,
                                      const std::filesystem::path& trials_folder,
                                      core::Clock& clock, const Patience& patience,
                                      const core::Progress& progress = {},
                                      const std::optional<ClockOffset>& offset = {},
                                      tracing::Tracer* tracer = nullptr);

}  // namespace tractus::uplink
