/// A block of bone and a burr led by hand through it, for the tests of this folder.
#pragma once

#include <vector>

#include "drilling/erosion.hpp"

namespace tractus::drilling {

inline constexpr double kLength_m = 0.13;
inline const trial::ProbeShape kProbe{.length_m = kLength_m};

/// 1000 HU everywhere, voxels of `spacing_m`, V's origin in the middle voxel.
inline volume::Volume block(int edge, double spacing_m) {
  volume::Volume bone;
  bone.geometry.dims = {edge, edge, edge};
  bone.geometry.spacing_m = math::Vec3::Constant(spacing_m);
  bone.geometry.origin_m = math::Vec3::Constant(-spacing_m * (edge / 2));
  bone.intercept = -1024.0;
  bone.counts.assign(bone.geometry.voxel_count(), 2024);
  return bone;
}

/// A tick at 4 kHz with the straight probe along z, its tip at `tip_m`, and a push along it.
inline trial::Sample pressed(std::uint32_t tick, const math::Vec3& tip_m, float push_N) {
  trial::Sample sample;
  sample.tick = tick;
  sample.t_s = tick / 4000.0;
  sample.p_VH_m = {tip_m.x(), tip_m.y(), tip_m.z() - kLength_m};
  sample.force_N = {0.0f, 0.0f, -push_N};
  sample.flags = trial::kPressed;
  return sample;
}

/// `ticks` ticks from `from_m` to `to_m` at an even speed, and the tick they begin with.
inline std::vector<trial::Sample> stroke(std::uint32_t first_tick, const math::Vec3& from_m,
                                         const math::Vec3& to_m, std::uint32_t ticks,
                                         float push_N) {
  std::vector<trial::Sample> out;
  for (std::uint32_t i = 0; i <= ticks; ++i)
    out.push_back(pressed(first_tick + i, from_m + (double(i) / ticks) * (to_m - from_m), push_N));
  return out;
}

inline core::Result<Erosion> eroded(const volume::Volume& bone, const Burr& burr,
                                    const std::vector<trial::Sample>& samples,
                                    const Erosion::Take& changed = {}) {
  auto made = Erosion::make(bone, volume::TransferFunction::bone(), burr, kProbe);
  if (!made) return made;
  for (const trial::Sample& sample : samples) made->add(sample, changed);
  made->finish(changed);
  return made;
}

}  // namespace tractus::drilling
