#include "db/store/studies/blinding.hpp"

#include "core/try.hpp"

namespace tractus::store {

std::string blinded_sql() {
  return "exists (select 1 from study_trials bt join study_slots bs on bs.id = bt.slot_id join "
         "studies b on b.id = bs.study_id join study_slots bo on bo.study_id = bs.study_id and "
         "bo.participant = bs.participant where bt.trial_id = t.id and b.kind = 'study' and "
         "bo.state in ('waiting', 'taken'))";
}

core::Result<bool> is_blinded(Reading& tx, const std::string& trial_id) {
  auto rows =
      TRY(tx.query("select 1 from trials t where t.id = ? and " + blinded_sql(), {trial_id}));
  return !rows.empty();
}

core::Result<bool> is_study_through(Reading& tx, const std::string& study_id) {
  auto rows = TRY(tx.query(
      "select 1 from studies s where s.id = ? and s.kind = 'study' and exists (select 1 from "
      "study_slots k where k.study_id = s.id) and not exists (select 1 from study_slots k where "
      "k.study_id = s.id and k.state in ('waiting', 'taken'))",
      {study_id}));
  return !rows.empty();
}

}  // namespace tractus::store
