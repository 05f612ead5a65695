#include "server/api/operations/notifier.hpp"

#include <curl/curl.h>

#include <chrono>

#include "core/try.hpp"
#include "core/words.hpp"
#include "db/store/operations/audit.hpp"
#include "db/store/people/accounts.hpp"
#include "server/api/operations/notification_text.hpp"
#include "server/api/studies/relapses.hpp"

namespace tractus {
namespace api {
namespace {

using store::Channel;
using store::Delivery;
using store::DeliveryState;

constexpr std::chrono::seconds kLooksEvery{30};
constexpr std::int64_t kRelapsesEvery_us = 600'000'000;

/// Nothing to send any more, and nothing wrong with it.
core::Error withdrawn(const char* why) { return {core::Errc::cancelled, why}; }

}  // namespace

Notifier::Notifier(Backend& backend, NotifierSettings settings)
    : backend_(backend), settings_(std::move(settings)) {
  curl_global_init(CURL_GLOBAL_DEFAULT);
}

Notifier::~Notifier() {
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void Notifier::start() {
  for (const Channel channel : core::values<Channel>())
    threads_.emplace_back([this, channel] { run(channel); });
}

void Notifier::wake() {
  {
    const std::lock_guard held(mutex_);
    ++woken_;
  }
  changed_.notify_all();
}

void Notifier::log(const core::Json& fields) const {
  if (backend_.log) backend_.log(fields);
}

void Notifier::run(Channel channel) {
  std::uint64_t seen = 0;
  for (;;) {
    const auto collected = collect();
    const auto delivered = deliver(channel);
    if (!collected || !delivered)
      log({{"what", "notifications are delayed: the database does not answer"}});
    std::unique_lock held(mutex_);
    changed_.wait_for(held, kLooksEvery, [&] { return ending_ || woken_ != seen; });
    if (ending_) return;
    seen = woken_;
  }
}

core::Result<void> Notifier::look_for_relapses(std::int64_t now_utc_us) {
  const std::lock_guard held(relapses_mutex_);
  if (now_utc_us - relapses_at_utc_us_ < kRelapsesEvery_us) return {};
  relapses_at_utc_us_ = now_utc_us;
  const auto rows = TRY(backend_.store.read([](store::Reading& tx) {
    return tx.query("select count(*) from trials where state = 'assessed'");
  }));
  if (const auto trials = rows.front().integer(0); trials != trials_then_) {
    TRY(note_relapses(backend_));
    trials_then_ = trials;
  }
  return {};
}

core::Result<void> Notifier::collect() {
  const std::int64_t now = backend_.now_utc_us();
  if (const auto looked = look_for_relapses(now); !looked)
    log({{"what", "relapses were not looked for"}});
  const auto fresh =
      TRY(backend_.store.read([&](store::Reading& tx) { return store::has_new_events(tx, now); }));
  if (!fresh) return {};
  return backend_.store.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::note_due_assignments(tx, now));
    TRY(store::remove_old_deliveries(tx, now));
    return store::queue_deliveries(tx, now, settings_.mail.has_value());
  });
}

core::Result<std::size_t> Notifier::deliver(Channel channel) {
  for (std::size_t attempts = 0;; ++attempts) {
    {
      const std::lock_guard held(mutex_);
      if (ending_) return attempts;
    }
    const std::int64_t now = backend_.now_utc_us();
    const auto next = TRY(backend_.store.write(
        [&](store::Writing& tx) { return store::claim_delivery(tx, channel, now); }));
    if (!next) return attempts;
    TRY(note_outcome(*next, attempt(*next)));
  }
}

core::Result<void> Notifier::attempt(const Delivery& delivery) {
  return delivery.channel == Channel::mail ? attempt_mail(delivery) : attempt_call(delivery);
}

core::Result<void> Notifier::attempt_mail(const Delivery& delivery) {
  if (!settings_.mail) return core::Error{core::Errc::unavailable, "no mail server is configured"};
  Mail mail{
      .id = delivery.id, .to = {}, .subject = {}, .text = {}, .at_utc_us = backend_.now_utc_us()};
  TRY(backend_.store.read([&](store::Reading& tx) -> core::Result<void> {
    const auto account = TRY(store::account_of(tx, delivery.recipient));
    if (!account || account->state != store::AccountState::active)
      return withdrawn("the account is disabled");
    mail.to = TRY(store::notification_address(tx, delivery.recipient));
    if (!allows_recipient(*settings_.mail, mail.to))
      return withdrawn("the account has no address to which mail is allowed");
    const auto events = TRY(store::events_of(tx, delivery.id));
    mail.subject = subject_of(events, account->language);
    mail.text = TRY(message_text(tx, events, settings_.base, account->language));
    return {};
  }));
  return settings_.send(*settings_.mail, mail);
}

core::Result<void> Notifier::attempt_call(const Delivery& delivery) {
  WebhookCall call{.url = {},
                   .secret = {},
                   .id = delivery.id,
                   .at_s = backend_.now_utc_us() / 1'000'000,
                   .body = {},
                   .networks = settings_.networks};
  TRY(backend_.store.read([&](store::Reading& tx) -> core::Result<void> {
    const auto webhook = TRY(store::webhook_of(tx, delivery.recipient));
    if (!webhook) return withdrawn("the webhook was removed");
    call.url = webhook->url;
    call.secret = TRY(backend_.secrets.opened(webhook->secret));
    const auto events = TRY(store::events_of(tx, delivery.id));
    if (events.empty()) return withdrawn("the event was removed");
    call.body = webhook_json(events.front(), settings_.base).dump();
    return {};
  }));
  return settings_.call(call);
}

core::Result<void> Notifier::note_outcome(const Delivery& delivery,
                                          const core::Result<void>& outcome) {
  const std::int64_t now = backend_.now_utc_us();
  const std::string why = outcome ? "" : core::one_line(outcome.error().what, 300);
  const auto code = outcome ? core::Errc::cancelled : outcome.error().code;
  if (outcome || code == core::Errc::cancelled)
    return backend_.store.write([&](store::Writing& tx) {
      return store::end_delivery(
          tx, delivery, outcome ? DeliveryState::sent : DeliveryState::withdrawn, why, now);
    });
  const bool for_good = code != core::Errc::unavailable;
  if (for_good || now - delivery.made_utc_us >= store::kDeliveryKept_us)
    return give_up(delivery, why);
  return backend_.store.write(
      [&](store::Writing& tx) { return store::postpone_delivery(tx, delivery, why, now); });
}

core::Result<void> Notifier::give_up(const Delivery& delivery, const std::string& why) {
  log({{"what", "a delivery was given up"},
       {"channel", name(delivery.channel)},
       {"attempts", delivery.attempts}});
  const std::int64_t now = backend_.now_utc_us();
  const core::Json detail{{"channel", name(delivery.channel)},
                          {"recipient", delivery.recipient},
                          {"attempts", delivery.attempts},
                          {"why", why}};
  return backend_.store.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::end_delivery(tx, delivery, DeliveryState::given_up, why, now));
    return store::add_act(
        tx, backend_.store.audit_key(),
        {.who = store::kServer,
         .role = store::kServer,
         .what = "giveUpDelivery",
         .object = "id=" + delivery.id,
         .detail = detail.dump(-1, ' ', false, core::Json::error_handler_t::replace),
         .at_utc_us = now});
  });
}

}  // namespace api
}  // namespace tractus
