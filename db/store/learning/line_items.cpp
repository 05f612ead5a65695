#include "db/store/learning/line_items.hpp"

#include <fmt/format.h>

#include "core/try.hpp"
#include "db/store/operations/deliveries.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

/// Line items whose results are released, with the counts of AssignedScore.
constexpr const char* kLineItem =
    "select l.platform_id, l.study_id, l.account_id, l.subject, l.url, l.sent, "
    "(select count(*) from study_slots k join study_trials m on m.slot_id = k.id join trials t on "
    "t.id = m.trial_id where k.study_id = p.study_id and k.participant = p.participant and "
    "k.state = 'recorded' and m.state = 'counts' and t.correct = 1), "
    "(select count(*) from study_slots k where k.study_id = p.study_id and k.participant = "
    "p.participant and k.state = 'recorded'), "
    "(select count(*) from study_slots k where k.study_id = p.study_id and k.participant = "
    "p.participant and k.state <> 'invalid'), "
    "(select count(*) from study_slots k join study_trials m on m.slot_id = k.id join trials t on "
    "t.id = m.trial_id where k.study_id = p.study_id and k.participant = p.participant and "
    "k.state = 'recorded' and m.state = 'counts' and t.state = 'assessing') "
    "from lti_line_items l join assignments a on a.study_id = l.study_id join assignment_people p "
    "on p.study_id = l.study_id and p.account_id = l.account_id where a.release <> 'held' ";

core::Result<LineItemScore> line_item_from(const Row& row) {
  return LineItemScore{
      {row.text(0), row.text(1), row.text(2), row.text(3), row.text(4), row.text(5)},
      {row.count(6), row.count(7), row.count(8), row.count(9)}};
}

}  // namespace

std::string AssignedScore::text() const {
  return fmt::format("{} of {}, {} done, {} assessing", right, planned, done, assessing);
}

core::Result<void> set_line_item(Writing& tx, const LineItem& item) {
  return done(tx.query(
      "insert into lti_line_items (platform_id, study_id, account_id, subject, url, sent) values "
      "(?, ?, ?, ?, ?, '') on conflict (platform_id, study_id, account_id) do update set sent = "
      "case when lti_line_items.url = excluded.url then lti_line_items.sent else '' end, subject = "
      "excluded.subject, url = excluded.url",
      {item.platform_id, item.study_id, item.account_id, item.subject, item.url}));
}

core::Result<std::vector<LineItemScore>> changed_line_items(Reading& tx) {
  auto all = TRY(all_of(
      tx.query(std::string(kLineItem) + "and not exists (select 1 from deliveries d where d.id = "
                                        "l.delivery_id and d.state = 'waiting')"),
      line_item_from));
  std::erase_if(all, [](const LineItemScore& one) {
    return one.score.done == 0 || one.score.text() == one.item.sent;
  });
  return all;
}

core::Result<void> queue_scores(Writing& tx, std::int64_t now_utc_us) {
  const auto changed = TRY(changed_line_items(tx));
  for (const auto& [item, _] : changed) {
    const auto id = TRY(queue_delivery(tx, Channel::lti, item.platform_id, now_utc_us));
    TRY(tx.query(
        "update lti_line_items set delivery_id = ? where platform_id = ? and study_id = ? and "
        "account_id = ?",
        {id, item.platform_id, item.study_id, item.account_id}));
  }
  return {};
}

core::Result<std::optional<LineItemScore>> line_item_of(Reading& tx,
                                                        const std::string& delivery_id) {
  return one_of(tx.query(std::string(kLineItem) + "and l.delivery_id = ?", {delivery_id}),
                line_item_from);
}

core::Result<void> settle_line_item(Writing& tx, const LineItemScore& which) {
  const LineItem& item = which.item;
  return done(
      tx.query("update lti_line_items set sent = ? where platform_id = ? and study_id = ? and "
               "account_id = ? and url = ?",
               {which.score.text(), item.platform_id, item.study_id, item.account_id, item.url}));
}

}  // namespace store
}  // namespace tractus
