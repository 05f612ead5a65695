#include "db/store/cases/case_makings.hpp"

#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr const char* kMaking =
    "select id, volume_id, title, plan, state, share, phase, error, case_id, made_utc_us, made_by "
    "from case_makings ";

core::Result<CaseMaking> making_from(const Row& row) {
  const auto state = TRY(row.word<WorkState>(4, "case_makings.state"));
  return CaseMaking{row.text(0),   row.text(1), row.text(2), row.text(3),         state,
                    row.number(5), row.text(6), row.text(7), row.text_or_null(8), row.integer(9),
                    row.text(10)};
}

}  // namespace

core::Result<void> add_case_making(Writing& tx, const CaseMaking& making) {
  return done(
      tx.query("insert into case_makings (id, volume_id, title, plan, state, share, phase, error, "
               "made_utc_us, made_by, changed_utc_us) values (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)",
               {making.id, making.volume_id, making.title, making.plan, name_value(making.state),
                making.share, making.phase, making.error, making.made_utc_us, making.made_by,
                making.made_utc_us}));
}

core::Result<std::optional<CaseMaking>> case_making_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kMaking) + "where id = ?", {id}), making_from);
}

core::Result<std::vector<CaseMaking>> case_makings(Reading& tx, std::int64_t limit) {
  return all_of(tx.query(std::string(kMaking) + "order by made_utc_us desc, id limit ?", {limit}),
                making_from);
}

core::Result<void> note_making(Writing& tx, const std::string& id, double share,
                               const std::string& phase, std::int64_t now_utc_us) {
  return done(
      tx.query("update case_makings set state = 'running', share = ?, phase = ?, "
               "changed_utc_us = ? where id = ?",
               {share, phase, now_utc_us, id}));
}

core::Result<void> finish_making(Writing& tx, const std::string& id, const std::string& case_id,
                                 std::int64_t now_utc_us) {
  return done(
      tx.query("update case_makings set state = 'done', share = 1.0, phase = '', case_id = ?, "
               "changed_utc_us = ? where id = ?",
               {case_id, now_utc_us, id}));
}

core::Result<void> fail_making(Writing& tx, const std::string& id, const std::string& why,
                               std::int64_t now_utc_us) {
  return done(
      tx.query("update case_makings set state = 'failed', phase = '', error = ?, "
               "changed_utc_us = ? where id = ?",
               {why, now_utc_us, id}));
}

}  // namespace store
}  // namespace tractus
