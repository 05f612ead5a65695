/// The outbox: messages to people (e-mail), to programs (webhooks), scores to learning platforms (LTI)
/// and statements to a learning record store (xAPI), each with an id that stays the same when it is sent again, so that a receiver recognises
/// it.
#pragma once

#include "db/store/operations/notifications.hpp"

namespace tractus::store {

enum class Channel {
  mail,
  webhook,
  lti,   ///< a score of an assignment to a learning platform
  xapi,  ///< a statement of a trial to a learning record store
};
constexpr auto words(Channel) {
  using enum Channel;
  return std::to_array<core::Word<Channel>>(
      {{mail, "mail"}, {webhook, "webhook"}, {lti, "lti"}, {xapi, "xapi"}});
}
enum class DeliveryState {
  waiting,
  sent,
  given_up,   ///< refused for good, or not accepted within kDeliveryKept_us
  withdrawn,  ///< its recipient does not want it any more
};
constexpr auto words(DeliveryState) {
  using enum DeliveryState;
  return std::to_array<core::Word<DeliveryState>>(
      {{waiting, "waiting"}, {sent, "sent"}, {given_up, "given up"}, {withdrawn, "withdrawn"}});
}

struct Delivery {
  std::string id;
  Channel channel = Channel::mail;
  std::string recipient;  ///< id of the account, the webhook, the platform or the store
  DeliveryState state = DeliveryState::waiting;
  std::int64_t attempts = 0;
  std::int64_t made_utc_us = 0, due_utc_us = 0, changed_utc_us = 0;
  std::string error = {};  ///< of the last attempt
};

inline constexpr std::int64_t kDeliveryKept_us = 3ll * 24 * 3600 * 1'000'000;
inline constexpr std::int64_t kClaim_us = 2ll * 60 * 1'000'000;
/// After so many failed attempts the next one waits: 1 min, 3 min, 9 min, 27 min, then 80 min.
std::int64_t back_off_us(std::int64_t attempts);
/// The time of the daily message after this time: 06:00 UTC.
std::int64_t next_daily_utc_us(std::int64_t now_utc_us);

/// Queues the deliveries of new events, to whom they concern now. @param mail  false: the server
/// sends no e-mail
core::Result<void> queue_deliveries(Writing& tx, std::int64_t now_utc_us, bool mail);
/// Queues a delivery of its own, which has no events: of what is known where its id is kept. Returns
/// its id.
core::Result<std::string> queue_delivery(Writing& tx, Channel channel, const std::string& recipient,
                                         std::int64_t now_utc_us);
/// What waits for this recipient is not sent any more.
core::Result<void> withdraw_deliveries(Writing& tx, Channel channel, const std::string& recipient,
                                       std::int64_t now_utc_us);
/// Queues a test to a webhook. Errors: not_found.
core::Result<void> queue_webhook_test(Writing& tx, const std::string& webhook_id,
                                      std::int64_t now_utc_us);

/// Claims the next delivery that is due; none if there is none. If this process dies, another one
/// sends it after kClaim_us, with the same id.
core::Result<std::optional<Delivery>> claim_delivery(Writing& tx, Channel channel,
                                                     std::int64_t now_utc_us);
/// Oldest first.
core::Result<std::vector<NotificationEvent>> events_of(Reading& tx, const std::string& delivery_id);
core::Result<void> end_delivery(Writing& tx, const Delivery& delivery, DeliveryState state,
                                const std::string& error, std::int64_t now_utc_us);
/// Tries it again later, and with it every delivery to the same receiver: the mail server, the
/// webhook, the platform or the store.
core::Result<void> postpone_delivery(Writing& tx, const Delivery& delivery,
                                     const std::string& error, std::int64_t now_utc_us);

struct DeliveryCounts {
  std::int64_t waiting = 0, given_up = 0, sent_today = 0;
};
/// Given up and sent: within a week and a day before now.
core::Result<DeliveryCounts> delivery_counts(Reading& tx, std::int64_t now_utc_us);
/// Deliveries that failed at least once and those of the last days, newest first; at most 50.
core::Result<std::vector<Delivery>> recent_deliveries(Reading& tx);
/// Removes deliveries that ended, and their events, after 90 days.
core::Result<void> remove_old_deliveries(Writing& tx, std::int64_t now_utc_us);

}  // namespace tractus::store
