#include "db/store/people/retention.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/json.hpp"
#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

using core::Json;
using core::Result;

constexpr const char* kRetentionFormat = "tractus-retention/1";
constexpr std::int64_t kDayOfRetention_us = 86'400'000'000;
constexpr std::int64_t kYear_us = 365 * kDayOfRetention_us + kDayOfRetention_us / 4;
constexpr std::int64_t kMonth_us = kYear_us / 12;

Result<RetentionVersion> version_from(const Row& row) {
  auto rules = TRY(RetentionRules::from_text(row.text(1), "retention_rules.definition"));
  return RetentionVersion{row.integer(0), rules, row.text(2), row.integer(3), row.text(4)};
}

std::optional<std::int64_t> time_or_null(const Value& value) {
  const auto* at = std::get_if<std::int64_t>(&value);
  return at ? std::optional(*at) : std::nullopt;
}

Result<InactivePerson> inactive_from(const Row& row) {
  return InactivePerson{row.text(0), row.text(1), row.integer(2), time_or_null(row.value(3))};
}

/// Changes of the notices, and on whom the rules act now.
struct Plan {
  std::vector<std::string> fresh;  ///< accounts that get a notice
  std::vector<std::string> back;   ///< accounts whose notice is withdrawn
  std::vector<std::string> due;
  bool sign_ins = false;
};

Result<Plan> plan_of(Reading& tx, const RetentionVersion& of, std::int64_t now_utc_us) {
  Plan out;
  std::vector<std::string> inactive;
  if (of.rules.inactive_years) {
    const auto people = TRY(inactive_people(tx, inactive_before(of.rules, now_utc_us)));
    for (const InactivePerson& one : people) {
      inactive.push_back(one.account_id);
      if (!one.acts_utc_us) out.fresh.push_back(one.account_id);
      if (one.acts_utc_us && *one.acts_utc_us <= now_utc_us) out.due.push_back(one.account_id);
    }
  }
  const auto noticed = TRY(tx.query("select account_id from retention_notices"));
  for (const Row& row : noticed)
    if (std::ranges::find(inactive, row.text(0)) == inactive.end()) out.back.push_back(row.text(0));
  if (!of.rules.sign_ins_months ||
      now_utc_us < of.made_utc_us + of.rules.notice_days * kDayOfRetention_us)
    return out;
  out.sign_ins = TRY(old_sign_ins(tx, sign_ins_before(of.rules, now_utc_us))) > 0;
  return out;
}

AuditedAction act_of(const char* what, const std::string& object, const RetentionVersion& of,
                     std::int64_t now_utc_us) {
  return {.who = kServer,
          .role = kServer,
          .what = what,
          .object = object,
          .detail = Json{{"version", of.version}}.dump(),
          .at_utc_us = now_utc_us};
}

Result<void> keep_notices(Store& store, const Plan& plan, const RetentionVersion& of,
                          std::int64_t now_utc_us) {
  if (plan.fresh.empty() && plan.back.empty()) return {};
  const AuditScope scope(act_of("noteRetention", "", of, now_utc_us));
  return store.write([&](Writing& tx) -> Result<void> {
    for (const std::string& id : plan.back)
      TRY(tx.query("delete from retention_notices where account_id = ?", {id}));
    for (const std::string& id : plan.fresh)
      TRY(tx.query(
          "insert into retention_notices (account_id, version, noticed_utc_us, acts_utc_us) "
          "values (?, ?, ?, ?)",
          {id, of.version, now_utc_us, now_utc_us + of.rules.notice_days * kDayOfRetention_us}));
    return {};
  });
}

/// Nothing for a person who came back since the plan was made.
Result<bool> act_on(Store& store, const std::string& account_id, const RetentionVersion& of,
                    std::int64_t now_utc_us) {
  const AuditScope scope(act_of("eraseByRetention", "account=" + account_id, of, now_utc_us));
  return store.write([&](Writing& tx) -> Result<bool> {
    const auto still = TRY(inactive_people(tx, inactive_before(of.rules, now_utc_us)));
    if (std::ranges::find(still, account_id, &InactivePerson::account_id) == still.end())
      return false;
    TRY(begin_erasure(tx, {.account_id = account_id,
                           .mode = of.rules.inactive_mode,
                           .cause = ErasureCause::retention,
                           .begun_utc_us = now_utc_us}));
    return true;
  });
}

Result<void> remove_sign_ins(Store& store, const RetentionVersion& of, std::int64_t now_utc_us) {
  const AuditScope scope(act_of("removeSignIns", "", of, now_utc_us));
  const std::int64_t before = sign_ins_before(of.rules, now_utc_us);
  TRY(store.write([&](Writing& tx) {
    return tx.query("delete from known_origins where seen_utc_us < ?", {before});
  }));
  TRY(redact_sign_ins(store, before));
  return {};
}

}  // namespace

