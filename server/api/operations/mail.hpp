/// E-mail to one person by an SMTP server (RFC 5321), always with TLS.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::api {

/// "tractus-mail/1": {"format","server" ("smtps://HOST:465", or "smtp://HOST:587" with STARTTLS),
/// "from","base" (how browsers reach this server, "https://host:8480"),"user"?,"password_file"?
/// (relative to the settings),"authority"? (PEM file),"domains"? (the only domains of recipients)}.
struct MailSettings {
  std::string server, from, base, user = {}, password = {};
  std::filesystem::path authority = {};
  std::vector<std::string> domains = {};       ///< lower case; empty: any
  std::chrono::milliseconds patience{20'000};  ///< time limit for one message
};
/// Errors: those of reading; bad_input naming file and field.
core::Result<MailSettings> read_mail_settings(const std::filesystem::path& path);

/// "name@host": ASCII without blanks, controls and signs that have a meaning in a header.
bool is_mail_address(std::string_view text);
/// Whether the settings allow mail to this address.
bool allows_recipient(const MailSettings& settings, const std::string& address);

struct Mail {
  std::string id;  ///< of the delivery; it becomes the Message-ID
  std::string to;
  std::string subject;  ///< UTF-8, one line; never words that a person typed
  std::string text;     ///< UTF-8
  std::int64_t at_utc_us = 0;
};
/// The message (RFC 5322) with CRLF line ends; the text in base64.
std::string message_of(const MailSettings& settings, const Mail& mail);
/// Errors: forbidden (the server refused this message for good, status 5xx), unavailable (try
/// again), bad_input (the address is none).
core::Result<void> send_mail(const MailSettings& settings, const Mail& mail);

}  // namespace tractus::api
