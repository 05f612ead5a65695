/// Spans in the JSON of OTLP 1.x (opentelemetry-proto, ExportTraceServiceRequest).
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/json.hpp"
#include "tracing/trace_context.hpp"

namespace tractus::tracing {

/// The numbers of OTLP.
enum class SpanKind { internal = 1, server = 2, client = 3, consumer = 5 };

/// A span that has ended.
struct SpanRecord {
  SpanContext context;
  std::string parent_id = {};  ///< empty: the trace begins with it
  std::string name;
  SpanKind kind = SpanKind::internal;
  std::int64_t begun_utc_ns = 0, ended_utc_ns = 0;
  core::Json attributes = core::Json::object();  ///< texts and integers
  bool failed = false;
};

/// One resource (texts) with its spans.
std::string otlp_json(const std::vector<std::pair<std::string, std::string>>& resource,
                      const std::vector<SpanRecord>& spans);

/// How many spans a collector says that it did not take, in its answer of status 200.
std::uint64_t rejected_spans(std::string_view answer);

}  // namespace tractus::tracing
