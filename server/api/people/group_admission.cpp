#include "server/api/people/group_admission.hpp"

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/people/group_rules.hpp"
#include "db/store/people/people.hpp"
#include "db/store/people/subjects.hpp"
#include "server/api/people/people_json.hpp"
#include "server/api/studies/assignment_plan.hpp"

namespace tractus {
namespace api {
namespace {
using core::Errc;
using core::Error;
using core::Result;
using store::Account;
using store::AccountState;
using store::GroupAccount;

constexpr const char* kByRule = "group rule";
constexpr std::int64_t kDay_in_us = 86'400'000'000;

/// What the steps of one admission share.
struct Deciding {
  store::Writing& tx;
  const GroupRule& rule;
  std::int64_t version;
  const Admission& admission;

  store::AuditStamp stamp() const { return {kByRule, admission.now_utc_us}; }
};

Result<Account> made_account(const Deciding& of, const GroupGrant& grant) {
  const std::string& name = of.admission.identity.name;
  if (name.empty())
    return Error{Errc::unauthorised,
                 "the provider gives no name (name or preferred_username) for a new account"};
  const auto taken = TRY(store::account_named(of.tx, name));
  if (taken)
    return Error{Errc::conflict,
                 "an account has the name " + name + ": an administrator links it with the person"};
  Account account{.id = core::new_id(), .name = name, .role = grant.role, .password_hash = ""};
  account.pseudonym = new_pseudonym();
  account.level = grant.level;
  account.made_utc_us = of.admission.now_utc_us;
  TRY(store::add_account(of.tx, account, of.admission.now_utc_us));
  TRY(store::link_subject(of.tx, {of.admission.issuer, of.admission.identity.subject, account.id,
                                  of.admission.now_utc_us, kByRule}));
  return account;
}

/// Cohorts that no line names are somebody else's word.
Result<void> set_cohorts(const Deciding& of, const Account& account, const GroupGrant& grant) {
  for (const std::string& cohort : of.rule.cohorts()) {
    const auto known = TRY(store::cohort_of(of.tx, cohort));
    if (!known) continue;  // removed since the rule was written
    const auto is_in = TRY(store::is_in_cohort(of.tx, account.id, cohort));
    const bool belongs = grant.cohorts.contains(cohort);
    if (belongs && !is_in) TRY(join_cohort(of.tx, cohort, account, of.stamp()));
    if (!belongs && is_in) TRY(store::take_from_cohort(of.tx, cohort, account.id));
  }
  return {};
}

Result<void> keep(const Deciding& of, Account account, const GroupGrant& grant) {
  const bool role_changes = account.role != grant.role;
  account.state = AccountState::active;
  account.role = grant.role;
  if (!grant.level.empty()) account.level = grant.level;
  TRY(store::set_account(of.tx, account));
  if (role_changes) TRY(store::remove_sessions_of(of.tx, account.id, ""));
  TRY(set_cohorts(of, account, grant));
  return store::set_group_account(of.tx,
                                  {account.id, of.version, of.admission.now_utc_us, std::nullopt});
}

Result<void> disable(store::Writing& tx, Account account, GroupAccount kept,
                     std::int64_t now_utc_us) {
  account.state = AccountState::disabled;
  TRY(store::set_account(tx, account));
  TRY(store::remove_sessions_of(tx, account.id, ""));
  kept.left_utc_us = now_utc_us;
  return store::set_group_account(tx, kept);
}

Result<void> decide(const Deciding& of) {
  const auto grant = of.rule.grant(of.admission.identity.groups);
  auto account =
      TRY(store::account_of_subject(of.tx, of.admission.issuer, of.admission.identity.subject));
  if (!account) {
    if (!grant) return {};
    auto made = TRY(made_account(of, *grant));
    return keep(of, std::move(made), *grant);
  }
  const auto kept = TRY(store::group_account(of.tx, account->id));
  if (!kept || account->role == Role::admin) return {};
  const bool by_hand = account->state == AccountState::disabled && !kept->left_utc_us;
  if (by_hand) return {};
  if (grant) return keep(of, std::move(*account), *grant);
  if (kept->left_utc_us) return {};
  return disable(of.tx, std::move(*account), *kept, of.admission.now_utc_us);
}

Result<GroupRule> rule_from(const store::GroupRuleVersion& version) {
  auto rule = GroupRule::from_json(core::stored_json(version.definition), "group rule");
  if (!rule) return Error{Errc::corrupt, rule.error().what};
  return rule;
}
}  // namespace

Result<std::optional<GroupRule>> current_group_rule(store::Reading& tx) {
  const auto versions = TRY(store::group_rules(tx));
  if (versions.empty()) return std::optional<GroupRule>();
  auto rule = TRY(rule_from(versions.front()));
  return std::optional<GroupRule>(std::move(rule));
}

Result<void> admit_by_groups(store::Writing& tx, const Admission& admission) {
  const auto versions = TRY(store::group_rules(tx));
  if (versions.empty()) return {};
  const auto rule = TRY(rule_from(versions.front()));
  return decide({tx, rule, versions.front().version, admission});
}

Result<bool> is_absent(store::Reading& tx, const Account& account, std::int64_t now_utc_us) {
  const auto rule = TRY(current_group_rule(tx));
  if (!rule || !rule->absent_days || account.state != AccountState::active) return false;
  const auto kept = TRY(store::group_account(tx, account.id));
  return kept && now_utc_us - kept->seen_utc_us > *rule->absent_days * kDay_in_us;
}

Result<void> disable_absent(store::Writing& tx, const Account& account, std::int64_t now_utc_us) {
  const auto still = TRY(is_absent(tx, account, now_utc_us));
  if (!still) return {};
  const auto kept = TRY(store::group_account(tx, account.id));
  return disable(tx, account, *kept, now_utc_us);
}

}  // namespace api
}  // namespace tractus
