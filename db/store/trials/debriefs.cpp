#include "db/store/trials/debriefs.hpp"

#include "core/try.hpp"
#include "db/store/studies/blinding.hpp"

namespace tractus::store {

core::Result<void> add_comment(Writing& tx, const Comment& comment) {
  TRY(
      tx.query("insert into trial_comments (id, trial_id, at_s, text, by_id, by_name, made_utc_us) "
               "values (?, ?, ?, ?, ?, ?, ?)",
               {comment.id, comment.trial_id, or_null(comment.at_s), comment.text, comment.by_id,
                comment.by_name, comment.made_utc_us}));
  return {};
}

core::Result<std::vector<Comment>> comments_of(Reading& tx, const std::string& trial_id) {
  auto rows = TRY(
      tx.query("select id, trial_id, at_s, text, by_id, by_name, made_utc_us from trial_comments "
               "where trial_id = ? order by coalesce(at_s, -1.0), made_utc_us, id",
               {trial_id}));
  std::vector<Comment> out;
  for (const Row& row : rows)
    out.push_back({row.text(0), row.text(1), row.number_or_null(2), row.text(3), row.text(4),
                   row.text(5), row.integer(6)});
  return out;
}

core::Result<void> remove_comment(Writing& tx, const std::string& trial_id, const std::string& id,
                                  const std::string& by_id) {
  auto rows = TRY(tx.query(
      "delete from trial_comments where trial_id = ? and id = ? and by_id = ? returning id",
      {trial_id, id, by_id}));
  if (rows.empty())
    return core::Error{core::Errc::not_found, "you have no comment with this id on the trial"};
  return {};
}

core::Result<void> set_reference(Writing& tx, const std::string& trial_id, bool reference,
                                 const std::string& who, std::int64_t now_utc_us) {
  auto there = TRY(tx.query("select id from trials where id = ?", {trial_id}));
  if (there.empty())
    return core::Error{core::Errc::not_found, "no trial " + trial_id.substr(0, 32)};
  TRY(reference ? tx.query("insert into reference_trials (trial_id, made_utc_us, made_by) values "
                           "(?, ?, ?) on conflict (trial_id) do nothing",
                           {trial_id, now_utc_us, who})
                : tx.query("delete from reference_trials where trial_id = ?", {trial_id}));
  return {};
}

core::Result<bool> is_reference(Reading& tx, const std::string& trial_id) {
  auto rows = TRY(tx.query("select trial_id from reference_trials where trial_id = ?", {trial_id}));
  return !rows.empty();
}

core::Result<std::vector<ReferenceTrial>> references_for(Reading& tx, const std::string& trial_id) {
  auto rows = TRY(tx.query(
      "select t.id, t.operator_name, t.started_utc_us, t.duration_s, t.simulated from "
      "reference_trials r join trials t on t.id = r.trial_id join trials mine on mine.case_id = "
      "t.case_id where mine.id = ? and t.id <> mine.id and not " +
          blinded_sql() + " order by t.started_utc_us desc, t.id",
      {trial_id}));
  std::vector<ReferenceTrial> out;
  for (const Row& row : rows)
    out.push_back({row.text(0), row.text(1), row.integer(2), row.number(3), row.truth(4)});
  return out;
}

}  // namespace tractus::store
