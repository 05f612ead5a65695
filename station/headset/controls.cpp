#include "station/headset/controls.hpp"

#include <cstring>

namespace tractus::headset {

Controls::Controls(const Instance& instance, const Session& session) {
  hands_ = {instance.path("/user/hand/left"), instance.path("/user/hand/right")};
  attached_ = make_actions(instance) && attach(instance, session.handle());
}

Controls::~Controls() {
  for (const XrSpace grip : grips_)
    if (grip) xrDestroySpace(grip);
  if (set_) xrDestroyActionSet(set_);
}

bool Controls::make_actions(const Instance& instance) {
  auto set = typed<XrActionSetCreateInfo>(XR_TYPE_ACTION_SET_CREATE_INFO);
  std::strcpy(set.actionSetName, "station");
  std::strcpy(set.localizedActionSetName, "Tractus station");
  if (XR_FAILED(xrCreateActionSet(instance.handle(), &set, &set_))) return false;
  auto action = typed<XrActionCreateInfo>(XR_TYPE_ACTION_CREATE_INFO);
  action.actionType = XR_ACTION_TYPE_POSE_INPUT;
  std::strcpy(action.actionName, "grip");
  std::strcpy(action.localizedActionName, "Where the controller is");
  action.countSubactionPaths = 2;
  action.subactionPaths = hands_.data();
  if (XR_FAILED(xrCreateAction(set_, &action, &grip_))) return false;
  action.actionType = XR_ACTION_TYPE_BOOLEAN_INPUT;
  std::strcpy(action.actionName, "recentre");
  std::strcpy(action.localizedActionName, "Put the scene before me");
  return XR_SUCCEEDED(xrCreateAction(set_, &action, &recentre_));
}

bool Controls::attach(const Instance& instance, XrSession session) {
  const std::array<XrActionSuggestedBinding, 4> bindings{
      XrActionSuggestedBinding{grip_, instance.path("/user/hand/left/input/grip/pose")},
      XrActionSuggestedBinding{grip_, instance.path("/user/hand/right/input/grip/pose")},
      XrActionSuggestedBinding{recentre_, instance.path("/user/hand/left/input/select/click")},
      XrActionSuggestedBinding{recentre_, instance.path("/user/hand/right/input/select/click")}};
  auto suggested =
      typed<XrInteractionProfileSuggestedBinding>(XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING);
  suggested.interactionProfile = instance.path("/interaction_profiles/khr/simple_controller");
  suggested.countSuggestedBindings = static_cast<std::uint32_t>(bindings.size());
  suggested.suggestedBindings = bindings.data();
  if (XR_FAILED(xrSuggestInteractionProfileBindings(instance.handle(), &suggested))) return false;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    auto info = typed<XrActionSpaceCreateInfo>(XR_TYPE_ACTION_SPACE_CREATE_INFO);
    info.action = grip_;
    info.subactionPath = hands_[hand];
    info.poseInActionSpace.orientation.w = 1.0F;
    if (XR_FAILED(xrCreateActionSpace(session, &info, &grips_[hand]))) return false;
  }
  auto info = typed<XrSessionActionSetsAttachInfo>(XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO);
  info.countActionSets = 1;
  info.actionSets = &set_;
  return XR_SUCCEEDED(xrAttachSessionActionSets(session, &info));
}

Controls::State Controls::look(const Session& session, const Frame& frame) {
  State out;
  if (!attached_ || !session.lifecycle().focused()) return out;
  const XrActiveActionSet active{set_, XR_NULL_PATH};
  auto sync = typed<XrActionsSyncInfo>(XR_TYPE_ACTIONS_SYNC_INFO);
  sync.countActiveActionSets = 1;
  sync.activeActionSets = &active;
  if (xrSyncActions(session.handle(), &sync) != XR_SUCCESS) return out;
  auto ask = typed<XrActionStateGetInfo>(XR_TYPE_ACTION_STATE_GET_INFO);
  ask.action = recentre_;
  auto pressed = typed<XrActionStateBoolean>(XR_TYPE_ACTION_STATE_BOOLEAN);
  if (XR_SUCCEEDED(xrGetActionStateBoolean(session.handle(), &ask, &pressed)))
    out.recentre = pressed.isActive && pressed.changedSinceLastSync && pressed.currentState;
  constexpr XrSpaceLocationFlags kBoth =
      XR_SPACE_LOCATION_ORIENTATION_VALID_BIT | XR_SPACE_LOCATION_POSITION_VALID_BIT;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    auto where = typed<XrSpaceLocation>(XR_TYPE_SPACE_LOCATION);
    if (XR_SUCCEEDED(xrLocateSpace(grips_[hand], session.room(), frame.shown_at, &where)) &&
        (where.locationFlags & kBoth) == kBoth)
      out.X_SG[hand] = pose_of(where.pose);
  }
  return out;
}

}  // namespace tractus::headset
