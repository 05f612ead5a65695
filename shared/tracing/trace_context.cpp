#include "tracing/trace_context.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tractus {
namespace tracing {
namespace {

bool is_lower_hex(std::string_view text) {
  return std::ranges::all_of(
      text, [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
}

bool is_id_of(std::string_view text) {
  return is_lower_hex(text) && text.find_first_not_of('0') != std::string_view::npos;
}

}  // namespace

std::optional<SpanContext> parse_traceparent(std::string_view text) {
  constexpr std::size_t kSize = 55;  // "00-", 32, "-", 16, "-", 2
  if (text.size() != kSize || !text.starts_with("00-") || text[35] != '-' || text[52] != '-')
    return std::nullopt;
  const auto trace_id = text.substr(3, 32), span_id = text.substr(36, 16), flags = text.substr(53);
  if (!is_id_of(trace_id) || !is_id_of(span_id) || !is_lower_hex(flags)) return std::nullopt;
  const bool sampled = std::string_view("13579bdf").find(flags[1]) != std::string_view::npos;
  return SpanContext{std::string(trace_id), std::string(span_id), sampled};
}

std::string traceparent(const SpanContext& context) {
  return fmt::format("00-{}-{}-{:02x}", context.trace_id, context.span_id, int(context.sampled));
}

}  // namespace tracing
}  // namespace tractus
