/// A transfer function made ready for counts: eight voxels at a time, no table.
#pragma once

#include <cstdint>
#include <vector>

#include "volume/transfer_function.hpp"
#include "volume/volume.hpp"

namespace tractus::volume {

/// α of a count c as a sum of ramps, one for each sloping piece of the transfer function:
///
///     α(c) = base + Σ rise · clamp((c − start) · inverse_width − offset, 0, 1)
///
/// `start` is an integer, so that c − start is exact in single precision; `offset` is what was
/// rounded off it, in widths. Agrees with TransferFunction::opacity(intercept + slope · c) to a few
/// roundings of a float.
class OpacityRamps {
 public:
  OpacityRamps(const TransferFunction& transfer, double slope, double intercept);

  float opacity(std::uint16_t count) const noexcept;
  /// out[0 … n) = α(counts[0 … n)); neither needs alignment.
  void opacities(const std::uint16_t* counts, int n, float* out) const noexcept;

 private:
  struct Ramp {
    float start, inverse_width, offset, rise;
  };
  float base_ = 0.0f;
  std::vector<Ramp> ramps_;
};

}  // namespace tractus::volume
