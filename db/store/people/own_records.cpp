#include "db/store/people/own_records.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus::store {

core::Result<std::vector<SessionTimes>> session_times(Reading& tx, const std::string& account_id) {
  const auto rows = TRY(tx.query(
      "select made_utc_us, seen_utc_us from sessions where account_id = ? order by made_utc_us",
      {account_id}));
  std::vector<SessionTimes> out;
  for (const Row& row : rows) out.push_back({row.integer(0), row.integer(1)});
  return out;
}

core::Result<std::vector<SignInOrigin>> sign_in_origins(Reading& tx,
                                                        const std::string& account_id) {
  const auto rows = TRY(tx.query(
      "select secret, origin, seen_utc_us from known_origins where account_id = ? order by secret, "
      "origin",
      {account_id}));
  std::vector<SignInOrigin> out;
  for (const Row& row : rows) out.push_back({row.text(0), row.text(1), row.integer(2)});
  return out;
}

core::Result<std::vector<OwnAct>> own_acts(Reading& tx, const std::string& name) {
  const auto rows = TRY(tx.query(
      "select at_utc_us, what, peer from audit where who = ? and role <> 'station' order by number",
      {name}));
  std::vector<OwnAct> out;
  for (const Row& row : rows) out.push_back({row.integer(0), row.text(1), row.text(2)});
  return out;
}

}  // namespace tractus::store
