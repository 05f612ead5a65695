#include "metrics/drilled_channel.hpp"

namespace tractus::metrics {

MetricInfo channel_angle() {
  return {"channel_angle",
          "Channel off the plan's direction",
          "rad",
          "Angle between the principal axis of the voxels that lost half of themselves or more and "
          "the planned tract.",
          "own definition",
          trial::Rig::palpation,
          [](const Subject& subject) { return channel_score(subject, "angle_rad"); },
          drills};
}

}  // namespace tractus::metrics
