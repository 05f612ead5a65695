/// Shows a running trial and keeps a picture of it: reads the latest state, never the loop.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "station/session/trial_run.hpp"
#include "station/view/view.hpp"

namespace app {

enum class Show { none, window, offscreen };

class Onlooker {
 public:
  /// @param picture  where a PNG of the trial is left at its end; empty: none. A picture without a
  /// view is drawn off screen. Errors: unavailable (no display, no OpenGL).
  static core::Result<Onlooker> make(const session::PreparedCase& prepared, Show show,
                                     std::filesystem::path picture);

  /// Looks at the latest state, draws it when there is a view. False when a person closed the
  /// window.
  bool look(const session::Glimpse& seen);
  /// Leaves the picture: the probe where its tip was deepest, and the tip's way. While the trial
  /// that was looked at is there.
  core::Result<void> leave_picture();

 private:
  struct Moment {
    view::ProbeState state;
    math::Vec3 tip_m;
  };
  Onlooker() = default;
  Moment moment(const loop::Live& live) const;
  core::Result<void> open(view::Mode mode);
  void look_at_bone(loop::Drilling& drilling);

  const session::PreparedCase* prepared_ = nullptr;
  std::filesystem::path picture_;
  std::unique_ptr<view::View> view_;
  std::vector<math::Vec3> path_m_;
  loop::Drilling* drilling_ = nullptr;  // of the trial that is looked at
  std::optional<volume::Volume> bone_;  // as it is drilled; without a drilling the case's stands
  int looks_ = 0;
  std::optional<Moment> deepest_;
};

}  // namespace app
