#include "db/store/operations/notifications.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/operations/deliveries.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr std::int64_t kDayOfNotices_us = 24ll * 3600 * 1'000'000;

std::string kinds_text(const std::vector<NotificationKind>& kinds) {
  std::vector<std::string_view> out;
  for (const NotificationKind kind : kinds) out.push_back(name(kind));
  return fmt::format("{}", fmt::join(out, " "));
}

core::Result<Webhook> webhook_from(const Row& row) {
  Webhook out{.id = row.text(0),
              .url = row.text(1),
              .kinds = {},
              .secret = row.text(3),
              .made_utc_us = row.integer(4),
              .made_by = row.text(5)};
  for (const NotificationKind kind : core::values<NotificationKind>())
    if ((" " + row.text(2) + " ").find(fmt::format(" {} ", name(kind))) != std::string::npos)
      out.kinds.push_back(kind);
  return out;
}
constexpr const char* kWebhook =
    "select id, url, kinds, secret, made_utc_us, made_by from webhooks ";

/// Open work of an assignment that has a due time, by that time.
constexpr const char* kOpenWork =
    "select distinct e.study_id, e.due_utc_us from assignment_entries e join assigned_progress p "
    "on p.study_id = e.study_id where p.finished = 0 and e.due_utc_us > ? and e.due_utc_us <= ? "
    "and not exists (select 1 from notification_events n where n.key = ? || e.study_id || '/' || "
    "cast(e.due_utc_us as text)) ";

struct DueRange {
  NotificationKind kind;
  std::int64_t after_us, until_us;
};
std::vector<DueRange> due_ranges(std::int64_t now_utc_us) {
  return {{NotificationKind::due, now_utc_us, now_utc_us + kDayOfNotices_us},
          {NotificationKind::overdue, now_utc_us - 7 * kDayOfNotices_us, now_utc_us}};
}
std::string prefix_of(NotificationKind kind) { return std::string(name(kind)) + "/"; }

core::Result<Rows> open_work(Reading& tx, const DueRange& range, const char* tail) {
  return tx.query(std::string(kOpenWork) + tail,
                  {range.after_us, range.until_us, prefix_of(range.kind)});
}

/// The ids of the accounts that an event of the kind concerns; its subject is given twice.
const char* concerned(NotificationKind kind) {
  switch (kind) {
    case NotificationKind::due:
      return "select account_id from assigned_progress where study_id = ? and finished = 0 and ? "
             "<> ''";
    case NotificationKind::overdue:
      return "select account_id from assigned_progress where study_id = ? and finished = 0 union "
             "select c.account_id from assignments s join cohort_people c on c.cohort_id = "
             "s.cohort_id and c.part = 'faculty' where s.study_id = ?";
    case NotificationKind::released:
      return "select account_id from assignment_people where study_id = ? and ? <> ''";
    case NotificationKind::relapse:
      return "select l.account_id from cohort_people l join cohort_people t on t.cohort_id = "
             "l.cohort_id and t.part = 'trainee' where l.part = 'faculty' and t.account_id = ? "
             "and ? <> ''";
    case NotificationKind::self_test_failed:
    case NotificationKind::backup_failed:
      return "select id from accounts where role in ('admin', 'technician') and (? <> '' or ? = "
             "'')";
    case NotificationKind::test:
      return "select id from accounts where id = ? and ? <> ''";
  }
  return "";
}

}  // namespace

core::Result<void> note_event(Writing& tx, NotificationEvent event) {
  return done(tx.query(
      "insert into notification_events (id, kind, key, subject, at_utc_us, spread) values (?, ?, "
      "?, ?, ?, 0) on conflict (key) do nothing",
      {core::new_id(), name_value(event.kind), event.key, event.subject, event.at_utc_us}));
}

core::Result<void> note_due_assignments(Writing& tx, std::int64_t now_utc_us) {
  for (const DueRange& range : due_ranges(now_utc_us)) {
    const auto rows = TRY(open_work(tx, range, "order by e.due_utc_us limit 500"));
    for (const Row& row : rows)
      TRY(note_event(
          tx, {.id = {},
               .kind = range.kind,
               .key = fmt::format("{}{}/{}", prefix_of(range.kind), row.text(0), row.integer(1)),
               .subject = row.text(0),
               .at_utc_us = now_utc_us}));
  }
  return {};
}

core::Result<bool> has_new_events(Reading& tx, std::int64_t now_utc_us) {
  const auto fresh = TRY(tx.query("select 1 from notification_events where spread = 0 limit 1"));
  if (!fresh.empty()) return true;
  for (const DueRange& range : due_ranges(now_utc_us)) {
    const auto rows = TRY(open_work(tx, range, "limit 1"));
    if (!rows.empty()) return true;
  }
  return false;
}

