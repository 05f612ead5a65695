/// Whether and where traces are sent: the environment variables of OpenTelemetry.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"

namespace tractus::tracing {

struct Settings {
  std::string url;                                                ///< ends in /v1/traces
  std::vector<std::pair<std::string, std::string>> headers = {};  ///< secrets; never written
  std::filesystem::path authority = {};                           ///< PEM file; empty: the system's
  std::chrono::milliseconds timeout{10'000};                      ///< for one request
  std::chrono::milliseconds delay{5'000};  ///< from a span to the request that sends it
  /// Of the resource: service.name and what OTEL_RESOURCE_ATTRIBUTES says.
  std::vector<std::pair<std::string, std::string>> resource = {};
};

/// The value of an environment variable; empty if it is not set.
using Environment = std::function<std::string(const std::string& name)>;
Environment process_environment();

/// Nothing unless OTEL_EXPORTER_OTLP_ENDPOINT (or …_TRACES_ENDPOINT) is set. Errors: bad_input,
/// naming the variable, but not the value of one that may hold a secret.
core::Result<std::optional<Settings>> read_settings(const Environment& environment,
                                                    const std::string& service_name);

}  // namespace tractus::tracing
