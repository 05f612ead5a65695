#include "station/loop/placement.hpp"

#include <algorithm>

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

double enclosed_from_m(const volume::Volume& volume, const volume::TransferFunction& transfer,
                       const volume::Tract& tract) {
  constexpr double kDeepest_m = 0.020, kStep_m = 0.001, kOuter_m = 0.014;
  const volume::WallFinder finder(volume, transfer);
  const auto walled = [&](double at_m) {
    return std::ranges::all_of(volume::kWalls, [&](volume::Wall wall) {
      if (wall == volume::Wall::anterior) return true;
      const auto found = finder.wall_at(tract, wall, at_m);
      return found && found->outer_m <= kOuter_m;
    });
  };
  for (double at_m = 0.0; at_m <= std::min(kDeepest_m, tract.length_m); at_m += kStep_m)
    if (walled(at_m)) return at_m;
  return 0.0;
}

}  // namespace tractus::loop
