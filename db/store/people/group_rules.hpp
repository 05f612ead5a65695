/// Rules from an identity provider's groups to roles and cohorts, and the accounts that they made.
#pragma once

#include <optional>
#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct GroupRuleVersion {
  std::int64_t version = 0;  ///< from 1; filled on reading
  std::string definition;    ///< JSON, tractus-groups/1
  std::string reason;
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

/// An account that a rule made and keeps.
struct GroupAccount {
  std::string account_id;
  std::int64_t version = 0;                      ///< of the rule that last decided
  std::int64_t seen_utc_us = 0;                  ///< the provider last vouched for the person
  std::optional<std::int64_t> left_utc_us = {};  ///< disabled by the rule since then
};

/// As the next version.
core::Result<void> add_group_rule(Writing& tx, const GroupRuleVersion& rule);
/// The newest first.
core::Result<std::vector<GroupRuleVersion>> group_rules(Reading& tx);
core::Result<void> set_group_account(Writing& tx, const GroupAccount& account);
/// Nothing: no rule made the account.
core::Result<std::optional<GroupAccount>> group_account(Reading& tx, const std::string& account_id);

}  // namespace tractus::store
