/// The narrow rows by which assignments are found, and the columns of an assignment.
#pragma once

#include "db/store/studies/assignments.hpp"

namespace tractus::store {

/// Due time of an assignment without one, in the list: the year 2255, behind every other.
inline constexpr std::int64_t kNeverDue_utc_us = 9'000'000'000'000'000;

/// Columns as assignment_from reads them, the first of them the id; the one placeholder six times: whose trials are
/// counted (empty: all).
extern const char* const kAssignment;
/// SQL, true of an assignment `a` that a filter reaches. Placeholders: led_by three times, done_by twice.
extern const char* const kAssignmentReached;
core::Result<Assignment> assignment_from(const Row& row);

/// Puts an assignment into the list.
core::Result<void> add_assignment_entry(Writing& tx, const std::string& study_id);
/// Notes in the list whether the participant, and the whole assignment, still has trials to do. To be called when a
/// slot was added, recorded or closed; of a study of research nothing changes.
core::Result<void> note_progress(Writing& tx, const std::string& series_id,
                                 const std::string& participant);

}  // namespace tractus::store
