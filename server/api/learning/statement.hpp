/// Statements of trials to a learning record store (xAPI 1.0.3, ADL's vocabulary of verbs).
#pragma once

#include <chrono>

#include "core/json.hpp"
#include "db/store/cohort/released.hpp"
#include "db/store/learning/record_stores.hpp"
#include "server/http/networks.hpp"

namespace tractus::api {

/// What one statement is of: a released trial, which has a pseudonym and no name.
struct StatedTrial {
  std::string id;     ///< of the delivery, 32 hexadecimal characters
  std::string base;   ///< "https://host:8480", of this server
  std::string title;  ///< of the assignment
  std::string assignment_id;
  store::ReleasedTrial trial;
};
/// A statement "who passed (failed, completed) what", with the score 1 for a right answer and 0 for a
/// wrong one. Equal for equal input, so that a store recognises one that is sent again. Its
/// timestamp is the day of the trial: released trials have no time of day.
core::Json statement_json(const StatedTrial& what);

/// The trial as it is released (released.hpp); none if the person does not consent to the tier
/// metrics any more, or the trial is blinded. Errors: unavailable without a key of pseudonyms.
core::Result<std::optional<store::ReleasedTrial>> released_trial(
    store::Reading& tx, const store::StatementTrial& which,
    const std::optional<std::array<std::byte, 32>>& pseudonym_key);

struct StatementCall {
  store::RecordStore to;  ///< with its secret opened
  core::Json statement;
  http::Networks networks = {};                ///< private networks that may be called
  std::chrono::milliseconds patience{10'000};  ///< time limit from the start to the last byte
};
/// Errors: unavailable (try again), bad_input (refused for good: 400, 409, 413).
core::Result<void> post_statement(const StatementCall& call);

}  // namespace tractus::api
