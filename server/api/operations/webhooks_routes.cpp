/// Webhooks, and the state of all deliveries, for administrators.
#include <algorithm>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/operations/notifier.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Json;
using core::Result;
using store::NotificationKind;

constexpr std::uint64_t kMaxWebhook_bytes = 8192;

Json webhook_entry(const store::Webhook& webhook) {
  Json kinds = Json::array();
  for (const NotificationKind kind : webhook.kinds) kinds.push_back(name(kind));
  return {{"id", webhook.id},
          {"url", webhook.url},
          {"kinds", kinds},
          {"made_utc_us", webhook.made_utc_us},
          {"made_by", webhook.made_by}};
}

Json delivery_json(const store::Delivery& one) {
  return {{"id", one.id},
          {"channel", name(one.channel)},
          {"recipient", one.recipient},
          {"state", name(one.state)},
          {"attempts", one.attempts},
          {"made_utc_us", one.made_utc_us},
          {"due_utc_us", one.due_utc_us},
          {"changed_utc_us", one.changed_utc_us},
          {"error", one.error}};
}

Json mail_json(const Call& call) {
  const Notifier* notifier = call.backend.notifier;
  if (!notifier || !notifier->settings().mail) return {};
  return {{"server", notifier->settings().mail->server},
          {"from", notifier->settings().mail->from},
          {"domains", notifier->settings().mail->domains}};
}

Result<http::Response> outbox_response(const Call& call) {
  Json webhooks = Json::array(), deliveries = Json::array();
  store::DeliveryCounts counts;
  TRY(call.backend.store.read([&](store::Reading& tx) -> Result<void> {
    const auto hooks = TRY(store::all_webhooks(tx));
    for (const auto& one : hooks) webhooks.push_back(webhook_entry(one));
    const auto recent = TRY(store::recent_deliveries(tx));
    for (const auto& one : recent) deliveries.push_back(delivery_json(one));
    counts = TRY(store::delivery_counts(tx, call.backend.now_utc_us()));
    return {};
  }));
  return json_response({{"mail", mail_json(call)},
                        {"webhooks", webhooks},
                        {"waiting", counts.waiting},
                        {"sent_within_day", counts.sent_today},
                        {"given_up_within_week", counts.given_up},
                        {"deliveries", deliveries}});
}

std::vector<NotificationKind> kinds_field(core::Fields& fields) {
  std::vector<NotificationKind> out;
  const Json* given = fields.member("kinds");
  if (!given) return out;
  if (!given->is_array() || given->empty() || given->size() > 6) {
    fields.wrong("kinds", "an array of at least one kind is expected");
    return out;
  }
  for (const Json& one : *given) {
    const auto kind =
        core::from_name<NotificationKind>(one.is_string() ? one.get<std::string>() : "");
    if (!kind || *kind == NotificationKind::test || std::ranges::count(out, *kind) > 0)
      fields.wrong("kinds",
                   "each of these at most once is expected: due, overdue, released, "
                   "relapse, self_test_failed, backup_failed");
    else
      out.push_back(*kind);
  }
  return out;
}

Result<http::Response> add_webhook_route(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  store::Webhook webhook{.id = core::new_id(),
                         .url = fields.text("url", 2000),
                         .kinds = kinds_field(fields),
                         .secret = {},
                         .made_utc_us = call.backend.now_utc_us(),
                         .made_by = call.caller.name};
  TRY(fields.done());
  const Notifier* notifier = call.backend.notifier;
  TRY(check_webhook_address(webhook.url,
                            notifier ? notifier->settings().networks : http::Networks{}));
  const std::string secret = new_webhook_secret();
  webhook.secret = call.backend.secrets.sealed(secret);
  TRY(call.backend.store.write(
      [&](store::Writing& tx) { return store::add_webhook(tx, webhook); }));
  return json_response({{"webhook", webhook_entry(webhook)}, {"secret", secret}}, 201);
}

http::Response nothing() { return {.status = 204, .headers = {}, .body = std::string()}; }

Result<http::Response> remove_webhook_route(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::remove_webhook(tx, call.text("id"), call.backend.now_utc_us());
  }));
  return nothing();
}