std::vector<NotificationKind> kinds_for(Role role) {
  using enum NotificationKind;
  switch (role) {
    case Role::trainee:
      return {due, overdue, released};
    case Role::faculty:
      return {overdue, relapse};
    case Role::admin:
    case Role::technician:
      return {self_test_failed, backup_failed};
    case Role::director:
    case Role::researcher:
    case Role::station:
      return {};
  }
  return {};
}

core::Result<NotificationChoices> notification_choices(Reading& tx, const std::string& account_id) {
  const auto rows =
      TRY(tx.query("select kind, delivery from notification_choices where account_id = ? order by "
                   "kind",
                   {account_id}));
  NotificationChoices out;
  for (const Row& row : rows) {
    const auto kind = TRY(row.word<NotificationKind>(0, "notification_choices.kind"));
    const auto delivery = TRY(row.word<NotificationDelivery>(1, "notification_choices.delivery"));
    out.emplace_back(kind, delivery);
  }
  return out;
}

core::Result<void> set_notification_choices(Writing& tx, const std::string& account_id,
                                            const NotificationChoices& choices) {
  TRY(tx.query("delete from notification_choices where account_id = ?", {account_id}));
  for (const auto& [kind, delivery] : choices) {
    if (delivery == NotificationDelivery::off) continue;
    TRY(tx.query("insert into notification_choices (account_id, kind, delivery) values (?, ?, ?)",
                 {account_id, name_value(kind), name_value(delivery)}));
  }
  return {};
}

core::Result<std::string> notification_address(Reading& tx, const std::string& account_id) {
  const auto rows = TRY(
      tx.query("select address from notification_addresses where account_id = ?", {account_id}));
  return rows.empty() ? std::string() : rows.front().text(0);
}

core::Result<void> set_notification_address(Writing& tx, const std::string& account_id,
                                            const std::string& address) {
  if (address.empty())
    return done(tx.query("delete from notification_addresses where account_id = ?", {account_id}));
  return done(
      tx.query("insert into notification_addresses (account_id, address) values (?, ?) on conflict "
               "(account_id) do update set address = excluded.address",
               {account_id, address}));
}

core::Result<void> add_webhook(Writing& tx, const Webhook& webhook) {
  const auto rows = TRY(tx.query("select count(*) from webhooks"));
  if (rows.front().integer(0) >= kMaxWebhooks)
    return core::Error{core::Errc::conflict,
                       fmt::format("there are {} webhooks: remove one first", kMaxWebhooks)};
  return done(tx.query(
      "insert into webhooks (id, url, kinds, secret, made_utc_us, made_by) values (?, ?, ?, ?, ?, "
      "?)",
      {webhook.id, webhook.url, kinds_text(webhook.kinds), webhook.secret, webhook.made_utc_us,
       webhook.made_by}));
}

core::Result<std::vector<Webhook>> all_webhooks(Reading& tx) {
  return all_of(tx.query(std::string(kWebhook) + "order by made_utc_us, id"), webhook_from);
}

core::Result<std::optional<Webhook>> webhook_of(Reading& tx, const std::string& id) {
  return one_of(tx.query(std::string(kWebhook) + "where id = ?", {id}), webhook_from);
}

core::Result<void> remove_webhook(Writing& tx, const std::string& id, std::int64_t now_utc_us) {
  const auto rows = TRY(tx.query("delete from webhooks where id = ? returning id", {id}));
  if (rows.empty()) return core::Error{core::Errc::not_found, "no webhook " + id.substr(0, 32)};
  return withdraw_deliveries(tx, Channel::webhook, id, now_utc_us);
}

core::Result<std::vector<Recipient>> recipients_of(Reading& tx, const NotificationEvent& event) {
  const bool test = event.kind == NotificationKind::test;
  const std::string sql = fmt::format(
      "select a.id, a.role, coalesce(c.delivery, 'immediate') from accounts a join "
      "notification_addresses n on n.account_id = a.id {} notification_choices c on c.account_id = "
      "a.id and c.kind = ? where a.state = 'active' and a.id in ({}) order by a.id",
      test ? "left join" : "join", concerned(event.kind));
  const auto rows = TRY(tx.query(sql, {name_value(event.kind), event.subject, event.subject}));
  std::vector<Recipient> out;
  for (const Row& row : rows) {
    const auto role = TRY(row.word<Role>(1, "accounts.role"));
    const auto delivery = TRY(row.word<NotificationDelivery>(2, "notification_choices.delivery"));
    const auto kinds = kinds_for(role);
    if (test || std::ranges::count(kinds, event.kind) > 0) out.push_back({row.text(0), delivery});
  }
  return out;
}

}  // namespace store
}  // namespace tractus
