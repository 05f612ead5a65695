#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <nlohmann/json.hpp>

#include "tracing/tracer.hpp"

namespace tractus {
namespace tracing {
namespace {

using namespace std::chrono_literals;

// The example of W3C Trace Context, section 3.2.
const std::string kExample = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";

TEST(Traceparent, OfTheStandardIsRead) {
  const auto context = parse_traceparent(kExample);
  ASSERT_TRUE(context);
  EXPECT_EQ(context->trace_id, "4bf92f3577b34da6a3ce929d0e0e4736");
  EXPECT_EQ(context->span_id, "00f067aa0ba902b7");
  EXPECT_TRUE(context->sampled);
  EXPECT_EQ(traceparent(*context), kExample);
  std::string other = kExample;
  other.replace(53, 2, "00");
  EXPECT_FALSE(parse_traceparent(other)->sampled);
  other.replace(53, 2, "03");  // flags of later levels beside it
  EXPECT_TRUE(parse_traceparent(other)->sampled);
}

// The W3C's own test suite (w3c/trace-context, test/test.py), and what an attacker might send.
// Departs from it: a later version ("cc") is not read, for only our own stations are believed.
TEST(Traceparent, AnythingElseIsNothing) {
  const std::string id = "12345678901234567890123456789012", span = "1234567890123456";
  for (const char* text :
       {"00-12345678901234567890123456789012-1234567890123456-01.",
        "00-12345678901234567890123456789012-1234567890123456-01-what-the-future-will-be-like",
        "cc-12345678901234567890123456789012-1234567890123456-01",
        "cc-12345678901234567890123456789012-1234567890123456-01.what-the-future-will-be-like",
        "ff-12345678901234567890123456789012-1234567890123456-01",
        ".0-12345678901234567890123456789012-1234567890123456-01",
        "0.-12345678901234567890123456789012-1234567890123456-01",
        "000-12345678901234567890123456789012-1234567890123456-01",
        "0-12345678901234567890123456789012-1234567890123456-01",
        "00-00000000000000000000000000000000-1234567890123456-01",
        "00-.2345678901234567890123456789012-1234567890123456-01",
        "00-1234567890123456789012345678901.-1234567890123456-01",
        "00-123456789012345678901234567890123-1234567890123456-01",
        "00-1234567890123456789012345678901-1234567890123456-01",
        "00-12345678901234567890123456789012-0000000000000000-01",
        "00-12345678901234567890123456789012-.234567890123456-01",
        "00-12345678901234567890123456789012-123456789012345.-01",
        "00-12345678901234567890123456789012-12345678901234567-01",
        "00-12345678901234567890123456789012-123456789012345-01",
        "00-12345678901234567890123456789012-1234567890123456-.0",
        "00-12345678901234567890123456789012-1234567890123456-0.",
        "00-12345678901234567890123456789012-1234567890123456-001",
        "00-12345678901234567890123456789012-1234567890123456-1"})
    EXPECT_FALSE(parse_traceparent(text)) << text;
  for (const std::string& text :
       {std::string(), std::string("00"), "00-" + std::string(31, '1') + "A-" + span + "-01",
        "00_" + id + "-" + span + "-01", "00-" + id + "_" + span + "-01",
        "00-" + id + "-" + span + "_01", kExample + ", " + kExample, kExample.substr(0, 54) + '\0',
        std::string(1 << 20, '0')})
    EXPECT_FALSE(parse_traceparent(text)) << text.substr(0, 200);
}

Environment of(std::map<std::string, std::string> variables) {
  return [variables = std::move(variables)](const std::string& name) {
    const auto found = variables.find(name);
    return found == variables.end() ? "" : found->second;
  };
}

TEST(TraceSettings, AreOffUnlessAnEndpointIsNamed) {
  for (const auto& variables : std::vector<std::map<std::string, std::string>>{
           {},
           {{"OTEL_SERVICE_NAME", "x"}},
           {{"OTEL_EXPORTER_OTLP_ENDPOINT", "http://c:4318"}, {"OTEL_SDK_DISABLED", "true"}},
           {{"OTEL_EXPORTER_OTLP_ENDPOINT", "http://c:4318"}, {"OTEL_TRACES_EXPORTER", "none"}}}) {
    const auto settings = read_settings(of(variables), "tractus-server");
    ASSERT_TRUE(settings);
    EXPECT_FALSE(settings->has_value());
  }
}

// The OpenTelemetry specification: OTLP exporter configuration, and resource attributes.
TEST(TraceSettings, FollowTheSpecification) {
  const auto settings = read_settings(
      of({{"OTEL_EXPORTER_OTLP_ENDPOINT", "http://collector:4318/mycollector/"},
          {"OTEL_EXPORTER_OTLP_HEADERS", "api-key=a%20key, second=2,\tthird=50%-1"},
          {"OTEL_EXPORTER_OTLP_TIMEOUT", "1500"},
          {"OTEL_RESOURCE_ATTRIBUTES", "deployment.environment.name=lab,service.name=other"},
          {"OTEL_SERVICE_NAME", "station-3"}}),
      "tractus-station");
  ASSERT_TRUE(settings && settings->has_value());
  const Settings& one = **settings;
  using Pairs = std::vector<std::pair<std::string, std::string>>;
  EXPECT_EQ(one.url, "http://collector:4318/mycollector/v1/traces");
  // A % is an escape before two hexadecimal digits alone [RFC 3986, 2.1].
  EXPECT_EQ(one.headers, (Pairs{{"api-key", "a key"}, {"second", "2"}, {"third", "50%-1"}}));
  EXPECT_EQ(one.timeout, 1500ms);
  EXPECT_EQ(one.resource,
            (Pairs{{"deployment.environment.name", "lab"}, {"service.name", "station-3"}}));
  const auto exact =
      read_settings(of({{"OTEL_EXPORTER_OTLP_ENDPOINT", "http://a:4318"},
                        {"OTEL_EXPORTER_OTLP_TRACES_ENDPOINT", "https://b/its/own/path"}}),
                    "tractus-server");
  ASSERT_TRUE(exact && exact->has_value());
  EXPECT_EQ((*exact)->url, "https://b/its/own/path");
  EXPECT_EQ((*exact)->resource, (Pairs{{"service.name", "tractus-server"}}));
}

TEST(TraceSettings, WhatIsWrongIsNamedWithoutItsValue) {
  for (const auto& [name, value] : std::vector<std::pair<std::string, std::string>>{
           {"OTEL_EXPORTER_OTLP_ENDPOINT", "collector-secret:4317"},
           {"OTEL_EXPORTER_OTLP_ENDPOINT", "http://user:secret@collector"},
           {"OTEL_EXPORTER_OTLP_PROTOCOL", "grpc"},
           {"OTEL_EXPORTER_OTLP_TIMEOUT", "10s"},
           {"OTEL_EXPORTER_OTLP_HEADERS", "secret"},
           {"OTEL_EXPORTER_OTLP_HEADERS", "key=secret%0d%0aHost: other"}}) {
    const auto settings =
        read_settings(of({{"OTEL_EXPORTER_OTLP_TRACES_ENDPOINT",
                           name.ends_with("ENDPOINT") ? "" : "http://c:4318/v1/traces"},
                          {name, value}}),
                      "tractus-server");
    ASSERT_FALSE(settings) << name << "=" << value;
    EXPECT_TRUE(settings.error().what.starts_with(name)) << settings.error().what;
    EXPECT_EQ(settings.error().what.find("secret"), std::string::npos);
  }
}

/// A collector whose answer a test sets; it notes what it was sent.
struct Peer {
  std::mutex mutex;
  std::vector<std::string> bodies;
  std::atomic<Delivery> answer = Delivery::taken;
  std::atomic<bool> hangs = false;
  Post post() {
    return [this](const std::string& body, std::chrono::milliseconds most,
                  const std::function<bool()>& ends) -> Delivered {
      const auto until = std::chrono::steady_clock::now() + most;
      while (hangs && !ends() && std::chrono::steady_clock::now() < until)
        std::this_thread::sleep_for(1ms);
      const std::lock_guard held(mutex);
      bodies.push_back(body);
      if (hangs) return {Delivery::away, "time is over"};
      return {answer, answer == Delivery::taken ? "" : "no"};
    };
  }
};

Settings quick() { return {.url = "http://c/v1/traces", .delay = 1ms}; }

void record(Tracer& tracer, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) Span(&tracer, "step", SpanKind::internal, {});
}

/// Waits for a thread of its own.
template <class Holds>
bool comes_true(Holds holds) {
  for (int tries = 0; tries < 5000 && !holds(); ++tries) std::this_thread::sleep_for(1ms);
  return holds();
}

TEST(Tracer, SendsWhatWasRecordedAndAtItsEndTheRest) {
  Peer peer;
  {
    Tracer tracer({.url = "http://c/v1/traces", .delay = 60'000ms}, peer.post(), [](auto&) {});
    record(tracer, Tracer::kMostSent + 1);
  }
  ASSERT_EQ(peer.bodies.size(), 2u);
  EXPECT_NE(peer.bodies[0].find("\"resourceSpans\""), std::string::npos);
}

TEST(Tracer, ADroppedSpanIsCountedAndNobodyWaits) {
  Peer peer;
  peer.hangs = true;
  std::vector<std::string> told;
  const auto begun = std::chrono::steady_clock::now();
  {
    Tracer tracer(quick(), peer.post(), [&](const std::string& why) { told.push_back(why); });
    record(tracer, Tracer::kMostWaiting + Tracer::kMostSent + 1000);
    EXPECT_LT(std::chrono::steady_clock::now() - begun, 1s);
    EXPECT_GE(tracer.counts().dropped, 1000u);
    EXPECT_EQ(tracer.counts().sent, 0u);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begun, Tracer::kLastTry + 1s);
  EXPECT_EQ(told, std::vector<std::string>{"time is over"});
}

TEST(Tracer, SendsAgainWhatACollectorThatWasAwayHadNotTaken) {
  Peer peer;
  peer.answer = Delivery::away;
  Tracer tracer(quick(), peer.post(), [](auto&) {});
  record(tracer, 3);
  EXPECT_TRUE(comes_true([&] {
    const std::lock_guard held(peer.mutex);
    return peer.bodies.size() >= 3;
  }));
  peer.answer = Delivery::taken;
  EXPECT_TRUE(comes_true([&] { return tracer.counts().sent == 3; }));
  EXPECT_EQ(tracer.counts().dropped, 0u);
}

TEST(Tracer, DoesNotSendAgainWhatWasRefused) {
  Peer peer;
  peer.answer = Delivery::refused;
  Tracer tracer(quick(), peer.post(), [](auto&) {});
  record(tracer, 1);
  EXPECT_TRUE(comes_true([&] { return tracer.counts().dropped == 1; }));
}

TEST(Span, OfATraceThatIsNotSampledAndWithoutATracerIsNone) {
  Peer peer;
  {
    Tracer tracer(quick(), peer.post(), [](auto&) {});
    const SpanContext unsampled{std::string(32, 'a'), std::string(16, 'b'), false};
    EXPECT_EQ(Span(&tracer, "x", SpanKind::server, unsampled).traceparent(), "");
    EXPECT_EQ(Span(nullptr, "x", SpanKind::server, parse_traceparent(kExample)).traceparent(), "");
  }
  EXPECT_TRUE(peer.bodies.empty());
}

// OTLP 1.x, examples/trace.json of opentelemetry-proto: the same span, its ids in lower case.
TEST(Otlp, WritesTheExampleOfTheStandard) {
  SpanRecord span{.context = {"5b8efff798038103d269b633813fc60c", "eee19b7ec3c1b174"},
                  .parent_id = "eee19b7ec3c1b173",
                  .name = "I'm a server span",
                  .kind = SpanKind::server,
                  .begun_utc_ns = 1544712660000000000,
                  .ended_utc_ns = 1544712661000000000,
                  .attributes = {{"my.span.attr", "some value"}}};
  const auto expected = nlohmann::json::parse(R"({"resourceSpans": [{"resource": {"attributes": [
    {"key": "service.name", "value": {"stringValue": "my.service"}}]}, "scopeSpans": [{"scope":
    {"name": "tractus"}, "spans": [{"traceId": "5b8efff798038103d269b633813fc60c", "spanId":
    "eee19b7ec3c1b174", "parentSpanId": "eee19b7ec3c1b173", "name": "I'm a server span",
    "startTimeUnixNano": "1544712660000000000", "endTimeUnixNano": "1544712661000000000", "kind": 2,
    "attributes": [{"key": "my.span.attr", "value": {"stringValue": "some value"}}],
    "status": {}}]}]}]})");
  EXPECT_EQ(nlohmann::json::parse(otlp_json({{"service.name", "my.service"}}, {span})), expected);
}

// OTLP specification, "Partial Success": a 64-bit integer, which JSON writes as a text.
TEST(Otlp, CountsWhatACollectorDidNotTake) {
  EXPECT_EQ(rejected_spans(R"({"partialSuccess":{"rejectedSpans":"3","errorMessage":"x"}})"), 3u);
  EXPECT_EQ(rejected_spans(R"({"partialSuccess":{"rejectedSpans":3}})"), 3u);
  for (const char* text : {"", "{}", "[]", "null", R"({"partialSuccess":{}})", "rubbish",
                           R"({"partialSuccess":7})", R"({"partialSuccess":{"rejectedSpans":{}}})"})
    EXPECT_EQ(rejected_spans(text), 0u) << text;
}

}  // namespace
}  // namespace tracing
}  // namespace tractus
