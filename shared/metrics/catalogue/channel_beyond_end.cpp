#include "metrics/drilled_channel.hpp"

namespace tractus {
namespace metrics {
namespace {
Score beyond(const Subject& subject) {
  Score score = channel_score(subject, "depth_m");
  if (!score.value) return score;
  if (!subject.tract) return {{}, "the planned tract is not known here"};
  *score.value -= subject.tract->length_m;
  return score;
}
}  // namespace

MetricInfo channel_beyond_end() {
  return {"channel_beyond_end",
          "Channel beyond the plan's end",
          "m",
          "Depth of the deepest voxel that lost half of itself, less the planned tract's length; "
          "negative where it ends before.",
          "own definition",
          trial::Rig::palpation,
          beyond,
          drills};
}

}  // namespace metrics
}  // namespace tractus
