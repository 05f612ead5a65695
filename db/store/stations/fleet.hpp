/// What is kept of stations at work: what each last said of itself, its reports, its clock, and who
/// is at the trial that it shows.
#pragma once

#include <set>
#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

/// JSON as the station told it (wire::StationStatus).
struct StationLast {
  std::string station_id;
  std::int64_t seen_utc_us = 0;
  std::string told;
};
core::Result<void> set_station_last(Writing& tx, const StationLast& last);
core::Result<std::vector<StationLast>> stations_last(Reading& tx);

/// One self-test or calibration, JSON as reported.
struct StationNote {
  std::string station_id;
  std::string kind;  ///< "self_test", "calibration"
  std::int64_t at_utc_us = 0;
  std::string body;
};
/// The same (station, kind, time) again changes nothing. Errors: unavailable once kMostNotesADay
/// came from this station within a day.
core::Result<void> add_station_note(Writing& tx, const StationNote& note, std::int64_t now_utc_us);
inline constexpr std::int64_t kMostNotesADay = 200;
/// Newest first, at most `limit`.
core::Result<std::vector<StationNote>> station_notes(Reading& tx, const std::string& station_id,
                                                     const std::string& kind, std::int64_t limit);

/// A station's clock against the server's when it handed a trial over.
struct TrialClock {
  double offset_s = 0.0;  ///< server's less the station's
  double error_s = 0.0;   ///< bound
};
/// The first one stays.
core::Result<void> add_trial_clock(Writing& tx, const std::string& trial_id,
                                   const TrialClock& clock);
core::Result<std::optional<TrialClock>> trial_clock_of(Reading& tx, const std::string& trial_id);

/// What the database says of a trial that a station shows. Of a slot that another station has, and
/// of a case that is not known: nothing.
struct ShownTrial {
  std::optional<std::string>
      case_title;                     ///< of a palpation case; of an assigned one its blind name
  std::optional<std::string> person;  ///< name; of a study's participant the pseudonym
  std::string account_id;             ///< of the person; empty: no account of ours
  std::set<std::string> teachers;     ///< accounts that lead a cohort of the person
};
core::Result<ShownTrial> shown_trial(Reading& tx, const std::string& station_id,
                                     const std::string& case_id);

}  // namespace tractus::store
