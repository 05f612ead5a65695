#include "db/store/people/invitations.hpp"

#include "core/try.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kInvitation =
    "select i.cohort_id, i.account_name, i.made_utc_us, i.made_by, c.name from cohort_invitations "
    "i join cohorts c on c.id = i.cohort_id ";

core::Result<std::vector<Invitation>> invitations_from(const core::Result<Rows>& rows) {
  if (!rows) return rows.error();
  std::vector<Invitation> out;
  for (const Row& row : *rows)
    out.push_back({row.text(0), row.text(1), row.integer(2), row.text(3), row.text(4)});
  return out;
}

}  // namespace

core::Result<void> invite(Writing& tx, const Invitation& i) {
  auto waiting =
      TRY(tx.query("select count(*) from cohort_invitations where cohort_id = ?", {i.cohort_id}));
  if (waiting.front().count(0) >= kMostInvitations)
    return core::Error{
        core::Errc::conflict,
        std::to_string(kMostInvitations) + " invitations wait in this cohort: withdraw some first"};
  TRY(tx.query(
      "insert into cohort_invitations (cohort_id, account_name, made_utc_us, made_by) values "
      "(?, ?, ?, ?) on conflict (cohort_id, account_name) do nothing",
      {i.cohort_id, i.account_name, i.made_utc_us, i.made_by}));
  return {};
}

core::Result<std::vector<Invitation>> invitations_into(Reading& tx, const std::string& cohort_id) {
  return invitations_from(tx.query(
      std::string(kInvitation) + "where i.cohort_id = ? order by i.account_name", {cohort_id}));
}

core::Result<std::vector<Invitation>> invitations_for(Reading& tx,
                                                      const std::string& account_name) {
  return invitations_from(tx.query(
      std::string(kInvitation) + "where i.account_name = ? order by i.made_utc_us, i.cohort_id",
      {account_name}));
}

core::Result<void> remove_invitation(Writing& tx, const std::string& cohort_id,
                                     const std::string& account_name) {
  TRY(tx.query("delete from cohort_invitations where cohort_id = ? and account_name = ?",
               {cohort_id, account_name}));
  return {};
}

core::Result<bool> is_invited(Reading& tx, const std::string& account_id,
                              const std::string& cohort_id) {
  auto rows = TRY(tx.query(
      "select 1 from cohort_invitations i join accounts a on a.name = i.account_name where a.id = "
      "? and i.cohort_id = ?",
      {account_id, cohort_id}));
  return !rows.empty();
}

}  // namespace store
}  // namespace tractus
