/// Events of which people and programs are told, and who chose to be told of what.
#pragma once

#include <vector>

#include "core/named.hpp"
#include "db/store/people/role.hpp"
#include "db/store/store.hpp"

namespace tractus::store {

enum class NotificationKind {
  due,
  overdue,
  released,
  relapse,
  self_test_failed,
  backup_failed,
  test,
};
constexpr auto words(NotificationKind) {
  using enum NotificationKind;
  return std::to_array<core::Word<NotificationKind>>({{due, "due"},
                                                      {overdue, "overdue"},
                                                      {released, "released"},
                                                      {relapse, "relapse"},
                                                      {self_test_failed, "self_test_failed"},
                                                      {backup_failed, "backup_failed"},
                                                      {test, "test"}});
}
/// When a person is told by e-mail.
enum class NotificationDelivery { off, immediate, daily };
constexpr auto words(NotificationDelivery) {
  using enum NotificationDelivery;
  return std::to_array<core::Word<NotificationDelivery>>(
      {{off, "off"}, {immediate, "immediate"}, {daily, "daily"}});
}

struct NotificationEvent {
  std::string id;
  NotificationKind kind = NotificationKind::test;
  std::string key;      ///< an event with a key that is known is noted once
  std::string subject;  ///< id of the assignment, account, station or backup
  std::int64_t at_utc_us = 0;
};
/// Notes an event, in the transaction of what happened; its deliveries are queued by
/// queue_deliveries. The id is filled in. Does nothing if the key is known.
core::Result<void> note_event(Writing& tx, NotificationEvent event);
/// Notes assignments that become due within a day, and those that became overdue within a week.
core::Result<void> note_due_assignments(Writing& tx, std::int64_t now_utc_us);
/// Whether note_due_assignments or queue_deliveries would change anything.
core::Result<bool> has_new_events(Reading& tx, std::int64_t now_utc_us);

/// The events that concern a role, each of which its people may choose.
std::vector<NotificationKind> kinds_for(Role role);
using NotificationChoices = std::vector<std::pair<NotificationKind, NotificationDelivery>>;
/// Without those that are off.
core::Result<NotificationChoices> notification_choices(Reading& tx, const std::string& account_id);
/// Replaces all choices of the account.
core::Result<void> set_notification_choices(Writing& tx, const std::string& account_id,
                                            const NotificationChoices& choices);
/// E-mail address; empty: none.
core::Result<std::string> notification_address(Reading& tx, const std::string& account_id);
core::Result<void> set_notification_address(Writing& tx, const std::string& account_id,
                                            const std::string& address);

struct Webhook {
  std::string id, url;
  std::vector<NotificationKind> kinds;
  std::string secret;  ///< encrypted
  std::int64_t made_utc_us = 0;
  std::string made_by;
};
inline constexpr std::int64_t kMaxWebhooks = 20;
/// Errors: conflict if there are kMaxWebhooks.
core::Result<void> add_webhook(Writing& tx, const Webhook& webhook);
/// Oldest first.
core::Result<std::vector<Webhook>> all_webhooks(Reading& tx);
core::Result<std::optional<Webhook>> webhook_of(Reading& tx, const std::string& id);
/// Its waiting deliveries are withdrawn. Errors: not_found.
core::Result<void> remove_webhook(Writing& tx, const std::string& id, std::int64_t now_utc_us);

/// The accounts that an event concerns by their relation to its subject and by their role, that
/// chose it, have an address and are active; with the choice. Of a test: its account.
struct Recipient {
  std::string account_id;
  NotificationDelivery delivery = NotificationDelivery::off;
};
core::Result<std::vector<Recipient>> recipients_of(Reading& tx, const NotificationEvent& event);

}  // namespace tractus::store
