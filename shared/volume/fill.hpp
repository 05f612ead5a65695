/// How a case's bone is prepared before the drill takes its channel: as the paper has it, or with
/// the marrow filled.
#pragma once

#include "core/named.hpp"
#include "core/result.hpp"
#include "volume/envelope.hpp"
#include "volume/transfer_function.hpp"

namespace tractus::volume {

enum class Preparation {
  published,  ///< the CT's own values [Zoller2020]: marrow below the transfer function is not felt
  filled,     ///< all that lies in the vertebra's envelope is felt, marrow weaker than cortex
};
constexpr auto words(Preparation) {
  using enum Preparation;
  return std::to_array<core::Word<Preparation>>({{published, "published"}, {filled, "filled"}});
}

inline constexpr double kLeastOpacity = 0.8;  ///< of what is filled

/// Raises what lies in the envelope, by its share s there, to the CT value of an opacity that grows
/// with density (own):
///
///     v′ = v + s · max(0, f(v) − v),   α(f(v)) = 1 − 0.2 (1 − c) (1 − clamp(v / v₁, 0, 1))
///
/// v₁ is where the transfer function first reaches its greatest opacity; c is the cortex's share: 1
/// within its thickness from the outer face (Envelope::depth), 0 from half a millimetre deeper on.
/// So cancellous bone keeps its order of density, the cortex, which most CTs blur to less than its
/// density [Treece2010], is whole again as thick as the scan shows it, and the outer face is as
/// smooth as the envelope.
class Filling {
 public:
  /// Errors: out_of_range: a transfer function that falls, or whose opacity stays below 1 − 10⁻⁹,
  /// or with v₁ ≤ 0.
  static core::Result<Filling> make(const TransferFunction& transfer);

  /// f(v), or v where that is more. @param cortex  c
  double filled(double value, double cortex = 0.0) const noexcept;
  /// Within kReach_m of the tract. Returns the box of the voxels that may have changed.
  Box fill(Volume& volume, const Envelope& envelope, const Tract& tract) const;

 private:
  explicit Filling(const TransferFunction& transfer, double full)
      : transfer_(transfer), full_(full) {}
  double value_of(double opacity) const noexcept;
  TransferFunction transfer_;
  double full_;  // v₁
};

}  // namespace tractus::volume
