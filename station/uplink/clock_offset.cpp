#include "station/uplink/clock_offset.hpp"

#include <limits>

#include "core/try.hpp"

namespace tractus::uplink {

core::Json ClockOffset::to_json() const {
  return {{"offset_s", offset_s}, {"error_s", error_s}, {"at_utc_us", at_utc_us}};
}

core::Result<ClockOffset> measure_clock(Server& server, core::Clock& clock,
                                        const std::function<std::int64_t()>& utc_us) {
  const Request request{.method = "GET", .path = "/api/v1/time", .max_answer_bytes = 4096};
  core::Instant_ns shortest = std::numeric_limits<core::Instant_ns>::max();
  ClockOffset out;
  for (int i = 0; i < kTries; ++i) {
    const std::int64_t sent_us = utc_us();
    const core::Instant_ns begun = clock.now();
    auto answer = server.send(request);
    const core::Instant_ns took = clock.now() - begun;
    if (!answer) return answer.error();
    auto json = TRY(json_of(request, *answer));
    core::Fields fields(json, "the server's time: ");
    const std::int64_t server_us = fields.integer("server_utc_us", 0, INT64_MAX);
    TRY(fields.done());
    if (took >= shortest) continue;
    shortest = took;
    const double half_s = static_cast<double>(took) * 0.5e-9;
    out = {static_cast<double>(server_us - sent_us) * 1e-6 - half_s, half_s, sent_us};
  }
  return out;
}

void keep_clock(const std::filesystem::path& file, const ClockOffset& offset) {
  static_cast<void>(core::write_json(file, offset.to_json()).operator bool());
}

std::optional<ClockOffset> kept_clock(const std::filesystem::path& file, std::int64_t now_utc_us,
                                      std::int64_t most_age_us) {
  const auto json = core::read_json(file);
  if (!json) return std::nullopt;
  core::Fields fields(*json, file.string());
  const ClockOffset out{fields.number("offset_s", -1e10, 1e10), fields.number("error_s", 0.0, 1e10),
                        fields.integer("at_utc_us", 0, INT64_MAX)};
  if (!fields.done() || now_utc_us - out.at_utc_us > most_age_us) return std::nullopt;
  return out;
}

}  // namespace tractus::uplink
