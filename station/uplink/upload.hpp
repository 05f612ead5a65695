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
core::Result<void> upload_trial(Server& server, const std::filesystem::path& trial_file,
                                OutboxEntry& entry, const core::Progress& progress = {},
                                const std::optional<ClockOffset>& offset = {});

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

/// Everything queued, oldest first, order kept: when the server does not answer, nothing younger
/// goes before. Waits between tries double. Nothing is ever deleted. Errors: io and bad_input of
/// the outbox, unauthorised. That the server does not answer is no Error but `waiting`.
/// @param tracer  each trial is a trace, with all its requests; null: none
core::Result<UploadReport> upload_all(Server& server, const Outbox& outbox,
                                      const std::filesystem::path& trials_folder,
                                      core::Clock& clock, const Patience& patience,
                                      const core::Progress& progress = {},
                                      const std::optional<ClockOffset>& offset = {},
                                      tracing::Tracer* tracer = nullptr);

}  // namespace tractus::uplink
