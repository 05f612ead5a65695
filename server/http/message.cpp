#include "server/http/message.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/json.hpp"
#include "core/trim.hpp"
#include "core/words.hpp"
#include "server/http/networks.hpp"

namespace tractus {
namespace http {
namespace {

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

core::Result<std::string> percent_decoded(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (c == '+') c = ' ';
    if (c == '%') {
      const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
      const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
      if (high < 0 || low < 0)
        return core::Error{core::Errc::bad_input, "the address has an invalid percent escape"};
      c = static_cast<char>(high * 16 + low);
      i += 2;
    }
    if (c == '\0') return core::Error{core::Errc::bad_input, "the address has a zero byte"};
    out.push_back(c);
  }
  return out;
}

std::string_view RequestHead::header(std::string_view lower_case_name) const {
  const auto found = headers.find(std::string(lower_case_name));
  return found == headers.end() ? std::string_view() : std::string_view(found->second);
}

std::string_view RequestHead::cookie(std::string_view name) const {
  std::string_view rest = header("cookie");
  while (!rest.empty()) {
    const auto end = std::min(rest.find(';'), rest.size());
    const std::string_view pair = core::trimmed(rest.substr(0, end));
    if (pair.size() > name.size() && pair.starts_with(name) && pair[name.size()] == '=')
      return pair.substr(name.size() + 1);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

core::Result<void> read_target(std::string_view target, RequestHead& head) {
  const auto mark = target.find('?');
  head.path = std::string(target.substr(0, mark));
  if (head.path.empty() || head.path.front() != '/')
    return core::Error{core::Errc::bad_input, "the address does not begin with /"};
  std::string_view rest = mark == std::string_view::npos ? "" : target.substr(mark + 1);
  while (!rest.empty()) {
    const auto end = std::min(rest.find('&'), rest.size());
    const std::string_view pair = rest.substr(0, end);
    const auto equals = std::min(pair.find('='), pair.size());
    auto key = percent_decoded(pair.substr(0, equals));
    auto value = percent_decoded(pair.substr(std::min(equals + 1, pair.size())));
    if (!key) return key.error();
    if (!value) return value.error();
    if (!key->empty() && !head.query.emplace(*key, *value).second)
      return core::Error{core::Errc::bad_input,
                         "the address has the parameter " + core::one_line(*key, 80) + " twice"};
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return {};
}

std::string_view Response::header(std::string_view name) const {
  const auto found = std::ranges::find(headers, name, [](const auto& pair) { return pair.first; });
  return found == headers.end() ? std::string_view() : std::string_view(found->second);
}

Response error_response(int status, std::string_view code, std::string_view text) {
  const core::Json json{{"error", core::one_line(text, 4000)}, {"code", code}};
  Response response{.status = status,
                    .headers = {},
                    .body = json.dump(-1, ' ', false, core::Json::error_handler_t::replace)};
  return response.with("Content-Type", "application/json").with("Cache-Control", "no-store"),
         response;
}

core::Result<std::optional<std::pair<std::uint64_t, std::uint64_t>>> byte_range(
    std::string_view header, std::uint64_t size) {
  using Range = std::optional<std::pair<std::uint64_t, std::uint64_t>>;
  if (!header.starts_with("bytes=") || header.find(',') != std::string_view::npos) return Range();
  header.remove_prefix(6);
  const auto dash = header.find('-');
  if (dash == std::string_view::npos) return Range();
  const auto first = whole_number(header.substr(0, dash));
  const auto last = whole_number(header.substr(dash + 1));
  const core::Error beyond{
      core::Errc::out_of_range,
      fmt::format("the requested range lies beyond the end of the file, which has {} bytes", size)};
  if (!first) {  // the last so many bytes
    if (!last || dash != 0) return Range();
    if (*last == 0 || size == 0) return beyond;
    return Range(std::pair(size - std::min(*last, size), size - 1));
  }
  if (!last && dash + 1 != header.size()) return Range();
  if (last && *last < *first) return Range();
  if (*first >= size) return beyond;
  return Range(std::pair(*first, std::min(last.value_or(size - 1), size - 1)));
}

std::optional<std::pair<std::uint64_t, std::uint64_t>> wanted_part(const RequestHead& request,
                                                                   std::uint64_t size,
                                                                   std::string_view entity_tag,
                                                                   Response& response) {
  response.with("Accept-Ranges", "bytes");
  const std::string_view condition = request.header("if-range");
  if (!condition.empty() && condition != entity_tag) return std::pair(std::uint64_t{0}, size);
  const auto range = byte_range(request.header("range"), size);
  if (!range) {
    response.status = 416;
    response.with("Content-Range", fmt::format("bytes */{}", size));
    return std::nullopt;
  }
  if (!*range) return std::pair(std::uint64_t{0}, size);
  const auto [first, last] = **range;
  response.status = 206;
  response.with("Content-Range", fmt::format("bytes {}-{}/{}", first, last, size));
  return std::pair(first, last - first + 1);
}

core::Result<Response> file_response(const std::filesystem::path& path, const RequestHead& request,
                                     std::string content_type) {
  std::error_code failure;
  const std::uint64_t size = std::filesystem::file_size(path, failure);
  if (failure || !std::filesystem::is_regular_file(path))
    return core::Error{core::Errc::not_found, "no such file"};
  Response response;
  response.with("Content-Type", std::move(content_type));
  if (const auto part = wanted_part(request, size, "", response))
    response.body = FileSlice{path, part->first, part->second};
  return response;
}

std::string forwarded_peer(const RequestHead& head) {
  std::string_view named = head.header("x-forwarded-for");
  if (const auto comma = named.rfind(','); comma != std::string_view::npos)
    named.remove_prefix(comma + 1);
  named.remove_prefix(std::min(named.find_first_not_of(' '), named.size()));
  return ip_address(std::string(named)) ? std::string(named) : head.peer;
}

}  // namespace http
}  // namespace tractus
