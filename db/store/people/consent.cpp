#include "db/store/people/consent.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kConsent =
    "select account_id, study_id, participant, tier, basis, noted_utc_us, noted_by from consents ";

core::Result<Consent> consent_from(const Row& row) {
  const auto tier = TRY(row.word<Tier>(3, "consents.tier"));
  return Consent{row.text(0), row.text(1),    row.text(2), tier,
                 row.text(4), row.integer(5), row.text(6)};
}

}  // namespace

core::Result<void> set_consent(Writing& tx, const Consent& c) {
  if (!c.account_id.empty() && c.study_id.empty())
    TRY(tx.query("delete from consents where account_id = ?", {c.account_id}));
  TRY(tx.query(
      "insert into consents (account_id, study_id, participant, tier, basis, noted_utc_us, "
      "noted_by) values (?, ?, ?, ?, ?, ?, ?) on conflict (account_id, study_id, participant) do "
      "update set tier = excluded.tier, basis = excluded.basis, noted_utc_us = "
      "excluded.noted_utc_us, noted_by = excluded.noted_by",
      {c.account_id, c.study_id, c.participant, name_value(c.tier), c.basis, c.noted_utc_us,
       c.noted_by}));
  return {};
}

core::Result<std::vector<Consent>> consents_of(Reading& tx, const std::string& account_id) {
  return all_of(
      tx.query(std::string(kConsent) + "where account_id = ? order by study_id", {account_id}),
      consent_from);
}

core::Result<std::vector<Consent>> all_consents(Reading& tx) {
  return all_of(tx.query(std::string(kConsent) + "order by account_id, study_id, participant"),
                consent_from);
}

core::Result<ConsentBook> ConsentBook::read(Reading& tx) {
  ConsentBook out;
  auto said = TRY(all_consents(tx));
  for (const Consent& c : said) out.said_[{c.account_id, c.study_id, c.participant}] = c.tier;
  auto assigned = TRY(tx.query("select study_id from assignments"));
  for (const Row& row : assigned) out.assignments_.insert(row.text(0));
  auto people = TRY(tx.query("select study_id, participant, account_id from assignment_people"));
  for (const Row& row : people) out.accounts_[{row.text(0), row.text(1)}] = row.text(2);
  return out;
}

std::string ConsentBook::person_of(const CohortTrial& trial) const {
  if (trial.study.empty()) return "operator:" + trial.summary.operator_name;
  const auto account = accounts_.find({trial.study, trial.participant});
  if (account != accounts_.end()) return "account:" + account->second;
  return "participant:" + trial.study + "/" + trial.participant;
}

Tier ConsentBook::tier_of(const std::string& account_id, const std::string& study) const {
  for (const std::string& where : {study, std::string()})
    if (const auto said = said_.find({account_id, where, ""}); said != said_.end())
      return said->second;
  return Tier::none;
}

Tier ConsentBook::tier_of(const CohortTrial& trial) const {
  if (trial.summary.simulated) return Tier::full;
  if (trial.study.empty()) return Tier::none;
  const auto account = accounts_.find({trial.study, trial.participant});
  if (account != accounts_.end()) return tier_of(account->second, trial.study);
  if (assignments_.contains(trial.study)) return Tier::none;
  const auto said = said_.find({"", trial.study, trial.participant});
  return said == said_.end() ? Tier::metrics : said->second;
}

core::Result<std::string> pseudonym_key_known(Reading& tx) {
  auto rows =
      TRY(tx.query("select fingerprint from pseudonym_keys order by since_utc_us desc limit 1"));
  return rows.empty() ? std::string() : rows.front().text(0);
}

core::Result<void> note_pseudonym_key(Writing& tx, const std::string& fingerprint,
                                      std::int64_t now_utc_us) {
  TRY(tx.query("insert into pseudonym_keys (fingerprint, since_utc_us) values (?, ?)",
               {fingerprint, now_utc_us}));
  return {};
}

}  // namespace store
}  // namespace tractus
