#include "server/http/multipart.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/require.hpp"
#include "core/try.hpp"

namespace tractus {
namespace http {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr std::size_t kMaxPartHead_bytes = 8192, kMaxPadding_bytes = 256;

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + 32) : c; });
  return out;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Takes what stands before the next semicolon that is outside quotation marks.
std::string_view next_field(std::string_view& rest) {
  bool quoted = false;
  std::size_t size = 0;
  for (; size < rest.size() && (quoted || rest[size] != ';'); ++size)
    if (rest[size] == '"') quoted = !quoted;
  const std::string_view out = trimmed(rest.substr(0, size));
  rest.remove_prefix(std::min(rest.size(), size + 1));
  return out;
}

/// Of the field Content-Type among the lines of a part's head; empty: it states none.
std::string part_type(std::string_view head) {
  while (!head.empty()) {
    const std::size_t end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    const std::size_t colon = line.find(':');
    if (colon != std::string_view::npos &&
        lower_case(trimmed(line.substr(0, colon))) == "content-type")
      return media_type_of(line.substr(colon + 1)).type;
    head.remove_prefix(std::min(head.size(), end + 2));
  }
  return {};
}

}  // namespace

MediaType media_type_of(std::string_view header) {
  MediaType out{lower_case(next_field(header)), {}};
  while (!header.empty()) {
    const std::string_view field = next_field(header);
    const std::size_t equals = field.find('=');
    if (equals == std::string_view::npos ||
        lower_case(trimmed(field.substr(0, equals))) != "boundary")
      continue;
    std::string_view value = trimmed(field.substr(equals + 1));
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
    out.boundary = value;
  }
  return out;
}

Multipart::Multipart(std::string_view boundary, std::string who, Sink sink)
    : delimiter_("\r\n--" + std::string(boundary)), who_(std::move(who)), sink_(std::move(sink)) {
  core::require(!boundary.empty() && boundary.size() <= kMaxBoundary, "the boundary was checked");
}

Error Multipart::wrong(std::string_view why) const {
  return {Errc::bad_input, fmt::format("{} sent a body that {}", who_, why)};
}

Result<void> Multipart::take(std::string_view piece) {
  held_.append(piece);
  while (TRY(step())) {
  }
  return {};
}

Result<void> Multipart::finish() const {
  if (state_ == State::after) return {};
  if (state_ == State::before) return wrong("has no part with the boundary that it states");
  return wrong("ends before its last boundary");
}

/// Whether there is more to do with what is held.
Result<bool> Multipart::step() {
  switch (state_) {
    case State::before:
    case State::body:
      return pass_bytes();
    case State::delimiter:
      return read_delimiter();
    case State::headers:
      return read_headers();
    case State::after:
      held_.clear();
  }
  return false;
}

/// Hands on a part's bytes up to the next delimiter, or those that cannot belong to one.
Result<bool> Multipart::pass_bytes() {
  const std::size_t at = held_.find(delimiter_);
  const bool found = at != std::string::npos;
  const std::size_t size =
      found ? at : held_.size() - std::min(held_.size(), delimiter_.size() - 1);
  const bool in_part = state_ == State::body;
  if (in_part && size > 0) TRY(sink_.bytes(std::string_view(held_).substr(0, size)));
  held_.erase(0, found ? size + delimiter_.size() : size);
  if (!found) return false;
  if (in_part) TRY(sink_.end());
  state_ = State::delimiter;
  return true;
}

Result<bool> Multipart::read_delimiter() {
  if (held_.size() < 2) return false;
  if (held_.starts_with("--")) {
    state_ = State::after;
    return true;
  }
  const std::size_t line = held_.find("\r\n");
  if (line == std::string::npos && held_.size() < kMaxPadding_bytes + 2) return false;
  if (line > kMaxPadding_bytes || !trimmed(std::string_view(held_).substr(0, line)).empty())
    return wrong("has a boundary that does not end its line");
  held_.erase(0, line);  // its CRLF stays: a head without lines is that CRLF and another
  state_ = State::headers;
  return true;
}

Result<bool> Multipart::read_headers() {
  const std::size_t end = held_.find("\r\n\r\n");
  if (end == std::string::npos && held_.size() < kMaxPartHead_bytes + 4) return false;
  if (end > kMaxPartHead_bytes)  // also where there is none
    return wrong("has a part whose headers have no end");
  TRY(sink_.begin(part_type(std::string_view(held_).substr(0, end))));
  held_.erase(0, end + 4);
  state_ = State::body;
  return true;
}

}  // namespace http
}  // namespace tractus
