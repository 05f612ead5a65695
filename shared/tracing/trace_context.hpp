/// W3C Trace Context: to which trace a piece of work belongs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace tractus::tracing {

struct SpanContext {
  std::string trace_id;  ///< 32 hexadecimal characters in lower case, not all 0
  std::string span_id;   ///< 16 hexadecimal characters in lower case, not all 0
  bool sampled = true;   ///< whether the trace is recorded
};

/// The header `traceparent`, version 00 alone. Anything else is nothing: a new trace begins.
std::optional<SpanContext> parse_traceparent(std::string_view text);
/// "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01"
std::string traceparent(const SpanContext& context);

}  // namespace tractus::tracing
