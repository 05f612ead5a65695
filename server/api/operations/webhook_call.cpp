#include "server/api/operations/webhook_call.hpp"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <fmt/format.h>
#include <sodium.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <memory>

#include "core/bytes.hpp"
#include "core/require.hpp"
#include "core/try.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::string_view kWebhookSecret = "whsec_";
constexpr std::size_t kMaxAnswer_bytes = 64 * 1024;

/// Not of the public internet (RFC 6890): this machine, private networks, link-local addresses with
/// the metadata services of clouds, multicast, and translations of IPv4 into IPv6.
const http::Networks& private_networks() {
  static const http::Networks kNetworks = [] {
    auto parsed = http::Networks::parse(
        {"0.0.0.0/8",       "10.0.0.0/8",     "100.64.0.0/10", "127.0.0.0/8",    "169.254.0.0/16",
         "172.16.0.0/12",   "192.0.0.0/24",   "192.0.2.0/24",  "192.168.0.0/16", "198.18.0.0/15",
         "198.51.100.0/24", "203.0.113.0/24", "224.0.0.0/3",   "::/128",         "::1",
         "64:ff9b::/96",    "100::/64",       "2001::/32",     "2001:db8::/32",  "2002::/16",
         "fc00::/7",        "fe80::/10",      "ff00::/8"});
    core::require(bool(parsed), "the private networks are networks");
    return *parsed;
  }();
  return kNetworks;
}

std::string text_of_address(const curl_sockaddr& address) {
  std::array<char, INET6_ADDRSTRLEN> out{};
  if (address.family == AF_INET)
    ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(&address.addr)->sin_addr, out.data(),
                out.size());
  else if (address.family == AF_INET6)
    ::inet_ntop(AF_INET6, &reinterpret_cast<const sockaddr_in6*>(&address.addr)->sin6_addr,
                out.data(), out.size());
  return out.data();
}

curl_socket_t open_allowed(void* allowed, curlsocktype, curl_sockaddr* address) {
  const auto& networks = *static_cast<const http::Networks*>(allowed);
  const std::string text = text_of_address(*address);
  if (text.empty() || (private_networks().contain(text) && !networks.contain(text)))
    return CURL_SOCKET_BAD;
  return ::socket(address->family, address->socktype | SOCK_CLOEXEC, address->protocol);
}

std::size_t count_bytes(char*, std::size_t one, std::size_t count, void* so_far) {
  auto& bytes = *static_cast<std::size_t*>(so_far);
  bytes += one * count;
  return bytes > kMaxAnswer_bytes ? 0 : one * count;
}

struct CleansCall {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreesHeaders {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using Headers = std::unique_ptr<curl_slist, FreesHeaders>;

Headers headers_of(const WebhookCall& call, const std::string& signature) {
  curl_slist* out = nullptr;
  for (const std::string& line :
       {std::string("Content-Type: application/json"), "webhook-id: " + call.id,
        "webhook-timestamp: " + std::to_string(call.at_s), "webhook-signature: " + signature,
        std::string("User-Agent: tractus-server")})
    out = curl_slist_append(out, line.c_str());
  return Headers(out);
}

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
  const bool clean = std::ranges::all_of(url, [](char c) { return c > 32 && c < 127; });
  const bool plain = url.starts_with("http://");
  if (!clean || url.size() > 2000 || !is_safe_address(url) ||
      (plain && !networks.contain(url.starts_with("http://[::1]") ? "::1" : "127.0.0.1")))
    return core::Error{core::Errc::bad_input, "body: /url: an https address is expected"};
  return {};
}

core::Result<void> call_webhook(const WebhookCall& call) {
  TRY(check_webhook_address(call.url, call.networks));
  const auto signature = TRY(webhook_signature(call.secret, call.id, call.at_s, call.body));
  const Headers headers = headers_of(call, signature);
  const std::unique_ptr<CURL, CleansCall> handle(curl_easy_init());
  CURL* curl = handle.get();
  std::size_t answered_bytes = 0;
  curl_easy_setopt(curl, CURLOPT_URL, call.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_PROXY, "");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(call.patience.count()));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(call.body.size()));
  curl_easy_setopt(curl, CURLOPT_POSTFIELDS, call.body.c_str());
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETFUNCTION, open_allowed);
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETDATA, const_cast<http::Networks*>(&call.networks));
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, count_bytes);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &answered_bytes);
  const CURLcode got = curl_easy_perform(curl);
  if (got != CURLE_OK)
    return core::Error{core::Errc::unavailable,
                       std::string("the receiver does not answer: ") + curl_easy_strerror(got)};
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  if (status >= 200 && status < 300) return {};
  return core::Error{core::Errc::unavailable,
                     "the receiver answered with the status " + std::to_string(status)};
}

}  // namespace api
}  // namespace tractus
