#include <fmt/format.h>

#include <algorithm>

#include "metrics/drilled_channel.hpp"

namespace tractus {
namespace metrics {
namespace {
/// The farthest reach beyond a wall's outer face.
Score beyond_bone(const Subject& subject) {
  const core::Json* detail = drilled_detail(subject);
  if (!detail) return {{}, kCutShort};
  const auto channel = detail->find("channel");
  if (channel == detail->end() || !channel->is_object() || !channel->contains("beyond_m"))
    return {{}, "the station did not measure the channel"};
  const core::Json& walls = channel->at("beyond_m");
  Score most{{}, "the channel came to no place with a known wall"};
  for (const volume::Wall wall : volume::kWalls) {
    const auto found = walls.find(std::string(volume::name(wall)));
    if (found == walls.end() || !found->is_number()) continue;
    const double beyond_m = found->get<double>();
    if (most.value && beyond_m <= *most.value) continue;
    most = {beyond_m, fmt::format("{} the {} wall", beyond_m > 0.0 ? "through" : "nearest to",
                                  volume::name(wall))};
  }
  return most;
}
}  // namespace

MetricInfo channel_breach() {
  return {"channel_breach",
          "Channel beyond the bone",
          "m",
          "How far the channel reaches beyond the outer face of a wall, as the image shows it "
          "before the drilling; negative where it stays within, and then to the nearest face.",
          "own definition",
          trial::Rig::palpation,
          beyond_bone,
          drills};
}

}  // namespace metrics
}  // namespace tractus
