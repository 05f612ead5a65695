/// Debriefing: comments of faculty on a trial, and trials that are offered as examples.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct Comment {
  std::string id;
  std::string trial_id;
  std::optional<double> at_s;  ///< moment of the trial; nothing: the whole trial
  std::string text;
  std::string by_id;  ///< of the account
  std::string by_name;
  std::int64_t made_utc_us = 0;
};

core::Result<void> add_comment(Writing& tx, const Comment& comment);
/// Comments on the whole trial first, then sorted by moment.
core::Result<std::vector<Comment>> comments_of(Reading& tx, const std::string& trial_id);
/// Errors: not_found if this account has no such comment on the trial.
core::Result<void> remove_comment(Writing& tx, const std::string& trial_id, const std::string& id,
                                  const std::string& by_id);

/// A trial that is offered as an example on its case.
struct ReferenceTrial {
  std::string trial_id;
  std::string operator_name;
  std::int64_t started_utc_us = 0;
  double duration_s = 0.0;
  bool simulated = false;
};

/// Offers the trial as an example, or withdraws it; a second call changes nothing. Errors:
/// not_found.
core::Result<void> set_reference(Writing& tx, const std::string& trial_id, bool reference,
                                 const std::string& who, std::int64_t now_utc_us);
core::Result<bool> is_reference(Reading& tx, const std::string& trial_id);
/// The examples on the trial's case, without the trial itself, newest first.
core::Result<std::vector<ReferenceTrial>> references_for(Reading& tx, const std::string& trial_id);

}  // namespace tractus::store
