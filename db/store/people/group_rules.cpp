#include "db/store/people/group_rules.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {
core::Result<GroupRuleVersion> group_rule_from(const Row& row) {
  return GroupRuleVersion{row.integer(0), row.text(1), row.text(2), row.integer(3), row.text(4)};
}
}  // namespace

core::Result<void> add_group_rule(Writing& tx, const GroupRuleVersion& rule) {
  const auto before = TRY(group_rules(tx));
  return done(tx.query(
      "insert into group_rules (version, definition, reason, made_utc_us, made_by) values (?, ?, "
      "?, ?, ?)",
      {before.empty() ? std::int64_t{1} : before.front().version + 1, rule.definition, rule.reason,
       rule.made_utc_us, rule.made_by}));
}

core::Result<std::vector<GroupRuleVersion>> group_rules(Reading& tx) {
  return all_of(tx.query("select version, definition, reason, made_utc_us, made_by from "
                         "group_rules order by version desc"),
                group_rule_from);
}

core::Result<void> set_group_account(Writing& tx, const GroupAccount& account) {
  TRY(tx.query("delete from group_accounts where account_id = ?", {account.account_id}));
  return done(tx.query(
      "insert into group_accounts (account_id, version, seen_utc_us, left_utc_us) values (?, ?, ?, "
      "?)",
      {account.account_id, account.version, account.seen_utc_us, or_null(account.left_utc_us)}));
}

core::Result<std::optional<GroupAccount>> group_account(Reading& tx,
                                                        const std::string& account_id) {
  const auto rows =
      TRY(tx.query("select account_id, version, seen_utc_us, left_utc_us from group_accounts where "
                   "account_id = ?",
                   {account_id}));
  if (rows.empty()) return std::optional<GroupAccount>();
  const Row& row = rows.front();
  GroupAccount out{row.text(0), row.integer(1), row.integer(2), {}};
  if (const auto* left = std::get_if<std::int64_t>(&row.value(3))) out.left_utc_us = *left;
  return std::optional<GroupAccount>(out);
}

}  // namespace store
}  // namespace tractus