Result<http::Response> test_webhook(const Call& call) {
  TRY(call.backend.store.write([&](store::Writing& tx) {
    return store::queue_webhook_test(tx, call.text("id"), call.backend.now_utc_us());
  }));
  if (call.backend.notifier) call.backend.notifier->wake();
  return nothing();
}

RouteInfo webhook_route(std::string method, std::string tail, std::string id, std::string summary,
                        Result<http::Response> (*handle)(const Call&)) {
  RouteInfo out{.method = std::move(method),
                .path = "/api/v1/webhooks" + tail,
                .id = std::move(id),
                .summary = std::move(summary),
                .who = {Role::admin},
                .parameters = {},
                .body = "",
                .answer = "",
                .schemas = {},
                .handle = handle};
  if (!tail.empty()) out.parameters = {path_text("id", "Id of the webhook")};
  return out;
}

std::vector<NamedSchema> outbox_schemas() {
  using namespace schema;
  return {
      {"Webhook",
       object({{"id", text("Id of the webhook, 32 hexadecimal characters")},
               {"url", text("Address that the server calls")},
               {"kinds", array(one_of<NotificationKind>("Kind of event"), "Kinds of events")},
               {"made_utc_us", integer("us",
                                       "Time of creation, in microseconds since 1970-01-01 "
                                       "UTC")},
               {"made_by", text("Name of the account that made the webhook")}})},
      {"Delivery",
       object({{"id", text("Id of the delivery; the receiver gets it too, and it stays the same "
                           "when the delivery is sent again")},
               {"channel", one_of<store::Channel>("E-mail or webhook")},
               {"recipient", text("Id of the account or of the webhook")},
               {"state", one_of<store::DeliveryState>("State of the delivery")},
               {"attempts", integer("1", "Number of attempts so far")},
               {"made_utc_us", integer("us",
                                       "Time of the event, in microseconds since 1970-01-01 "
                                       "UTC")},
               {"due_utc_us", integer("us",
                                      "Time of the next attempt, in microseconds since "
                                      "1970-01-01 UTC")},
               {"changed_utc_us", integer("us",
                                          "Time of the last change, in microseconds since "
                                          "1970-01-01 UTC")},
               {"error", text("Why the last attempt failed; empty if it did not")}})},
      {"MailServer",
       object({{"server", text("Address of the mail server")},
               {"from", text("Address of the sender")},
               {"domains", array(text("Domain"), "The only domains of recipients; empty: any")}})},
      {"Outbox",
       object({{"mail", nullable(ref("MailServer"))},
               {"webhooks", array(ref("Webhook"), "Webhooks, oldest first")},
               {"waiting", integer("1", "Deliveries that wait")},
               {"sent_within_day", integer("1", "Deliveries sent within the last day")},
               {"given_up_within_week", integer("1", "Deliveries given up within the last week")},
               {"deliveries", array(ref("Delivery"), "Newest deliveries, at most 50")}})}};
}

}  // namespace

std::vector<RouteInfo> webhooks_routes() {
  using namespace schema;
  RouteInfo list = webhook_route("GET", "", "outbox",
                                 "List the webhooks and the newest deliveries of webhooks and "
                                 "e-mail",
                                 outbox_response);
  list.answer = "Outbox";
  list.schemas = outbox_schemas();
  RouteInfo add = webhook_route("POST", "", "addWebhook",
                                "Add a webhook: the server calls its address when something "
                                "happens, signed as Standard Webhooks states",
                                add_webhook_route);
  add.body = "NewWebhook";
  add.body_limit_bytes = kMaxWebhook_bytes;
  add.answer = "WebhookMade";
  add.schemas = {
      {"NewWebhook",
       object({{"url", text("Address to call, https")},
               {"kinds", array(one_of<NotificationKind>("Kind of event"), "Kinds of events")}})},
      {"WebhookMade", object({{"webhook", ref("Webhook")},
                              {"secret", text("Secret of the signatures, shown only in this "
                                              "answer")}})}};
  return {list, add,
          webhook_route("DELETE", "/{id}", "removeWebhook",
                        "Remove a webhook; what waits for it is withdrawn", remove_webhook_route),
          webhook_route("POST", "/{id}/test", "testWebhook",
                        "Send a test to a webhook, at most one a minute", test_webhook)};
}

}  // namespace api
}  // namespace tractus
