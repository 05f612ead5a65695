#include "server/api/trials/commit.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/people/erasure.hpp"
#include "db/store/studies/study_slots.hpp"
#include "server/api/trials/uploads.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace api {
namespace {

/// What the samples tell in passing.
struct TrialTally {
  trial::TickCounts ticks;
  double first_s = 0.0, last_s = 0.0;
  std::uint32_t first_tick = 0;  ///< those before it are not skipped: nobody recorded them

  void add(const trial::Block& part) {
    bool first = ticks.samples == 0;
    part.each([&](const auto& sample) {
      if (first) {
        first_s = sample.t_s;
        first_tick = sample.tick;
      }
      first = false;
      last_s = sample.t_s;
    });
    ticks.add(part);
  }
  std::uint64_t skipped() const { return ticks.skipped - first_tick; }
};

/// The message without the path of our disk: it goes to the station.
core::Error without_path(core::Error error, const std::filesystem::path& path) {
  const std::string name = path.string();
  if (const auto at = error.what.find(name); at != std::string::npos)
    error.what.replace(at, name.size(), "trial file");
  return error;
}

core::Result<void> check_bytes(const store::PartialFiles& partials, const store::Upload& upload) {
  const std::filesystem::path path = partials.path_of(upload.trial_id);
  if (partials.size_of(upload.trial_id) != upload.size_bytes)
    return core::Error{
        core::Errc::corrupt,
        fmt::format("trial file: its size is not the announced {} bytes", upload.size_bytes)};
  auto sha256 = TRY(store::file_sha256(path));
  if (sha256 != upload.sha256)
    return core::Error{
        core::Errc::corrupt,
        fmt::format("sha256: the {} received bytes have the SHA-256 {}, but {} was announced",
                    upload.size_bytes, sha256, upload.sha256)};
  return {};
}

/// What the announcement promised of the file.
struct Promised {
  std::string case_id;                     ///< what the station knows the case by
  trial::Rig rig = trial::Rig::palpation;  ///< of the case
};

core::Result<Promised> promised(store::Reading& tx, const store::Upload& upload) {
  auto slot = TRY(store::slot_of_trial(tx, upload.trial_id));
  auto known = TRY(store::case_of(tx, upload.case_id));
  core::require(known.has_value(), "an upload has its case");
  return Promised{slot ? slot->id : upload.case_id, known->kind};
}

core::Result<void> check_identity(const store::Upload& upload, const Promised& promised,
                                  const trial::Trial& trial, const TrialTally& tally) {
  if (!trial.sealed)
    return core::Error{core::Errc::bad_input,
                       "trial file: the file has no end; run tractus trial recover first"};
  if (trial.header.id != upload.trial_id)
    return core::Error{core::Errc::bad_input,
                       fmt::format("trial file: its id is {}, but {} was announced",
                                   trial.header.id, upload.trial_id)};
  if (trial.header.case_id != promised.case_id)
    return core::Error{core::Errc::bad_input,
                       fmt::format("trial file: its case is {}, but {} was announced",
                                   trial.header.case_id, promised.case_id)};
  if (trial.header.rig != promised.rig)
    return core::Error{core::Errc::bad_input,
                       fmt::format("trial file: the trial is for {}, but its case is for {}",
                                   trial::name(trial.header.rig), trial::name(promised.rig))};
  if (tally.ticks.samples == 0)
    return core::Error{core::Errc::bad_input, "trial file: it has no samples"};
  return {};
}

/// With what it was done, as the header says.
store::Tool tool_of(const store::TrialRecord& trial) {
  const core::Json header = core::stored_json(trial.header);
  const core::Json extra = header.value("extra", core::Json::object());
  const auto drilled = extra.find("drilled");
  const bool felt = drilled != extra.end() && drilled->is_string();
  return {.burr = extra.contains("drilling"), .drilled = felt ? drilled->get<std::string>() : ""};
}

std::string events_text(const std::vector<trial::Event>& events) {
  core::Json out = core::Json::array();
  for (const trial::Event& event : events)
    out.push_back({{"t_s", event.t_s}, {"kind", event.kind}, {"detail", event.detail}});
  return out.dump();
}

store::TrialRecord record_of(const store::Upload& upload, const trial::Trial& trial,
                             const TrialTally& tally) {
  store::TrialRecord out;
  out.summary.id = upload.trial_id;
  out.summary.case_id = upload.case_id;
  out.summary.operator_name = trial.header.operator_name;
  out.summary.simulated = trial.header.simulated;
  out.summary.started_utc_us = trial.header.started_utc_us;
  out.summary.duration_s = tally.last_s - tally.first_s;
  out.summary.samples = tally.ticks.samples;
  out.station_id = upload.station_id;
  out.sha256 = upload.sha256;
  out.complete = trial.complete;
  out.late_ticks = tally.ticks.late;
  out.not_converged = tally.ticks.not_converged;
  out.skipped_ticks = tally.skipped();
  out.header = trial.header.to_json().dump();
  out.events = events_text(trial.events);
  return out;
}

}  // namespace

core::Result<store::TrialRecord> checked_trial(Backend& backend, const store::Upload& upload) {
  const auto path = backend.partials.path_of(upload.trial_id);
  if (auto fine = check_bytes(backend.partials, upload); !fine)
    return without_path(fine.error(), path);
  TrialTally tally;
  auto trial = trial::scan_trial(path, [&](const trial::Block& part) { tally.add(part); },
                                 {.max_samples = kMaxTrialSamples, .max_bytes = kMaxTrial_bytes});
  if (!trial) return without_path(trial.error(), path);
  auto expected = TRY(backend.store.read([&](store::Reading& tx) { return promised(tx, upload); }));
  TRY(check_identity(upload, expected, *trial, tally));
  return record_of(upload, *trial, tally);
}

core::Result<void> store_trial(Backend& backend, const store::Upload& upload,
                               const store::TrialRecord& trial, const std::string& traceparent) {
  if (auto linked =
          backend.objects.link_in(backend.partials.path_of(upload.trial_id), upload.sha256);
      !linked)
    return linked;
  const std::int64_t now = backend.now_utc_us();
  return backend.store.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::check_trial_stays(tx, upload.trial_id));  // its person may have left meanwhile
    TRY(store::add_object(tx, upload.sha256, upload.size_bytes, now));
    TRY(store::add_trial(tx, trial, now));
    TRY(store::complete_upload(tx, upload.trial_id));
    auto station = TRY(store::station_name(tx, upload.station_id));
    TRY(store::record_for_slot(tx, upload.trial_id, trial.complete, {station, now},
                               tool_of(trial)));
    return store::queue_job(tx, store::JobKind::metrics, upload.trial_id, now, traceparent);
  });
}

}  // namespace api
}  // namespace tractus
