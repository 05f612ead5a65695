/// What the caller is told of by e-mail: nothing, until the caller chooses.
#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "server/api/backend.hpp"
#include "server/api/operations/notification_text.hpp"
#include "server/api/operations/notifier.hpp"
#include "server/api/route.hpp"
#include "server/api/schema.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;
using store::NotificationDelivery;
using store::NotificationKind;

constexpr std::uint64_t kMaxNotifications_bytes = 8192;
constexpr std::int64_t kTestEvery_us = 60'000'000;

const MailSettings* mail_of(const Call& call) {
  const Notifier* notifier = call.backend.notifier;
  return notifier && notifier->settings().mail ? &*notifier->settings().mail : nullptr;
}

Result<http::Response> own_notifications(const Call& call) {
  store::NotificationChoices choices;
  std::string address;
  TRY(call.backend.store.read([&](store::Reading& tx) -> Result<void> {
    choices = TRY(store::notification_choices(tx, call.caller.id));
    address = TRY(store::notification_address(tx, call.caller.id));
    return {};
  }));
  Json list = Json::array();
  for (const NotificationKind kind : store::kinds_for(call.caller.role)) {
    const auto chosen = std::ranges::find(choices, kind, [](const auto& one) { return one.first; });
    list.push_back(
        {{"kind", name(kind)},
         {"meaning", meaning(kind)},
         {"delivery", name(chosen == choices.end() ? NotificationDelivery::off : chosen->second)}});
  }
  return json_response(
      {{"mail", mail_of(call) != nullptr}, {"address", core::or_null(address)}, {"choices", list}});
}

/// The choices of the body; kinds that it leaves out are off.
store::NotificationChoices choices_field(core::Fields& fields, Role role) {
  store::NotificationChoices out;
  const Json* given = fields.member("choices");
  if (!given) return out;
  const auto kinds = store::kinds_for(role);
  if (!given->is_array() || given->size() > kinds.size()) {
    fields.wrong("choices", "an array of choices is expected");
    return out;
  }
  for (const Json& one : *given) {
    const bool whole = one.is_object() && one.size() == 2;
    const auto kind =
        core::from_name<NotificationKind>(whole ? core::text_member(one, "kind") : "");
    const auto delivery =
        core::from_name<NotificationDelivery>(whole ? core::text_member(one, "delivery") : "");
    const bool twice =
        kind && std::ranges::count(out, *kind, [](const auto& before) { return before.first; }) > 0;
    if (!kind || !delivery || twice || std::ranges::count(kinds, *kind) == 0)
      fields.wrong("choices",
                   "each needs a kind that your role may choose, once, and a delivery: " +
                       core::names_listed<NotificationDelivery>());
    else
      out.emplace_back(*kind, *delivery);
  }
  return out;
}

Result<http::Response> set_notifications(const Call& call) {
  const auto json = TRY(core::parse_json(call.request.body, "body"));
  core::Fields fields(json, "body");
  const std::string address = fields.text_or("address", "", 254);
  const auto choices = choices_field(fields, call.caller.role);
  if (!address.empty() && !is_mail_address(address))
    fields.wrong("address", "an e-mail address is expected, for example name@example.org");
  else if (const MailSettings* mail = mail_of(call);
           mail && !address.empty() && !allows_recipient(*mail, address))
    fields.wrong("address", fmt::format("this server sends mail only to addresses of {}",
                                        fmt::join(mail->domains, ", ")));
  TRY(fields.done());
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    TRY(store::set_notification_address(tx, call.caller.id, address));
    return store::set_notification_choices(tx, call.caller.id, choices);
  }));
  return own_notifications(call);
}

Result<http::Response> test_notification(const Call& call) {
  if (!mail_of(call))
    return Error{Errc::conflict, "this server has no mail server: an administrator states it"};
  const std::int64_t now = call.backend.now_utc_us();
  TRY(call.backend.store.write([&](store::Writing& tx) -> Result<void> {
    const auto address = TRY(store::notification_address(tx, call.caller.id));
    if (address.empty()) return Error{Errc::conflict, "save your e-mail address first"};
    // A minute has one test: whoever asks again has the same.
    return store::note_event(
        tx, {.id = {},
             .kind = NotificationKind::test,
             .key = "test/" + call.caller.id + "/" + std::to_string(now / kTestEvery_us),
             .subject = call.caller.id,
             .at_utc_us = now});
  }));
  call.backend.notifier->wake();
  return http::Response{.status = 204, .headers = {}, .body = std::string()};
}

RouteInfo notification_route(std::string method, std::string id, std::string summary,
                             Result<http::Response> (*handle)(const Call&)) {
  return {.method = std::move(method),
          .path = "/api/v1/session/notifications",
          .id = std::move(id),
          .summary = std::move(summary),
          .who = {Role::admin, Role::director, Role::faculty, Role::researcher, Role::technician,
                  Role::trainee},
          .parameters = {},
          .body = "",
          .answer = "OwnNotifications",
          .schemas = {},
          .handle = handle};
}

}  // namespace

std::vector<RouteInfo> notifications_routes() {
  using namespace schema;
  const Json kind = one_of<NotificationKind>("Kind of event");
  const Json delivery = one_of<NotificationDelivery>(
      "off; immediate: a message for each event; daily: one message a day, at 06:00 UTC");
  RouteInfo own = notification_route(
      "GET", "ownNotifications", "Read of what the caller is told by e-mail", own_notifications);
  own.schemas = {
      {"NotificationOffered",
       object({{"kind", kind}, {"meaning", text("What happened")}, {"delivery", delivery}})},
      {"OwnNotifications",
       object({{"mail", truth("True if this server sends e-mail")},
               {"address", nullable(text("E-mail address; null if there is none"))},
               {"choices", array(ref("NotificationOffered"),
                                 "The events that the caller's role may choose")}})}};
  RouteInfo set = notification_route("POST", "setNotifications",
                                     "Choose of what the caller is told by e-mail, and at which "
                                     "address",
                                     set_notifications);
  set.body = "NotificationWish";
  set.body_limit_bytes = kMaxNotifications_bytes;
  set.schemas = {
      {"NotificationChoice", object({{"kind", kind}, {"delivery", delivery}})},
      {"NotificationWish",
       object(
           {{"address", optional(text("E-mail address; if it is missing, it is removed"))},
            {"choices", array(ref("NotificationChoice"), "Choices; what is left out is off")}})}};
  RouteInfo test =
      notification_route("POST", "testNotification",
                         "Send a test message to the caller's e-mail address, at most one a minute",
                         test_notification);
  test.path += "/test";
  test.answer = "";
  return {own, set, test};
}

}  // namespace api
}  // namespace tractus
