#include "scenarios/version.hpp"

#include <fmt/format.h>

#include "core/clock.hpp"
#include "core/try.hpp"
#include "core/words.hpp"

namespace tractus {
namespace scenarios {
namespace {

using core::Errc;
using core::Error;
using core::Json;
using core::Result;

Error bad(const std::string& field, const char* why) {
  return {Errc::bad_input, fmt::format("/{}: {}", core::one_line(field), why)};
}

Result<void> apply(Json& json, const Change& change) {
  if (change.field == "format" || change.field.starts_with("origin"))
    return bad(change.field, "is written with the version, not set");
  // nlohmann throws on a pointer with a bad escape and on one that leads nowhere.
  try {
    json.at(Json::json_pointer("/" + change.field)) = change.value;
  } catch (const Json::exception&) {
    return bad(change.field, "names no field of a scenario's file");
  }
  return {};
}

}  // namespace

Result<Change> parse_change(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    return Error{Errc::bad_input,
                 fmt::format("'{}': FIELD=VALUE is expected, as bone/stiffness_N_per_m=9000",
                             core::one_line(text))};
  auto value = core::parse_json(text.substr(equals + 1), "value");
  if (!value)
    return Error{Errc::bad_input, fmt::format("'{}': the value must be JSON, as 9000 or [0.02]",
                                              core::one_line(text))};
  return Change{text.substr(0, equals), std::move(*value)};
}

Result<Scenario> next_version(const Scenario& parent, std::span<const Change> changes,
                              const std::string& who, std::int64_t when_utc_us) {
  Json json = parent.to_json();
  for (const Change& change : changes) TRY(apply(json, change));
  json["origin"] = {{"who", who}, {"when", core::utc_text(when_utc_us)}, {"parent", parent.id()}};
  return Scenario::from_json(json, "");
}

}  // namespace scenarios
}  // namespace tractus
