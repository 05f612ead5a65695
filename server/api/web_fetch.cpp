#include "server/api/web_fetch.hpp"

#include <arpa/inet.h>
#include <curl/curl.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace api {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::size_t kMost_bytes = 1u << 20;

struct Cleans {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreesHeaders {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};
using Headers = std::unique_ptr<curl_slist, FreesHeaders>;
struct FreesText {
  void operator()(char* text) const { curl_free(text); }
};

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

/// An answer on its way, and why it was ended.
struct Transfer {
  const Fetch& what;
  CURL* curl;
  Fetched got = {};
  std::optional<Error> ended = {};
};

void read_head(Transfer& transfer) {
  long status = 0;
  curl_easy_getinfo(transfer.curl, CURLINFO_RESPONSE_CODE, &status);
  const char* type = nullptr;
  curl_easy_getinfo(transfer.curl, CURLINFO_CONTENT_TYPE, &type);
  transfer.got.status = static_cast<int>(status);
  transfer.got.content_type = type ? type : "";
}

std::size_t take_bytes(char* bytes, std::size_t one, std::size_t count, void* into) {
  auto& transfer = *static_cast<Transfer*>(into);
  const std::string_view piece(bytes, one * count);
  read_head(transfer);
  std::string& body = transfer.got.body;
  if (transfer.what.take && transfer.got.status == 200) {
    const auto taken = transfer.what.take(transfer.got, piece);
    if (!taken) transfer.ended = taken.error();
  } else if (body.size() + piece.size() > kMost_bytes) {
    transfer.ended = Error{Errc::too_large, "the answer of " + transfer.what.who + " is too long"};
  } else {
    body.append(piece);
  }
  return transfer.ended ? 0 : piece.size();
}

int ask_may_go_on(void* of, curl_off_t, curl_off_t, curl_off_t, curl_off_t) {
  auto& transfer = *static_cast<Transfer*>(of);
  if (!transfer.what.may_go_on || transfer.what.may_go_on()) return 0;
  transfer.ended = Error{Errc::cancelled, "the transfer from " + transfer.what.who + " was ended"};
  return 1;
}

}  // namespace

bool is_safe_address(const std::string& url) {
  if (url.find('@') != std::string::npos) return false;  // what stands before it is no host
  if (url.starts_with("https://")) return true;
  for (const char* own : {"http://127.0.0.1", "http://localhost", "http://[::1]"}) {
    const std::string_view prefix(own);
    if (url.starts_with(prefix) &&
        (url.size() == prefix.size() || url[prefix.size()] == ':' || url[prefix.size()] == '/'))
      return true;
  }
  return false;
}

bool is_callable(const std::string& url, const http::Networks& networks) {
  const bool clean = std::ranges::all_of(url, [](char c) { return c > 32 && c < 127; });
  const bool plain = url.starts_with("http://");
  return clean && url.size() <= 2000 && is_safe_address(url) &&
         (!plain || networks.contain(url.starts_with("http://[::1]") ? "::1" : "127.0.0.1"));
}

std::string percent_encoded(const std::string& text) {
  if (text.empty()) return {};  // to libcurl, no length is that of a C string
  const std::unique_ptr<char, FreesText> out(
      curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size())));
  core::require(out != nullptr, "memory for an address");
  return out.get();
}

std::string with_query(std::string url,
                       const std::vector<std::pair<std::string, std::string>>& fields) {
  for (const auto& [key, value] : fields)
    url += (url.find('?') == std::string::npos ? "?" : "&") + key + "=" + percent_encoded(value);
  return url;
}

namespace {

/// The text of a POST; none: GET.
std::optional<std::string> posted(const Fetch& what) {
  if (!what.form) return what.body;
  std::string out;
  for (const auto& [key, value] : *what.form)
    out += (out.empty() ? "" : "&") + key + "=" + percent_encoded(value);
  return out;
}

Headers header_list(const std::vector<std::string>& lines) {
  curl_slist* out = nullptr;
  for (const std::string& line : lines) out = curl_slist_append(out, line.c_str());
  return Headers(out);
}

void limit_networks(CURL* curl, const http::Networks& networks) {
  curl_easy_setopt(curl, CURLOPT_PROXY, "");
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETFUNCTION, open_allowed);
  curl_easy_setopt(curl, CURLOPT_OPENSOCKETDATA, const_cast<http::Networks*>(&networks));
}

/// Where from, how long, and into what.
void set_transfer(CURL* curl, const Fetch& what, Transfer& transfer) {
  curl_easy_setopt(curl, CURLOPT_URL, what.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(what.patience.count()));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_bytes);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &transfer);
  curl_easy_setopt(curl, CURLOPT_XFERINFOFUNCTION, ask_may_go_on);
  curl_easy_setopt(curl, CURLOPT_XFERINFODATA, &transfer);
  curl_easy_setopt(curl, CURLOPT_NOPROGRESS, what.may_go_on ? 0L : 1L);
  if (what.silence.count() > 0) {
    curl_easy_setopt(curl, CURLOPT_CONNECTTIMEOUT, static_cast<long>(what.silence.count()));
    curl_easy_setopt(curl, CURLOPT_LOW_SPEED_TIME, static_cast<long>(what.silence.count()));
    curl_easy_setopt(curl, CURLOPT_LOW_SPEED_LIMIT, 1024L);
  }
}

void set_credentials(CURL* curl, const Fetch& what) {
  if (what.networks) limit_networks(curl, *what.networks);
  if (!what.user.empty()) {
    curl_easy_setopt(curl, CURLOPT_USERNAME, what.user.c_str());
    curl_easy_setopt(curl, CURLOPT_PASSWORD, what.password.c_str());
  }
  if (!what.authority.empty()) curl_easy_setopt(curl, CURLOPT_CAINFO, what.authority.c_str());
}

}  // namespace

Result<Fetched> fetch(const Fetch& what) {
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
  if (!is_safe_address(what.url))
    return Error{Errc::bad_input, "the address of " + what.who + " " + what.url.substr(0, 200) +
                                      ": https is expected"};
  const std::unique_ptr<CURL, Cleans> handle(curl_easy_init());
  CURL* curl = handle.get();
  Transfer transfer{what, curl};
  const auto body = posted(what);
  const Headers headers = header_list(what.headers);
  set_transfer(curl, what, transfer);
  if (body) {
    curl_easy_setopt(curl, CURLOPT_POSTFIELDSIZE, static_cast<long>(body->size()));
    curl_easy_setopt(curl, CURLOPT_POSTFIELDS, body->c_str());
  }
  if (headers) curl_easy_setopt(curl, CURLOPT_HTTPHEADER, headers.get());
  set_credentials(curl, what);
  const CURLcode got = curl_easy_perform(curl);
  if (transfer.ended) return *transfer.ended;
  if (got != CURLE_OK)
    return Error{Errc::unavailable, what.who + " does not answer: " + curl_easy_strerror(got)};
  read_head(transfer);
  return std::move(transfer.got);
}

Result<std::string> secret_in(const std::filesystem::path& path) {
  const auto held = TRY(core::read_file(path, 4096));
  std::string out(core::text_of(held));
  while (!out.empty() && out.back() <= ' ') out.pop_back();
  if (out.empty()) return Error{Errc::bad_input, path.string() + ": is empty"};
  return out;
}

}  // namespace api
}  // namespace tractus
