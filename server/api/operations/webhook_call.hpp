/// A call of a webhook, signed as Standard Webhooks 1.0 states: HMAC-SHA-256 over id, time and body.
#pragma once

#include <chrono>
#include <string>

#include "core/result.hpp"
#include "server/http/networks.hpp"

namespace tractus::api {

/// A new secret: "whsec_" and 32 random bytes in base64.
std::string new_webhook_secret();
/// "v1," and the base64 of HMAC-SHA-256 over "ID.SECONDS.BODY". Errors: bad_input for a text that is
/// no secret.
core::Result<std::string> webhook_signature(const std::string& secret, const std::string& id,
                                            std::int64_t at_s, const std::string& body);

/// Refuses an address that is not https; http is allowed to a loopback address that `networks`
/// contain. Errors: bad_input.
core::Result<void> check_webhook_address(const std::string& url, const http::Networks& networks);

struct WebhookCall {
  std::string url, secret;
  std::string id;  ///< of the delivery: the header webhook-id
  std::int64_t at_s = 0;
  std::string body;                            ///< JSON
  http::Networks networks;                     ///< private networks that may be called
  std::chrono::milliseconds patience{10'000};  ///< time limit from the start to the last byte
};
/// Sends it, without redirects, to a public address or one of `networks`: the address is checked
/// when it is connected to. Success: status 2xx. Errors: unavailable (try again), bad_input.
core::Result<void> call_webhook(const WebhookCall& call);

}  // namespace tractus::api
