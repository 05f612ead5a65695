#include "station/loop/placement.hpp"

namespace tractus::loop {

math::Pose place_device(const volume::Tract& tract, double probe_length_m,
                        const math::Vec3& pose_offset_m) {
  math::Mat3 rotation;
  rotation.col(0) = -tract.axis;
  rotation.col(2) = tract.superior;
  rotation.col(1) = rotation.col(2).cross(rotation.col(0));
  return {tract.entry_m - probe_length_m * tract.axis - pose_offset_m, math::Quat(rotation)};
}

volume::Tract tract_in_device(const volume::Tract& tract_V, const math::Pose& X_VD,
                              const math::Vec3& pose_offset_m) {
  const math::Pose X_DV = X_VD.inverse();
  volume::Tract out = tract_V;
  out.entry_m = X_DV * math::Vec3(tract_V.entry_m - pose_offset_m);
  out.axis = X_DV.q * tract_V.axis;
  out.medial = X_DV.q * tract_V.medial;
  out.superior = X_DV.q * tract_V.superior;
  return out;
}

}  // namespace tractus::loop
