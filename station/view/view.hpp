/// The picture of a trial: bone cut open along the tract, and the bent probe in it.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "core/result.hpp"
#include "drilling/erosion.hpp"
#include "laws/palpation_law.hpp"
#include "volume/tract.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume.hpp"

namespace tractus::view {

enum class Mode { window, offscreen };

/// What stands still.
struct Scene {
  const volume::Volume& volume;  ///< copied: may go after `View::make`
  const volume::TransferFunction& transfer;
  volume::Tract tract;
  laws::PalpationParameters probe;
  std::optional<drilling::Burr> burr = {};       ///< at the shank's end; none: the probe's points
  const drilling::ErodedShares* worn = nullptr;  ///< by an earlier drilling; copied
};

/// What moves.
struct ProbeState {
  math::Pose X_VH;                               ///< handle in V, the model's offset applied
  math::Vec2 deflection_m = math::Vec2::Zero();  ///< of the tip, in H
  math::Wrench wrench_H;                         ///< rendered
};

/// Owned and used by one thread that is not the loop's. The near half of the bone is cut away by
/// the plane through the tract's axis and the superior direction, seen from medial.
class View {
 public:
  /// Errors: unavailable (no display, no OpenGL).
  static core::Result<std::unique_ptr<View>> make(const Scene& scene, Mode mode, int width_px,
                                                  int height_px);
  ~View();

  /// Draws one picture of the state; `path_m` is the tip's way so far in V (thinned by the caller),
  /// drawn as a line.
  void draw(const ProbeState& state, std::span<const math::Vec3> path_m);
  /// The bone has changed within `box` (empty: nowhere): `volume` is the scene's as it is now, and
  /// `worn` all that was worn. Seen from the next picture on.
  void carve_away(const volume::Box& box, const volume::Volume& volume,
                  const drilling::ErodedShares& worn);
  /// The last picture as PNG.
  core::Result<void> save_png(const std::filesystem::path& path) const;
  /// Did a person close the window?
  bool closed() const;

 private:
  struct Parts;
  explicit View(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::view
