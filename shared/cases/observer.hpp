/// An ideal observer that palpates a tract: can a breach be told from whole bone by the force on
/// the hand, with this case's own model, probe and bone?
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "models/palpation_runtime.hpp"
#include "volume/tract.hpp"

namespace tractus::cases {

/// What a hand can tell, in standard deviations.
struct Perception {
  double force_weber = 0.10;         ///< JND of force: 7 % at 2.5 to 10 N [Pang1991]; here for less
  double force_threshold_N = 0.030;  ///< detection: 29 to 34 mN [King2010]
  double wander_m = 0.0004;          ///< of the hand in depth and lean; assumed
};

/// How the hand presses on a side wall.
enum class Motion {
  tilt,       ///< the probe turns about the mouth
  parallel,   ///< the handle moves aside
  tip_first,  ///< it moves aside and turns with the shank's bend, so that the tip bears (ADR-0043)
};
constexpr auto words(Motion) {
  return std::to_array<core::Word<Motion>>(
      {{Motion::tilt, "tilt"}, {Motion::parallel, "parallel"}, {Motion::tip_first, "tip_first"}});
}
/// With what a place is compared.
enum class Contrast {
  along,   ///< with the same wall 4 to 7 mm before and behind
  around,  ///< with the middle two of the four walls at this depth
};
constexpr auto words(Contrast) {
  return std::to_array<core::Word<Contrast>>(
      {{Contrast::along, "along"}, {Contrast::around, "around"}});
}
using core::name;

inline constexpr std::size_t kSideWalls = 4;  ///< the first of volume::kWalls
inline constexpr std::size_t kMotions = 3;

/// The force with which a tract answers slow presses, against each press, N.
struct Palpated {
  using Grid = std::vector<float>;  ///< [depth][lean]; NaN where the motion does not reach
  std::array<std::array<Grid, kSideWalls>, kMotions> side_N;
  std::array<Grid, 5> tap_N;  ///< [push], at five places of the end
};

/// How well a breach can be told. Upper bounds: the best lean, motion and contrast are taken.
struct Detectability {
  std::optional<double> k;  ///< d′ of a press against the same place without the breach
  std::optional<double> b;  ///< d′ of the breach against all places of this tract; not of the end
  std::optional<double> fa;  ///< d′ of the worst whole place, which passes for a breach
  std::optional<volume::Wall> fa_wall = {};        ///< where that is
  double fa_at_m = 0.0;                            ///< depth along the tract
  std::array<double, kSideWalls> fa_of_wall = {};  ///< the same of each wall's worst whole place
  std::optional<Motion> motion = {};
  std::optional<Contrast> contrast = {};
  double lean_m = 0.0;   ///< of the straight tip beyond the axis; at the end: beyond the end
  double force_N = 0.0;  ///< there, of whole bone, on the hand
};

/// Presses every side wall at every depth from `from_m` on, tilting about the mouth by at most 0.35
/// rad, moving aside by at most 30 mm, and so with the tip first, and taps the end from −3 to +14
/// mm. Quasi-static: each press starts from the shank's deflection in the one before, less deep.
///
/// R is the force against the press. The hand's wander blurs it in depth and lean: mean μ, variance
/// v. f is μ less what it is compared with (Contrast), the noise of a comparison
///
///     σ² = 1.5 t² + (w μ)² + ½ (v_whole + v_breached)         t, w: Perception
///     K  = (f_whole − f_breached) / σ                  the most within 1.5 mm of the breach
///     B  = (⟨f_whole⟩ − f_breached) / √(var f_whole + σ²)     ⟨⟩ and var over all places
///     FA = (⟨f_whole⟩ − min f_whole) / √(var f_whole + σ²)    there
///
/// as own (after signal detection theory); lean, motion and contrast are those of the greatest
/// min(K, B, B − FA + 2), leans at which the median R of whole bone is over 0.6 N left out. K of the
/// end is that of μ over taps. They are over tilt and parallel presses, where the shank may bear
/// instead of the tip; `foretold` is over presses with the tip first. Left out: torque, friction, the hand's impedance, dynamics. Not thread-safe.
class Observer {
 public:
  /// @param from_m  depth of the first place that is felt
  Observer(const models::PalpationModel& model, const volume::Tract& tract, double from_m);

  int depths() const noexcept { return depths_; }
  double depth_m(int i) const noexcept;
  /// Everything. Errors: those of PalpationRuntime::make.
  core::Result<Palpated> palpate(const volume::ForceField& field) const;
  /// What a breach of a side wall at `at_m`, or of the end, changes: other places are taken from
  /// `whole`.
  core::Result<Palpated> palpate_near(const volume::ForceField& field, const Palpated& whole,
                                      volume::Wall wall, double at_m) const;

  /// Means and variances under the wander of the hand.
  struct Felt {
    struct Grid {
      std::vector<float> mean_N, variance_N2;
    };
    std::array<std::array<Grid, kSideWalls>, kMotions> side;
    Grid tap;
  };
  Felt felt(const Palpated& palpated, const Perception& perception) const;

  /// Of a breach at `at_m` of a wall. `breached` may be `whole` itself for a tract whose whole twin
  /// is not known: then places within 7 mm of it count for no whole ones, and there is no K.
  Detectability detect(const Felt& whole, const Felt& breached, volume::Wall wall, double at_m,
                       const Perception& perception) const;
  /// Share of right answers that a hand is foretold of which the tip bears, as the simulated one
  /// presses, and which looks six times at what it answers from:
  ///
  ///     P = ∫ φ(x − d) Π Φ(x − m_i) dx                     [Hacker1979], there with all m_i = 0
  ///
  /// the chance that the evidence of the breach is the greatest of six answers, all normal. A side
  /// wall's breach has d = B, and as rivals the worst whole place of each other wall (m = its FA), a
  /// whole end that lacks something of 0.3 N, and "no breach"; an anterior one has d = K, more by
  /// what its whole end lacks. K, B, FA with noise of the mean of six looks.
  double foretold(const Felt& whole, const Felt& breached, volume::Wall wall, double at_m,
                  const Perception& perception) const;
  /// The greatest mean force of a tap within `within_m` beyond the end, N.
  double end_force_N(const Felt& whole, double within_m) const;

 private:
  void press(const models::PalpationRuntime& probe, std::size_t wall, int first, int last,
             Palpated& out) const;
  void tap(const models::PalpationRuntime& probe, Palpated& out) const;
  double feature(const Felt& felt, std::size_t motion, Contrast contrast, std::size_t wall, int i,
                 int j) const;
  Detectability of_side(const Felt& whole, const Felt& breached, std::size_t wall, double at_m,
                        const Perception& perception, std::span<const Motion> motions) const;
  Detectability of_end(const Felt& whole, const Felt& breached, const Perception& perception) const;

  models::PalpationModel model_;
  volume::Tract tract_;
  double from_m_;
  int depths_;
};

}  // namespace tractus::cases
