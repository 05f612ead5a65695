/// Draws the trial's picture for an eye, with VTK, into a texture of the runtime's.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "station/headset/eyes.hpp"
#include "station/view/lent_context.hpp"
#include "station/view/view.hpp"

namespace tractus::headset {

/// Used by the one thread in which `context` is current. The objects are those of the window
/// (view::Picture); what is added are the controllers and words that hang before the head.
class Painter {
 public:
  /// Errors: unavailable (VTK cannot use the context).
  static core::Result<std::unique_ptr<Painter>> make(const view::Scene& scene,
                                                     const view::LentContext& context, int width_px,
                                                     int height_px);
  ~Painter();

  /// As view::View's.
  void carve_away(const volume::Box& box, const volume::Volume& volume,
                  const drilling::ErodedShares& worn);
  void pose(const view::ProbeState& state);
  void path(std::span<const math::Vec3> path_m);
  /// Grips in V; what is not there is not drawn.
  void grips(const std::array<std::optional<math::Pose>, 2>& X_VG);
  /// Words before the head, instead of the scene; empty: the scene.
  void say(const std::string& words);
  /// Draws as `eye` sees it and copies it to `texture`, of the size given to `make`.
  /// @param X_WE  the eye in the head, for words: they stand still in both eyes, a metre away
  core::Result<void> paint(const Eye& eye, const math::Pose& X_WE, unsigned texture);
  /// Time that the GPU spent on the pictures between two calls, s; nothing where it is not known
  /// yet. Asked for one frame later, so that nobody waits for it.
  std::optional<double> gpu_s();

 private:
  struct Parts;
  explicit Painter(std::unique_ptr<Parts> parts);
  std::unique_ptr<Parts> parts_;
};

}  // namespace tractus::headset
