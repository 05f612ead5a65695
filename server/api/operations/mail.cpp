#include "server/api/operations/mail.hpp"

#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <memory>

#include "core/bytes.hpp"
#include "core/json.hpp"
#include "core/require.hpp"
#include "core/try.hpp"
#include "server/api/web_fetch.hpp"

namespace tractus {
namespace api {
namespace {

constexpr std::size_t kMaxAddress_bytes = 254;  // RFC 5321, section 4.5.3.1.3
constexpr std::size_t kMailLine = 76;           // RFC 2045, section 6.8

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return text;
}

std::string domain_of(const std::string& address) {
  return lower(address.substr(address.rfind('@') + 1));
}

std::vector<std::string> domains_field(core::Fields& fields) {
  std::vector<std::string> out;
  const core::Json* given = fields.member("domains", false);
  if (!given) return out;
  if (!given->is_array()) fields.wrong("domains", "an array of domains is expected");
  for (const core::Json& one : *given) {
    const std::string domain = one.is_string() ? lower(one.get<std::string>()) : "";
    if (!is_mail_address("x@" + domain)) fields.wrong("domains", "domains are expected");
    out.push_back(domain);
  }
  return out;
}

/// "Tue, 24 Nov 2026 18:00:00 +0000" (RFC 5322, section 3.3).
std::string date_of(std::int64_t utc_us) {
  const std::time_t seconds = utc_us / 1'000'000;
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  constexpr std::array kDays{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array kMonths{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                               "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  return fmt::format("{}, {:02} {} {} {:02}:{:02}:{:02} +0000",
                     kDays.at(std::size_t(parts.tm_wday)), parts.tm_mday,
                     kMonths.at(std::size_t(parts.tm_mon)), parts.tm_year + 1900, parts.tm_hour,
                     parts.tm_min, parts.tm_sec);
}

/// A subject as a header has it: ASCII as it is, other text as words in base64 of at most 75
/// characters (RFC 2047), each of whole characters.
std::string encoded_subject(std::string_view subject) {
  constexpr std::size_t kWord_bytes = 45;
  if (std::ranges::all_of(subject, [](char c) { return c >= 32 && c < 127; }))
    return std::string(subject);
  std::string out;
  while (!subject.empty()) {
    std::size_t size = std::min(kWord_bytes, subject.size());
    while (size < subject.size() && (subject[size] & 0xC0) == 0x80) --size;
    out += (out.empty() ? "=?utf-8?B?" : "\r\n =?utf-8?B?") +
           core::base64(core::bytes_of(subject.substr(0, size))) + "?=";
    subject.remove_prefix(size);
  }
  return out;
}

struct ReadsMessage {
  std::string_view left;
};
std::size_t give_bytes(char* into, std::size_t one, std::size_t count, void* from) {
  auto& reading = *static_cast<ReadsMessage*>(from);
  const std::size_t size = std::min(one * count, reading.left.size());
  std::copy_n(reading.left.data(), size, into);
  reading.left.remove_prefix(size);
  return size;
}

struct CleansMail {
  void operator()(CURL* handle) const { curl_easy_cleanup(handle); }
};
struct FreesList {
  void operator()(curl_slist* list) const { curl_slist_free_all(list); }
};

core::Error failure_of(CURL* curl, CURLcode code) {
  long status = 0;
  curl_easy_getinfo(curl, CURLINFO_RESPONSE_CODE, &status);
  const bool for_good = status >= 500 && status < 600 && code != CURLE_LOGIN_DENIED;
  return {for_good ? core::Errc::forbidden : core::Errc::unavailable,
          fmt::format("the mail server {} (status {}): {}",
                      for_good ? "refuses the message" : "does not accept the message", status,
                      curl_easy_strerror(code))};
}

}  // namespace

core::Result<MailSettings> read_mail_settings(const std::filesystem::path& path) {
  const auto json = TRY(core::read_json(path));
  core::Fields fields(json, path.string());
  const std::string format = fields.text("format");
  if (!format.empty() && format != "tractus-mail/1")
    fields.wrong("format", "tractus-mail/1 is expected");
  MailSettings out{.server = fields.text("server", 300),
                   .from = fields.text("from", 300),
                   .base = fields.text("base", 300),
                   .user = fields.text_or("user", "", 300)};
  const std::string password = fields.text_or("password_file", "");
  out.authority = fields.text_or("authority", "");
  out.domains = domains_field(fields);
  while (out.base.ends_with('/')) out.base.pop_back();
  if (!out.server.starts_with("smtps://") && !out.server.starts_with("smtp://"))
    fields.wrong("server", "smtps://HOST:PORT or smtp://HOST:PORT is expected");
  if (!is_mail_address(out.from)) fields.wrong("from", "an e-mail address is expected");
  if (!is_safe_address(out.base)) fields.wrong("base", "an https address is expected");
  if (out.user.empty() != password.empty())
    fields.wrong("user", "user and password_file are expected together");
  TRY(fields.done());
  if (!out.authority.empty()) out.authority = path.parent_path() / out.authority;
  if (!password.empty()) out.password = TRY(secret_in(path.parent_path() / password));
  return out;
}

bool is_mail_address(std::string_view text) {
  const auto at = text.find('@');
  if (at == std::string_view::npos || at == 0 || text.size() > kMaxAddress_bytes) return false;
  const auto fits = [](std::string_view part, std::string_view others) {
    return !part.empty() && part.front() != '.' && part.back() != '.' &&
           part.find("..") == std::string_view::npos && std::ranges::all_of(part, [&](char c) {
             return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                    others.find(c) != std::string_view::npos;
           });
  };
  return fits(text.substr(0, at), ".!#$%&'*+/=?^_`{|}~-") && fits(text.substr(at + 1), ".-");
}

bool allows_recipient(const MailSettings& settings, const std::string& address) {
  return is_mail_address(address) &&
         (settings.domains.empty() || std::ranges::count(settings.domains, domain_of(address)) > 0);
}

std::string message_of(const MailSettings& settings, const Mail& mail) {
  std::string out = fmt::format(
      "Date: {}\r\nFrom: Tractus <{}>\r\nTo: <{}>\r\nSubject: {}\r\nMessage-ID: <{}@{}>\r\n"
      "Auto-Submitted: auto-generated\r\nMIME-Version: 1.0\r\n"
      "Content-Type: text/plain; charset=utf-8\r\nContent-Transfer-Encoding: base64\r\n\r\n",
      date_of(mail.at_utc_us), settings.from, mail.to, encoded_subject(mail.subject), mail.id,
      domain_of(settings.from));
  const std::string text = core::base64(core::bytes_of(mail.text));
  for (std::size_t at = 0; at < text.size(); at += kMailLine)
    out += text.substr(at, kMailLine) + "\r\n";
  return out;
}

core::Result<void> send_mail(const MailSettings& settings, const Mail& mail) {
  if (!is_mail_address(mail.to))
    return core::Error{core::Errc::bad_input, "the e-mail address is none"};
  const bool one_line =
      std::ranges::none_of(mail.subject, [](char c) { return (c >= 0 && c < 32) || c == 127; });
  core::require(one_line, "a subject is one line");
  const std::string message = message_of(settings, mail);
  ReadsMessage reading{message};
  const std::unique_ptr<CURL, CleansMail> handle(curl_easy_init());
  CURL* curl = handle.get();
  const std::unique_ptr<curl_slist, FreesList> recipient(
      curl_slist_append(nullptr, ("<" + mail.to + ">").c_str()));
  curl_easy_setopt(curl, CURLOPT_URL, settings.server.c_str());
  curl_easy_setopt(curl, CURLOPT_PROTOCOLS_STR, "smtp,smtps");
  curl_easy_setopt(curl, CURLOPT_PROXY, "");
  curl_easy_setopt(curl, CURLOPT_USE_SSL, static_cast<long>(CURLUSESSL_ALL));
  curl_easy_setopt(curl, CURLOPT_TIMEOUT_MS, static_cast<long>(settings.patience.count()));
  curl_easy_setopt(curl, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(curl, CURLOPT_MAIL_FROM, ("<" + settings.from + ">").c_str());
  curl_easy_setopt(curl, CURLOPT_MAIL_RCPT, recipient.get());
  curl_easy_setopt(curl, CURLOPT_UPLOAD, 1L);
  curl_easy_setopt(curl, CURLOPT_READFUNCTION, give_bytes);
  curl_easy_setopt(curl, CURLOPT_READDATA, &reading);
  if (!settings.user.empty()) {
    curl_easy_setopt(curl, CURLOPT_USERNAME, settings.user.c_str());
    curl_easy_setopt(curl, CURLOPT_PASSWORD, settings.password.c_str());
  }
  if (!settings.authority.empty())
    curl_easy_setopt(curl, CURLOPT_CAINFO, settings.authority.c_str());
  const CURLcode got = curl_easy_perform(curl);
  if (got != CURLE_OK) return failure_of(curl, got);
  return {};
}

}  // namespace api
}  // namespace tractus
