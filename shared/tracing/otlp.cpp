#include "tracing/otlp.hpp"

#include <charconv>

namespace tractus {
namespace tracing {
namespace {

/// A 64-bit integer is a text in the JSON of protobuf.
core::Json attribute(const std::string& key, const core::Json& value) {
  if (value.is_number_integer())
    return {{"key", key}, {"value", {{"intValue", std::to_string(value.get<std::int64_t>())}}}};
  return {{"key", key}, {"value", {{"stringValue", value}}}};
}

core::Json span_json(const SpanRecord& span) {
  core::Json attributes = core::Json::array();
  for (const auto& [key, value] : span.attributes.items())
    attributes.push_back(attribute(key, value));
  core::Json out{{"traceId", span.context.trace_id},
                 {"spanId", span.context.span_id},
                 {"name", span.name},
                 {"kind", int(span.kind)},
                 {"startTimeUnixNano", std::to_string(span.begun_utc_ns)},
                 {"endTimeUnixNano", std::to_string(span.ended_utc_ns)},
                 {"attributes", std::move(attributes)},
                 {"status", core::Json::object()}};
  if (!span.parent_id.empty()) out["parentSpanId"] = span.parent_id;
  if (span.failed) out["status"] = {{"code", 2}};  // STATUS_CODE_ERROR
  return out;
}

}  // namespace

std::string otlp_json(const std::vector<std::pair<std::string, std::string>>& resource,
                      const std::vector<SpanRecord>& spans) {
  core::Json attributes = core::Json::array(), listed = core::Json::array();
  for (const auto& [key, value] : resource) attributes.push_back(attribute(key, value));
  for (const SpanRecord& span : spans) listed.push_back(span_json(span));
  core::Json scope{{"scope", {{"name", "tractus"}}}, {"spans", std::move(listed)}};
  core::Json one{{"resource", {{"attributes", std::move(attributes)}}},
                 {"scopeSpans", core::Json::array({std::move(scope)})}};
  const core::Json all{{"resourceSpans", core::Json::array({std::move(one)})}};
  return all.dump(-1, ' ', false, core::Json::error_handler_t::replace);
}

std::uint64_t rejected_spans(std::string_view answer) {
  const auto json = core::parse_json(answer, "answer of the collector");
  if (!json || !json->is_object()) return 0;
  const core::Json part = json->value("partialSuccess", core::Json());
  if (!part.is_object() || !part.contains("rejectedSpans")) return 0;
  const core::Json& count = part["rejectedSpans"];
  if (count.is_number_unsigned()) return count.get<std::uint64_t>();
  std::uint64_t out = 0;
  if (count.is_string()) {
    const auto text = count.get<std::string>();
    std::from_chars(text.data(), text.data() + text.size(), out);
  }
  return out;
}

}  // namespace tracing
}  // namespace tractus
