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

core::Result<void> Notifier::look_for_learning(std::int64_t now_utc_us) {
  bool any = false;
  TRY(backend_.store.read([&](store::Reading& tx) -> core::Result<void> {
    const auto scores = TRY(store::changed_line_items(tx));
    const auto trials = TRY(store::trials_to_state(tx));
    any = !scores.empty() || !trials.empty();
    return {};
  }));
  if (!any) return {};
  return backend_.store.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::queue_scores(tx, now_utc_us));
    return store::queue_statements(tx, now_utc_us);
  });
}

core::Result<void> Notifier::collect() {
  const std::int64_t now = backend_.now_utc_us();
  TRY(look_for_learning(now));
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
  switch (delivery.channel) {
    case Channel::mail:
      return attempt_mail(delivery);
    case Channel::webhook:
      return attempt_call(delivery);
    case Channel::lti:
      return attempt_score(delivery);
    case Channel::xapi:
      return attempt_statement(delivery);
  }
  return withdrawn("the channel is unknown");
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

core::Result<void> Notifier::attempt_score(const Delivery& delivery) {
  ScoreCall call{.at_utc_us = backend_.now_utc_us(), .networks = settings_.networks};
  TRY(backend_.store.read([&](store::Reading& tx) -> core::Result<void> {
    const auto what = TRY(store::line_item_of(tx, delivery.id));
    const auto platform = TRY(store::platform_of(tx, delivery.recipient));
    if (!what || !platform) return withdrawn("the results are held, or the link was removed");
    call.what = *what;
    call.platform = *platform;
    return {};
  }));
  call.key = TRY(tool_key(backend_));
  TRY(settings_.score(call));
  return backend_.store.write(
      [&](store::Writing& tx) { return store::settle_line_item(tx, call.what); });
}

core::Result<void> Notifier::attempt_statement(const Delivery& delivery) {
  StatementCall call{.to = {}, .statement = {}, .networks = settings_.networks};
  TRY(backend_.store.read([&](store::Reading& tx) -> core::Result<void> {
    const auto to = TRY(store::record_store(tx));
    const auto stated = TRY(store::stated_trial(tx, delivery.id));
    if (!to || !stated) return withdrawn("the results are held, or the store was removed");
    const auto trial = TRY(released_trial(tx, *stated, backend_.pseudonym_key));
    if (!trial) return withdrawn("the person does not consent any more");
    call.to = *to;
    call.to.secret = TRY(backend_.secrets.opened(to->secret));
    call.statement = statement_json({.id = delivery.id,
                                     .base = settings_.base,
                                     .title = TRY(store::series_title(tx, stated->study_id)),
                                     .assignment_id = stated->study_id,
                                     .trial = *trial});
    return {};
  }));
  return settings_.state(call);
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
    if (const auto score = TRY(store::line_item_of(tx, delivery.id)))
      TRY(store::settle_line_item(tx, *score));
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
