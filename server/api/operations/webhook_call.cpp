#include "server/api/operations/webhook_call.hpp"

#include <fmt/format.h>
#include <sodium.h>

#include <array>

#include "core/bytes.hpp"
#include "core/try.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::string_view kWebhookSecret = "whsec_";

}  // namespace

std::string new_webhook_secret() {
  return std::string(kWebhookSecret) + core::base64(core::random_bytes(32));
}

core::Result<std::string> webhook_signature(const std::string& secret, const std::string& id,
                                            std::int64_t at_s, const std::string& body) {
  const auto key = secret.starts_with(kWebhookSecret)
                       ? core::base64_decoded(secret.substr(kWebhookSecret.size()))
                       : std::nullopt;
  if (!key) return core::Error{core::Errc::bad_input, "the webhook's secret is none"};
  const std::string text = fmt::format("{}.{}.{}", id, at_s, body);
  std::array<unsigned char, crypto_auth_hmacsha256_BYTES> mac{};
  crypto_auth_hmacsha256_state state;
  crypto_auth_hmacsha256_init(&state, reinterpret_cast<const unsigned char*>(key->data()),
                              key->size());
  crypto_auth_hmacsha256_update(&state, reinterpret_cast<const unsigned char*>(text.data()),
                                text.size());
  crypto_auth_hmacsha256_final(&state, mac.data());
  return "v1," + core::base64(std::as_bytes(std::span(mac)));
}

core::Result<void> check_webhook_address(const std::string& url, const http::Networks& networks) {
  if (!is_callable(url, networks))
    return core::Error{core::Errc::bad_input, "body: /url: an https address is expected"};
  return {};
}

core::Result<void> call_webhook(const WebhookCall& call) {
  TRY(check_webhook_address(call.url, call.networks));
  const auto signature = TRY(webhook_signature(call.secret, call.id, call.at_s, call.body));
  const auto answer =
      fetch({.url = call.url,
             .body = call.body,
             .headers = {"Content-Type: application/json", "webhook-id: " + call.id,
                         "webhook-timestamp: " + std::to_string(call.at_s),
                         "webhook-signature: " + signature, "User-Agent: tractus-server"},
             .patience = call.patience,
             .networks = call.networks,
             .who = "the receiver"});
  if (!answer) return core::Error{core::Errc::unavailable, answer.error().what};
  if (answer->status >= 200 && answer->status < 300) return {};
  return core::Error{core::Errc::unavailable,
                     "the receiver answered with the status " + std::to_string(answer->status)};
}

}  // namespace api
}  // namespace tractus
