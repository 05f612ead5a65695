/// A session with the headset: its life, its frames, where the eyes are.
#pragma once

#include <array>
#include <memory>
#include <optional>

#include "station/headset/eyes.hpp"
#include "station/headset/graphics.hpp"
#include "station/headset/session_lifecycle.hpp"
#include "station/headset/swapchain.hpp"

namespace tractus::headset {

/// One frame between `begin_frame` and `end_frame`.
struct Frame {
  XrTime shown_at = 0;       ///< when it will be seen, on the runtime's clock
  XrDuration period_ns = 0;  ///< from one frame to the next
  bool wanted = false;       ///< somebody sees it: it is worth drawing
};

/// What was located for a frame. Where the headset is not tracked, the eyes stand in the head
/// instead of the room: only what hangs before the head can be drawn.
struct Located {
  std::array<XrView, 2> views{};
  std::array<Eye, 2> eyes{};  ///< X_VE is X_SE here, in `space`; the left one first
  math::Pose X_SW;            ///< the head, between the eyes
  XrSpace space = XR_NULL_HANDLE;
  bool tracked = false;
};

/// Used by one thread, in which the graphics' context is current. What a call answers that ends the
/// session (lost, instance lost) is kept in `life`, not returned as an Error.
class Session {
 public:
  /// The session, its spaces (the room is STAGE, else LOCAL) and a swapchain an eye. Errors:
  /// unavailable.
  static core::Result<std::unique_ptr<Session>> make(const Instance& instance,
                                                     const Graphics& graphics);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// Takes in what the runtime has said since, and begins or ends the session as it asks.
  void process_events();
  /// Asks the runtime to end the session; `heed` and frames go on until it has.
  void ask_to_leave();

  /// Waits as long as the runtime sees fit. Nothing when the session is over.
  std::optional<Frame> begin_frame();
  /// Nothing when the session is over.
  std::optional<Located> locate(const Frame& frame);
  /// Shows what was drawn for both eyes; null: nothing.
  void end_frame(const Frame& frame, const Located* drawn);

  /// Ends what is of no use any more.
  void give_up(const std::string& why) { lifecycle_.end(why); }

  const SessionLifecycle& lifecycle() const { return lifecycle_; }
  Swapchain& pictures(std::size_t eye) { return pictures_[eye]; }
  XrSession handle() const { return handle_; }
  XrSpace room() const { return room_; }
  /// STAGE: the frame that a room alignment is in. LOCAL is another one in every session.
  bool in_stage() const { return in_stage_; }
  int width_px() const { return width_px_; }
  int height_px() const { return height_px_; }

 private:
  explicit Session(const Instance& instance) : instance_(instance) {}
  core::Result<void> open(const Graphics& graphics);
  core::Result<void> make_spaces();
  core::Result<void> make_pictures();
  void on_state_changed(XrSessionState state);
  /// True when the call went well; else the session is over.
  bool went(const char* what, XrResult result);

  const Instance& instance_;
  XrSession handle_ = XR_NULL_HANDLE;
  XrSpace room_ = XR_NULL_HANDLE, head_ = XR_NULL_HANDLE;
  bool in_stage_ = false;
  int width_px_ = 0, height_px_ = 0;
  std::vector<Swapchain> pictures_;
  SessionLifecycle lifecycle_;
};

math::Pose pose_of(const XrPosef& pose);

}  // namespace tractus::headset
