#include "db/store/operations/deliveries.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "db/store/rows.hpp"

namespace tractus {
namespace store {
namespace {

constexpr std::int64_t kHour_us = 3600ll * 1'000'000, kOneDay_us = 24 * kHour_us;
constexpr std::int64_t kMinute_us = 60'000'000;

core::Result<Delivery> delivery_from(const Row& row) {
  const auto channel = TRY(row.word<Channel>(1, "deliveries.channel"));
  const auto state = TRY(row.word<DeliveryState>(3, "deliveries.state"));
  return Delivery{.id = row.text(0),
                  .channel = channel,
                  .recipient = row.text(2),
                  .state = state,
                  .attempts = row.integer(4),
                  .made_utc_us = row.integer(5),
                  .due_utc_us = row.integer(6),
                  .changed_utc_us = row.integer(7),
                  .error = row.text(8)};
}
constexpr const char* kDelivery =
    "select id, channel, recipient, state, attempts, made_utc_us, due_utc_us, changed_utc_us, "
    "error from deliveries ";

core::Result<NotificationEvent> event_from(const Row& row) {
  const auto kind = TRY(row.word<NotificationKind>(1, "notification_events.kind"));
  return NotificationEvent{row.text(0), kind, row.text(2), row.text(3), row.integer(4)};
}
constexpr const char* kEvent =
    "select n.id, n.kind, n.key, n.subject, n.at_utc_us from notification_events n ";

struct NewDelivery {
  Channel channel;
  std::string recipient;
  std::int64_t due_utc_us;
  std::string batch = {};  ///< empty: a message of its own
};

/// Returns the id of the delivery, which is an earlier one if the batch has one.
core::Result<std::string> add_delivery(Writing& tx, const NewDelivery& wanted,
                                       std::int64_t now_utc_us) {
  const std::string id = core::new_id();
  TRY(tx.query(
      "insert into deliveries (id, channel, recipient, batch, state, attempts, made_utc_us, "
      "due_utc_us, claimed_until_us, changed_utc_us, error) values (?, ?, ?, ?, 'waiting', 0, ?, "
      "?, 0, ?, '') on conflict (batch) do nothing",
      {id, name_value(wanted.channel), wanted.recipient, text_or_null(wanted.batch), now_utc_us,
       wanted.due_utc_us, now_utc_us}));
  if (wanted.batch.empty()) return id;
  const auto rows = TRY(tx.query("select id from deliveries where batch = ?", {wanted.batch}));
  return rows.front().text(0);
}

core::Result<void> queue(Writing& tx, const NewDelivery& wanted, const std::string& event_id,
                         std::int64_t now_utc_us) {
  const auto id = TRY(add_delivery(tx, wanted, now_utc_us));
  return done(tx.query("insert into delivery_events (delivery_id, event_id) values (?, ?)",
                       {id, event_id}));
}

core::Result<void> queue_mails(Writing& tx, const NotificationEvent& event,
                               std::int64_t now_utc_us) {
  const auto recipients = TRY(recipients_of(tx, event));
  for (const Recipient& one : recipients) {
    NewDelivery wanted{Channel::mail, one.account_id, now_utc_us};
    if (one.delivery == NotificationDelivery::daily) {
      wanted.due_utc_us = next_daily_utc_us(now_utc_us);
      wanted.batch = fmt::format("{}/{}", one.account_id, wanted.due_utc_us);
    }
    TRY(queue(tx, wanted, event.id, now_utc_us));
  }
  return {};
}

core::Result<void> queue_calls(Writing& tx, const NotificationEvent& event,
                               std::int64_t now_utc_us) {
  const auto webhooks = TRY(all_webhooks(tx));
  for (const Webhook& webhook : webhooks) {
    const bool tested = event.kind == NotificationKind::test && event.subject == webhook.id;
    if (tested || std::ranges::count(webhook.kinds, event.kind) > 0)
      TRY(queue(tx, {Channel::webhook, webhook.id, now_utc_us}, event.id, now_utc_us));
  }
  return {};
}

}  // namespace

std::int64_t back_off_us(std::int64_t attempts) {
  std::int64_t out = kMinute_us;
  for (std::int64_t i = 1; i < std::min<std::int64_t>(attempts, 5); ++i) out *= 3;
  return std::min(out, 80 * kMinute_us);
}

std::int64_t next_daily_utc_us(std::int64_t now_utc_us) {
  const std::int64_t today = now_utc_us / kOneDay_us * kOneDay_us + 6 * kHour_us;
  return today > now_utc_us ? today : today + kOneDay_us;
}

core::Result<void> queue_deliveries(Writing& tx, std::int64_t now_utc_us, bool mail) {
  const auto events = TRY(all_of(
      tx.query(std::string(kEvent) + "where n.spread = 0 order by n.at_utc_us, n.id limit 500"),
      event_from));
  for (const NotificationEvent& event : events) {
    if (mail) TRY(queue_mails(tx, event, now_utc_us));
    TRY(queue_calls(tx, event, now_utc_us));
    TRY(tx.query("update notification_events set spread = 1 where id = ?", {event.id}));
  }
  return {};
}

core::Result<std::string> queue_delivery(Writing& tx, Channel channel, const std::string& recipient,
                                         std::int64_t now_utc_us) {
  return add_delivery(tx, {channel, recipient, now_utc_us}, now_utc_us);
}

core::Result<void> withdraw_deliveries(Writing& tx, Channel channel, const std::string& recipient,
                                       std::int64_t now_utc_us) {
  return done(tx.query(
      "update deliveries set state = 'withdrawn', changed_utc_us = ? where channel = ? and "
      "recipient = ? and state = 'waiting'",
      {now_utc_us, name_value(channel), recipient}));
}

core::Result<void> queue_webhook_test(Writing& tx, const std::string& webhook_id,
                                      std::int64_t now_utc_us) {
  const auto known = TRY(webhook_of(tx, webhook_id));
  if (!known) return core::Error{core::Errc::not_found, "no webhook " + webhook_id.substr(0, 32)};
  return note_event(tx, {.id = {},
                         .kind = NotificationKind::test,
                         .key = fmt::format("test/{}/{}", webhook_id, now_utc_us / kMinute_us),
                         .subject = webhook_id,
                         .at_utc_us = now_utc_us});
}

core::Result<std::optional<Delivery>> claim_delivery(Writing& tx, Channel channel,
                                                     std::int64_t now_utc_us) {
  auto found =
      TRY(one_of(tx.query(std::string(kDelivery) +
                              "where state = 'waiting' and channel = ? and due_utc_us <= ? and "
                              "claimed_until_us <= ? order by due_utc_us, id limit 1",
                          {name_value(channel), now_utc_us, now_utc_us}),
                 delivery_from));
  if (!found) return std::optional<Delivery>();
  ++found->attempts;
  TRY(tx.query("update deliveries set attempts = ?, claimed_until_us = ? where id = ?",
               {found->attempts, now_utc_us + kClaim_us, found->id}));
  return found;
}

core::Result<std::vector<NotificationEvent>> events_of(Reading& tx,
                                                       const std::string& delivery_id) {
  return all_of(tx.query(std::string(kEvent) +
                             "join delivery_events d on d.event_id = n.id where d.delivery_id = ? "
                             "order by n.at_utc_us, n.id",
                         {delivery_id}),
                event_from);
}

core::Result<void> end_delivery(Writing& tx, const Delivery& delivery, DeliveryState state,
                                const std::string& error, std::int64_t now_utc_us) {
  return done(
      tx.query("update deliveries set state = ?, error = ?, changed_utc_us = ? where id = ?",
               {name_value(state), error, now_utc_us, delivery.id}));
}

core::Result<void> postpone_delivery(Writing& tx, const Delivery& delivery,
                                     const std::string& error, std::int64_t now_utc_us) {
  const std::int64_t due = now_utc_us + back_off_us(delivery.attempts);
  TRY(tx.query(
      "update deliveries set due_utc_us = ?, claimed_until_us = 0, error = ?, changed_utc_us = ? "
      "where id = ?",
      {due, error, now_utc_us, delivery.id}));
  return done(tx.query(
      "update deliveries set due_utc_us = ? where state = 'waiting' and channel = ? and due_utc_us "
      "< ? and (channel = 'mail' or recipient = ?)",
      {due, name_value(delivery.channel), due, delivery.recipient}));
}

core::Result<DeliveryCounts> delivery_counts(Reading& tx, std::int64_t now_utc_us) {
  const auto count = [&](const char* state, std::int64_t since) -> core::Result<std::int64_t> {
    const auto rows = TRY(tx.query(
        "select count(*) from deliveries where state = ? and changed_utc_us >= ?", {state, since}));
    return rows.front().integer(0);
  };
  const auto waiting = TRY(count("waiting", 0));
  const auto given_up = TRY(count("given up", now_utc_us - 7 * kOneDay_us));
  const auto sent = TRY(count("sent", now_utc_us - kOneDay_us));
  return DeliveryCounts{waiting, given_up, sent};
}

core::Result<std::vector<Delivery>> recent_deliveries(Reading& tx) {
  return all_of(tx.query(std::string(kDelivery) + "order by changed_utc_us desc, id limit 50"),
                delivery_from);
}

core::Result<void> remove_old_deliveries(Writing& tx, std::int64_t now_utc_us) {
  const std::int64_t before = now_utc_us - 90 * kOneDay_us;
  TRY(tx.query(
      "delete from delivery_events where delivery_id in (select id from deliveries where state <> "
      "'waiting' and changed_utc_us < ?)",
      {before}));
  return done(
      tx.query("delete from deliveries where state <> 'waiting' and changed_utc_us < ?", {before}));
}

}  // namespace store
}  // namespace tractus
