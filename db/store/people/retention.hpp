/// How long people's data are kept: rules that a director sets, notices before they act.
#pragma once

#include "db/store/people/erasure.hpp"

namespace tractus::store {

struct RetentionRules {
  std::optional<long> inactive_years =
      {};  ///< trainees without activity for so long; none: the rule is off
  ErasureMode inactive_mode = ErasureMode::anonymise;
  std::optional<long> sign_ins_months =
      {};                 ///< records of sign-ins older than this are removed; none: off
  long notice_days = 30;  ///< between the notice and the act

  /// tractus-retention/1
  std::string text() const;
  static core::Result<RetentionRules> from_text(const std::string& text, const std::string& where);
};

struct RetentionVersion {
  std::int64_t version = 0;
  RetentionRules rules = {};
  std::string reason = {};
  std::int64_t made_utc_us = 0;
  std::string made_by = {};
};
/// Adds the next version, and removes the notices of the one before; `version` is not taken.
core::Result<void> add_retention_rules(Writing& tx, const RetentionVersion& of);
/// Newest first; none: no rule was ever set, and none acts.
core::Result<std::vector<RetentionVersion>> retention_versions(Reading& tx);

/// A trainee on whom the rules act, or will.
struct InactivePerson {
  std::string account_id = {}, name = {};
  std::int64_t last_utc_us = 0;  ///< last sign-in, request or trial
  std::optional<std::int64_t> acts_utc_us =
      {};  ///< when the notice period is over; none: no notice yet
};
/// Trainees without activity since `before_utc_us`, by name.
core::Result<std::vector<InactivePerson>> inactive_people(Reading& tx, std::int64_t before_utc_us);
/// Number of networks of sign-ins that were last seen before a time, and of rows of the trail about sign-ins.
core::Result<std::uint64_t> old_sign_ins(Reading& tx, std::int64_t before_utc_us);

/// Moments that the rules mean, at a time.
std::int64_t inactive_before(const RetentionRules& rules, std::int64_t now_utc_us);
std::int64_t sign_ins_before(const RetentionRules& rules, std::int64_t now_utc_us);

/// One pass: notices for those who became inactive, none for those who came back, begin_erasure for those whose notice period is
/// over, and old sign-ins. Returns the accounts whose erasure it began.
core::Result<std::vector<std::string>> keep_retention(Store& store, std::int64_t now_utc_us);

}  // namespace tractus::store
