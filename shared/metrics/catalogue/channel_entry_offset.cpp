#include <cmath>

#include "metrics/drilled_channel.hpp"

namespace tractus {
namespace metrics {
namespace {
Score offset(const Subject& subject) {
  const core::Json* detail = drilled_detail(subject);
  if (!detail) return {{}, kCutShort};
  const auto channel = detail->find("channel");
  if (channel == detail->end() || !channel->is_object())
    return {{}, "the station did not measure the channel"};
  const auto at = channel->find("entry_offset_m");
  if (at == channel->end() || !at->is_array() || at->size() != 2 || !(*at)[0].is_number() ||
      !(*at)[1].is_number())
    return {{}, "the channel is too short, or there is none"};
  return {std::hypot((*at)[0].get<double>(), (*at)[1].get<double>()), ""};
}
}  // namespace

MetricInfo channel_entry_offset() {
  return {"channel_entry_offset",
          "Channel off the plan's entry",
          "m",
          "Distance from the planned entry to where the channel's axis meets the plane across the "
          "tract there.",
          "own definition",
          trial::Rig::palpation,
          offset,
          drills};
}

}  // namespace metrics
}  // namespace tractus
