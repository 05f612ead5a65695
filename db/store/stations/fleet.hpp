/// Stored data of stations: the last state of each station, its reports, its clock, and the person
/// of the trial that it runs.
#pragma once

#include <set>
#include <vector>

#include "core/named.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

/// JSON as the station sent it (wire::StationStatus).
struct StationLast {
  std::string station_id;
  std::int64_t seen_utc_us = 0;
  std::string told;
};
core::Result<void> set_station_last(Writing& tx, const StationLast& last);
core::Result<std::vector<StationLast>> stations_last(Reading& tx);

enum class NoteKind { self_test, calibration };
constexpr auto words(NoteKind) {
  using enum NoteKind;
  return std::to_array<core::Word<NoteKind>>(
      {{self_test, "self_test"}, {calibration, "calibration"}});
}

/// One self-test or calibration, JSON as reported.
struct StationNote {
  std::string station_id;
  NoteKind kind = NoteKind::self_test;
  std::int64_t at_utc_us = 0;
  std::string body;
};
/// The same (station, kind, time) again changes nothing. Errors: unavailable after kMostNotesADay
/// reports of this station within a day.
core::Result<void> add_station_note(Writing& tx, const StationNote& note, std::int64_t now_utc_us);
inline constexpr std::int64_t kMostNotesADay = 200;
/// Newest first, at most `limit`.
core::Result<std::vector<StationNote>> station_notes(Reading& tx, const std::string& station_id,
                                                     NoteKind kind, std::int64_t limit);

/// The station's clock compared with the server's clock at the upload of a trial.
struct TrialClock {
  double offset_s = 0.0;  ///< server's clock minus the station's clock
  double error_s = 0.0;   ///< bound of the error of offset_s
};
/// Stores the clock of a trial; an existing one stays unchanged.
core::Result<void> add_trial_clock(Writing& tx, const std::string& trial_id,
                                   const TrialClock& clock);
core::Result<std::optional<TrialClock>> trial_clock_of(Reading& tx, const std::string& trial_id);

/// Database facts about the trial that a station runs. Nothing for a slot of another station, and
/// for an unknown case.
struct ShownTrial {
  std::optional<std::string> case_title;  ///< blind name for an assigned case
  std::optional<std::string> person;      ///< name; for a study participant the pseudonym
  std::string account_id;                 ///< account of the person; empty: none
  std::set<std::string> teachers;         ///< accounts that lead a cohort of the person
};
core::Result<ShownTrial> shown_trial(Reading& tx, const std::string& station_id,
                                     const std::string& case_id);

}  // namespace tractus::store
