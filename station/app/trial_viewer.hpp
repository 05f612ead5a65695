/// Shows a running trial and keeps a picture of it: reads the latest state, never the loop.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "station/headset/headset_thread.hpp"
#include "station/sensors/igtl_sender.hpp"
#include "station/session/palpation_rig.hpp"
#include "station/view/view.hpp"

namespace tractus::app {

enum class Show { none, window, offscreen, headset, headset_or_window };

/// How a running trial is displayed.
struct ViewOptions {
  Show show = Show::none;
  std::filesystem::path picture;  ///< where a PNG of the trial is left at its end; empty: none. A
                                  ///< picture without a view is drawn off screen
  std::filesystem::path data;     ///< the station's folder, which may hold an alignment of the room
  std::string device;             ///< that an alignment must be of
  std::optional<drilling::Burr> burr = {};  ///< the tool; none: a probe
  /// Where other programs may listen to the tool's pose and forces by OpenIGTLink:
  /// "ADDRESS:PORT" or "PORT" (on 127.0.0.1); empty: nowhere.
  std::string igtl_out = {};
};

class TrialViewer {
 public:
  /// Before the trial is made, so that nothing is left of it when there is nothing to look with.
  /// With a headset this returns when somebody sees the scene, or after a while. `prepared`
  /// outlives this. Errors: unavailable (no display, no OpenGL, no headset, a port in use),
  /// bad_input (alignment.json).
  static core::Result<TrialViewer> make(const session::PreparedCase& prepared,
                                        const ViewOptions& look);
  /// Whose state the headset shows, until `end_headset`, and OpenIGTLink sends. `live` outlives
  /// this.
  void follow(const loop::LiveState& live) { live_->store(&live); }

  /// Looks at the latest state, draws it when there is a view. False when a person closed the
  /// window.
  bool look(const session::TrialSnapshot& seen);
  /// The headset's figures, for the trial's report; null without one. Its view ends here.
  core::Json end_headset();
  /// Leaves the picture: the tip's whole way, and the probe where its tip was deepest; a burr,
  /// which would hide its channel there, where it had just left the bone. While the trial that was
  /// looked at is there.
  core::Result<void> leave_picture();

 private:
  TrialViewer() = default;
  view::Scene scene() const;
  core::Result<void> open(const ViewOptions& look);
  core::Result<void> open(view::Mode mode);
  core::Result<void> open_headset(const ViewOptions& look);
  core::Result<void> open_sender(const std::string& igtl_out);
  void tell_headset();
  void look_at_bone(loop::Drilling& drilling);

  const session::PreparedCase* prepared_ = nullptr;
  std::filesystem::path picture_;
  std::optional<drilling::Burr> burr_;
  std::unique_ptr<view::View> view_;
  using Followed = std::atomic<const loop::LiveState*>;
  std::shared_ptr<Followed> live_ = std::make_shared<Followed>(nullptr);  ///< the headset's too
  std::unique_ptr<headset::HeadsetThread> headset_;
  std::unique_ptr<sensors::IgtlSender> sender_;
  headset::DisplayState told_ = headset::DisplayState::shown;  ///< the last that was said of it
  // Of the trial that is looked at.
  const session::TipWay* way_ = nullptr;
  session::TipWay::Snapshot path_;
  loop::Drilling* drilling_ = nullptr;
  /// The bone as it is drilled; without a drilling the case's stands.
  struct Carved {
    std::mutex mutex;  ///< this thread writes, the headset's takes over; neither waits long
    std::optional<volume::Volume> bone;
    drilling::ErodedShares worn;
    std::optional<volume::Box> fresh;  ///< what the headset has not taken over yet
  };
  std::shared_ptr<Carved> carved_ = std::make_shared<Carved>();
  std::chrono::steady_clock::time_point next_look_at_bone_{};
};

}  // namespace tractus::app