std::string RetentionRules::text() const {
  const auto number = [](const std::optional<long>& value) {
    return value ? Json(*value) : Json();
  };
  const Json out{{"format", kRetentionFormat},
                 {"inactive_years", number(inactive_years)},
                 {"inactive_mode", core::name(inactive_mode)},
                 {"sign_ins_months", number(sign_ins_months)},
                 {"notice_days", notice_days}};
  return out.dump();
}

Result<RetentionRules> RetentionRules::from_text(const std::string& text,
                                                 const std::string& where) {
  const Json json = TRY(core::parse_json(text, where));
  core::Fields fields(json, where);
  RetentionRules out;
  const auto optional_number = [&](const char* key, long high) -> std::optional<long> {
    const Json* given = fields.member(key, false);
    if (!given || given->is_null()) return std::nullopt;
    return fields.integer(key, 1, high);
  };
  if (const std::string format = fields.text_or("format", kRetentionFormat, 64);
      format != kRetentionFormat)
    fields.wrong("format", std::string(kRetentionFormat) + " is expected");
  out.inactive_years = optional_number("inactive_years", 50);
  out.inactive_mode = fields.word_or<ErasureMode>("inactive_mode", out.inactive_mode);
  out.sign_ins_months = optional_number("sign_ins_months", 240);
  out.notice_days = fields.integer_or("notice_days", out.notice_days, 7, 365);
  fields.skip("reason");
  TRY(fields.done());
  return out;
}

Result<void> add_retention_rules(Writing& tx, const RetentionVersion& of) {
  const std::string definition = of.rules.text();
  TRY(tx.query("delete from retention_notices"));
  return done(tx.query(
      "insert into retention_rules (version, definition, reason, made_utc_us, made_by) select "
      "coalesce(max(version), 0) + 1, cast(? as text), cast(? as text), cast(? as bigint), cast(? "
      "as "
      "text) from retention_rules",
      {definition, of.reason, of.made_utc_us, of.made_by}));
}

Result<std::vector<RetentionVersion>> retention_versions(Reading& tx) {
  return all_of(tx.query("select version, definition, reason, made_utc_us, made_by from "
                         "retention_rules order by version desc"),
                version_from);
}

Result<std::vector<InactivePerson>> inactive_people(Reading& tx, std::int64_t before_utc_us) {
  const char* last =
      "(select max(x.at) from (select a.made_utc_us as at union all select s.seen_utc_us from "
      "sessions "
      "s where s.account_id = a.id union all select k.seen_utc_us from known_origins k where "
      "k.account_id = a.id union all select e.started_utc_us from trial_entries e where "
      "e.account_id = "
      "a.id) x)";
  return all_of(
      tx.query(
          fmt::format(
              "select a.id, a.name, {}, (select n.acts_utc_us from retention_notices n where "
              "n.account_id = a.id) from accounts a where a.role = 'trainee' and not exists "
              "(select 1 from erasures g where g.account_id = a.id) and {} < ? order by a.name",
              last, last),
          {before_utc_us}),
      inactive_from);
}

Result<std::uint64_t> old_sign_ins(Reading& tx, std::int64_t before_utc_us) {
  std::uint64_t out = 0;
  for (const char* sql : {"select count(*) from known_origins where seen_utc_us < ?",
                          "select count(*) from audit where what in ('signIn', 'oidcSignIn', "
                          "'oidcCallback', 'ltiLaunch') and "
                          "peer <> '' and at_utc_us < ?"}) {
    auto rows = TRY(tx.query(sql, {before_utc_us}));
    out += rows.front().count(0);
  }
  return out;
}

std::int64_t inactive_before(const RetentionRules& rules, std::int64_t now_utc_us) {
  return now_utc_us - rules.inactive_years.value_or(0) * kYear_us;
}

std::int64_t sign_ins_before(const RetentionRules& rules, std::int64_t now_utc_us) {
  return now_utc_us - rules.sign_ins_months.value_or(0) * kMonth_us;
}

Result<std::vector<std::string>> keep_retention(Store& store, std::int64_t now_utc_us) {
  std::vector<std::string> out;
  const auto versions = TRY(store.read([](Reading& tx) { return retention_versions(tx); }));
  if (versions.empty()) return out;
  const RetentionVersion& of = versions.front();
  const Plan plan = TRY(store.read([&](Reading& tx) { return plan_of(tx, of, now_utc_us); }));
  TRY(keep_notices(store, plan, of, now_utc_us));
  for (const std::string& id : plan.due)
    if (TRY(act_on(store, id, of, now_utc_us))) out.push_back(id);
  if (plan.sign_ins) TRY(remove_sign_ins(store, of, now_utc_us));
  return out;
}

}  // namespace store
}  // namespace tractus
