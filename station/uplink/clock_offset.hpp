/// How far this station's clock is from its server's.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>

#include "core/clock.hpp"
#include "station/uplink/server.hpp"

namespace tractus::uplink {

struct ClockOffset {
  double offset_s = 0.0;  ///< server's clock less the station's
  double error_s = 0.0;   ///< its error is no larger than that: half the shortest round trip
  std::int64_t at_utc_us = 0;

  core::Json to_json() const;
};

/// Asks the server's clock kTries times and takes the answer with the shortest round trip
/// [RFC 5905 section 10: the sample of least delay]: offset = server − (sent + received)/2, and the
/// true one lies within half that round trip. Errors: the server's, bad_input.
/// @param utc_us  this station's clock
core::Result<ClockOffset> measure_clock(Server& server, core::Clock& clock,
                                        const std::function<std::int64_t()>& utc_us);
inline constexpr int kTries = 8;

/// clock.json in a station's folder; what cannot be written is measured again next time.
void keep_clock(const std::filesystem::path& file, const ClockOffset& offset);
/// Nothing when there is none, or it is older than `most_age_us`.
std::optional<ClockOffset> kept_clock(const std::filesystem::path& file, std::int64_t now_utc_us,
                                      std::int64_t most_age_us);

}  // namespace tractus::uplink
