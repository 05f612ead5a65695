#include "server/http/head.hpp"

#include "core/try.hpp"

namespace tractus {
namespace http {
namespace {

/// A header that comes twice is one list (RFC 9110, section 5.3).
void add_header(RequestHead& head, std::string name, std::string value) {
  const auto [at, is_new] = head.headers.try_emplace(std::move(name), value);
  if (!is_new) at->second += ", " + value;
}

core::Result<void> check_framing(const Parser& parser, const RequestHead& head) {
  const auto& message = parser.get();
  if (message.count(boost::beast::http::field::host) != 1)
    return core::Error{core::Errc::bad_input, "exactly one Host header is expected"};
  if (message.count(boost::beast::http::field::transfer_encoding) == 0) return {};
  if (message.version() < 11 ||
      lower_case(std::string(head.header("transfer-encoding"))) != "chunked")
    return core::Error{core::Errc::bad_input,
                       "Transfer-Encoding: only chunked is allowed, and only in HTTP/1.1"};
  return {};
}

}  // namespace

std::string lower_case(boost::beast::string_view text) {
  std::string out(text);
  for (char& c : out)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return out;
}

core::Result<RequestHead> head_of(const Parser& parser, std::string peer, const Networks* proxies) {
  const auto& message = parser.get();
  RequestHead head;
  head.method = std::string(message.method_string());
  head.peer = std::move(peer);
  for (const auto& field : message)
    add_header(head, lower_case(field.name_string()), std::string(field.value()));
  TRY(check_framing(parser, head));
  if (const auto length = parser.content_length()) head.body_bytes = *length;
  if (proxies && proxies->contain(head.peer)) head.peer = forwarded_peer(head);
  const auto target = message.target();
  TRY(read_target({target.data(), target.size()}, head));
  return head;
}

}  // namespace http
}  // namespace tractus
