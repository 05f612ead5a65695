#include "db/store/people/subjects.hpp"

#include "core/try.hpp"

namespace tractus::store {

core::Result<void> link_subject(Writing& tx, const Subject& link) {
  auto account = TRY(account_of(tx, link.account_id));
  if (!account) return core::Error{core::Errc::not_found, "there is no account " + link.account_id};
  auto holder = TRY(account_of_subject(tx, link.issuer, link.subject));
  if (holder && holder->id != link.account_id)
    return core::Error{core::Errc::conflict,
                       "subject: the account " + holder->name + " already has this subject"};
  TRY(tx.query("delete from oidc_subjects where issuer = ? and account_id = ?",
               {link.issuer, link.account_id}));
  if (link.subject.empty()) return {};
  TRY(
      tx.query("insert into oidc_subjects (issuer, subject, account_id, linked_utc_us, linked_by) "
               "values (?, ?, ?, ?, ?)",
               {link.issuer, link.subject, link.account_id, link.linked_utc_us, link.linked_by}));
  if (!account->must_change) return {};
  Account changed = *account;
  changed.password_hash.clear();
  changed.must_change = false;
  return set_account(tx, changed);
}

core::Result<std::optional<Account>> account_of_subject(Reading& tx, const std::string& issuer,
                                                        const std::string& subject) {
  auto rows = TRY(tx.query("select account_id from oidc_subjects where issuer = ? and subject = ?",
                           {issuer, subject}));
  if (rows.empty()) return std::optional<Account>();
  return account_of(tx, rows.front().text(0));
}

core::Result<std::string> subject_of(Reading& tx, const std::string& issuer,
                                     const std::string& account_id) {
  auto rows = TRY(tx.query("select subject from oidc_subjects where issuer = ? and account_id = ?",
                           {issuer, account_id}));
  return rows.empty() ? std::string() : rows.front().text(0);
}

}  // namespace tractus::store
