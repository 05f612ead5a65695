#include "station/headset/life.hpp"

#include <utility>

namespace headset {

Deed Life::heed(XrSessionState state) {
  if (over_) return Deed::none;
  state_ = state;
  switch (state) {
    case XR_SESSION_STATE_READY:
      if (running_) return Deed::none;
      running_ = true;
      return Deed::begin;
    case XR_SESSION_STATE_STOPPING:
      if (!running_) return Deed::none;
      running_ = false;
      return Deed::end;
    case XR_SESSION_STATE_EXITING:
      end("ended at the headset");
      return Deed::leave;
    case XR_SESSION_STATE_LOSS_PENDING:
      end("the runtime lost the session");
      return Deed::leave;
    default:
      return Deed::none;
  }
}

void Life::end(std::string why) {
  if (over_) return;
  over_ = true;
  running_ = false;
  why_ = std::move(why);
}

bool Life::visible() const {
  return running_ && (state_ == XR_SESSION_STATE_VISIBLE || state_ == XR_SESSION_STATE_FOCUSED);
}

}  // namespace headset
