#include "server/api/web_fetch.hpp"

#include <curl/curl.h>

#include <memory>
#include <mutex>

#include "core/require.hpp"

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
struct FreesText {
  void operator()(char* text) const { curl_free(text); }
};

std::size_t take_bytes(char* bytes, std::size_t one, std::size_t count, void* into) {
  auto& out = *static_cast<std::string*>(into);
  if (out.size() + one * count > kMost_bytes) return 0;
  out.append(bytes, one * count);
  return one * count;
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

std::string percent_encoded(const std::string& text) {
  if (text.empty()) return {};  // to libcurl, no length is that of a C string
  const std::unique_ptr<char, FreesText> out(
      curl_easy_escape(nullptr, text.data(), static_cast<int>(text.size())));
  core::require(out != nullptr, "memory for an address");
  return out.get();
}

Result<Fetched> fetch(const Fetch& what) {
  static std::once_flag once;
  std::call_once(once, [] { curl_global_init(CURL_GLOBAL_DEFAULT); });
  if (!is_safe_address(what.url))
    return Error{Errc::bad_input,
                 "the provider's address " + what.url.substr(0, 200) + ": https is expected"};
  const std::unique_ptr<CURL, Cleans> handle(curl_easy_init());
  CURL* curl = handle.get();
  Fetched out;
  std::string form;
  if (what.form)
    for (const auto& [key, value] : *what.form)
      form += (form.empty() ? "" : "&") + key + "=" + percent_encoded(value);
  curl_easy_setopt(curl, CURLOPT_URL, what.url.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(curl, CURLOPT_FOLLOWLOCATION, 0L);
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(what.patience.count()));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_WRITEFUNCTION, take_bytes);
  curl_easy_setopt(curl, CURLOPT_WRITEDATA, &out.body);
  if (what.form) curl_easy_setopt(curl, CURLOPT_POSTFIELDS, form.c_str());
  if (!what.user.empty()) {
    curl_easy_setopt(curl, CURLOPT_USERNAME, what.user.c_str());
    curl_easy_setopt(curl, CURLOPT_PASSWORD, what.password.c_str());
  }
  if (!what.authority.empty()) curl_easy_setopt(curl, CURLOPT_CAINFO, what.authority.c_str());
  const CURLcode got = curl_easy_perform(curl);
  if (got == CURLE_WRITE_ERROR) return Error{Errc::too_large, "the provider's answer is too long"};
  if (got != CURLE_OK)
    return Error{Errc::unavailable,
                 std::string("the provider does not answer: ") + curl_easy_strerror(got)};
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  out.status = static_cast<int>(status);
  return out;
}

}  // namespace api
}  // namespace tractus
