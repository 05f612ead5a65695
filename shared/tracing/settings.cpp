#include "tracing/settings.hpp"

#include <curl/curl.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <memory>

#include "core/trim.hpp"
#include "core/try.hpp"

namespace tractus {
namespace tracing {
namespace {

using Pairs = std::vector<std::pair<std::string, std::string>>;
constexpr std::size_t kMostPairs = 32, kMostText_bytes = 2048;

core::Error wrong_variable(const std::string& name, const std::string& what) {
  return {core::Errc::bad_input, name + ": " + what};
}

bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= 32 && c < 127; });
}

struct FreesText {
  void operator()(char* text) const { curl_free(text); }
};

/// "%20" is a space; a % without two digits stays.
std::string unescaped(std::string_view text) {
  if (text.empty()) return {};  // libcurl would look for the end itself
  int size = 0;
  const std::unique_ptr<char, FreesText> out(
      curl_easy_unescape(nullptr, text.data(), static_cast<int>(text.size()), &size));
  return out ? std::string(out.get(), static_cast<std::size_t>(size)) : std::string();
}

/// "key=value,key=value", the values percent-encoded.
core::Result<Pairs> pairs_in(const std::string& name, const std::string& text) {
  Pairs out;
  std::string_view rest = text;
  while (!rest.empty()) {
    const auto comma = std::min(rest.find(','), rest.size());
    const std::string_view one = core::trimmed(rest.substr(0, comma));
    rest.remove_prefix(std::min(comma + 1, rest.size()));
    if (one.empty()) continue;
    const auto equals = one.find('=');
    const auto key = core::trimmed(one.substr(0, equals));
    if (equals == std::string_view::npos || key.empty() || out.size() == kMostPairs)
      return wrong_variable(name, "at most 32 KEY=VALUE are expected, separated by commas");
    out.emplace_back(key, unescaped(core::trimmed(one.substr(equals + 1))));
    if (out.back().second.size() > kMostText_bytes || !is_printable(out.back().first) ||
        !is_printable(out.back().second))
      return wrong_variable(name, "a value is too long, or has characters other than ASCII");
  }
  return out;
}

/// The variables of traces alone have priority over those of all signals.
struct Named {
  std::string name, value;
};
Named exporter_variable(const Environment& environment, const std::string& tail) {
  const std::string own = "OTEL_EXPORTER_OTLP_TRACES_" + tail;
  if (auto value = environment(own); !value.empty()) return {own, value};
  return {"OTEL_EXPORTER_OTLP_" + tail, environment("OTEL_EXPORTER_OTLP_" + tail)};
}

core::Result<std::chrono::milliseconds> milliseconds_in(const Named& variable,
                                                        std::chrono::milliseconds fallback) {
  if (variable.value.empty()) return fallback;
  int value = 0;
  const char* end = variable.value.data() + variable.value.size();
  const auto [stopped, failure] = std::from_chars(variable.value.data(), end, value);
  if (failure != std::errc() || stopped != end || value < 1 || value > 60'000)
    return wrong_variable(variable.name, "1 to 60000 ms are expected");
  return std::chrono::milliseconds(value);
}

core::Result<std::string> address_in(const Environment& environment) {
  Named variable = exporter_variable(environment, "ENDPOINT");
  std::string& url = variable.value;
  if (url.empty()) return std::string();
  const bool web = url.starts_with("http://") || url.starts_with("https://");
  if (!web || url.size() > kMostText_bytes || !is_printable(url) ||
      url.find_first_of(" @#") != std::string::npos)
    return wrong_variable(variable.name, "http://HOST:PORT or https://HOST:PORT is expected");
  if (variable.name == "OTEL_EXPORTER_OTLP_ENDPOINT") {
    while (url.ends_with('/')) url.pop_back();
    url += "/v1/traces";
  }
  return url;
}

}  // namespace

Environment process_environment() {
  return [](const std::string& name) -> std::string {
    const char* value = std::getenv(name.c_str());
    return value ? value : "";
  };
}

core::Result<std::optional<Settings>> read_settings(const Environment& environment,
                                                    const std::string& service_name) {
  Settings out;
  if (environment("OTEL_SDK_DISABLED") == "true" || environment("OTEL_TRACES_EXPORTER") == "none")
    return std::optional<Settings>();
  out.url = TRY(address_in(environment));
  if (out.url.empty()) return std::optional<Settings>();
  const Named protocol = exporter_variable(environment, "PROTOCOL");
  if (!protocol.value.empty() && protocol.value != "http/json")
    return wrong_variable(protocol.name, "http/json is expected; others are not spoken");
  const Named headers = exporter_variable(environment, "HEADERS");
  out.headers = TRY(pairs_in(headers.name, headers.value));
  out.authority = exporter_variable(environment, "CERTIFICATE").value;
  out.timeout = TRY(milliseconds_in(exporter_variable(environment, "TIMEOUT"), out.timeout));
  const std::string delay = "OTEL_BSP_SCHEDULE_DELAY";
  out.delay = TRY(milliseconds_in({delay, environment(delay)}, out.delay));
  const std::string resource = "OTEL_RESOURCE_ATTRIBUTES";
  out.resource = TRY(pairs_in(resource, environment(resource)));
  std::string service = environment("OTEL_SERVICE_NAME");
  const auto named = std::ranges::find(out.resource, "service.name", &Pairs::value_type::first);
  if (service.empty()) service = named == out.resource.end() ? service_name : named->second;
  if (service.size() > kMostText_bytes || !is_printable(service))
    return wrong_variable("OTEL_SERVICE_NAME", "a short name in ASCII is expected");
  std::erase_if(out.resource, [](const auto& pair) { return pair.first == "service.name"; });
  out.resource.emplace_back("service.name", service);
  return std::optional(std::move(out));
}

}  // namespace tracing
}  // namespace tractus
