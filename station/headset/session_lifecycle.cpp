#include "station/headset/session_lifecycle.hpp"

#include <utility>

namespace tractus::headset {

LifecycleAction SessionLifecycle::on_state_changed(XrSessionState state) {
  if (over_) return LifecycleAction::none;
  state_ = state;
  switch (state) {
    case XR_SESSION_STATE_READY:
      if (running_) return LifecycleAction::none;
      running_ = true;
      return LifecycleAction::begin;
    case XR_SESSION_STATE_STOPPING:
      if (!running_) return LifecycleAction::none;
      running_ = false;
      return LifecycleAction::end;
    case XR_SESSION_STATE_EXITING:
      end("ended at the headset");
      return LifecycleAction::leave;
    case XR_SESSION_STATE_LOSS_PENDING:
      end("the runtime lost the session");
      return LifecycleAction::leave;
    default:
      return LifecycleAction::none;
  }
}

void SessionLifecycle::end(std::string why) {
  if (over_) return;
  over_ = true;
  running_ = false;
  why_ = std::move(why);
}

bool SessionLifecycle::visible() const {
  return running_ && (state_ == XR_SESSION_STATE_VISIBLE || state_ == XR_SESSION_STATE_FOCUSED);
}

}  // namespace tractus::headset
