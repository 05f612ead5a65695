/// The lifecycle of an OpenXR session: which action each state change of the runtime requires.
#pragma once

#include <openxr/openxr.h>

#include <string>

namespace tractus::headset {

/// The action that a state change requires.
enum class LifecycleAction { none, begin, end, leave };

/// Pure: no call to the runtime is made here. The order is the runtime's
/// [OpenXR 1.0, 9.3 "Session Lifecycle"]:
///
///     IDLE → READY (begin) → SYNCHRONIZED ⇄ VISIBLE ⇄ FOCUSED → SYNCHRONIZED → STOPPING (end)
///     → IDLE → READY again, or EXITING (leave);  LOSS_PENDING (leave) from anywhere
class SessionLifecycle {
 public:
  LifecycleAction on_state_changed(XrSessionState state);
  /// The runtime, or what a call of it answered, ended it for good.
  void end(std::string why);

  bool running() const { return running_; }  ///< frames are to be made
  bool visible() const;                      ///< a person may see them
  bool focused() const { return state_ == XR_SESSION_STATE_FOCUSED; }
  bool over() const { return over_; }
  const std::string& why() const { return why_; }  ///< it is over

 private:
  XrSessionState state_ = XR_SESSION_STATE_UNKNOWN;
  bool running_ = false, over_ = false;
  std::string why_;
};

}  // namespace tractus::headset
