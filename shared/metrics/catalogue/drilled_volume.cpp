#include "metrics/drilled_channel.hpp"

namespace tractus {
namespace metrics {
namespace {
Score removed(const Subject& subject) {
  const core::Json* detail = drilled_detail(subject);
  if (!detail) return {{}, kCutShort};
  const auto value = detail->find("removed_m3");
  if (value == detail->end() || !value->is_number()) return {{}, "the station did not say"};
  return {value->get<double>(), ""};
}
}  // namespace

MetricInfo drilled_volume() {
  return {"drilled_volume",
          "Bone drilled away",
          "m^3",
          "Sum over the voxels that had opacity of the share that the burr took, times a voxel.",
          "own definition",
          trial::Rig::palpation,
          removed,
          drills};
}

}  // namespace metrics
}  // namespace tractus
