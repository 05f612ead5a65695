/// Two controllers with a button each.
#include <map>

#include "tests/support/openxr/runtime.hpp"

namespace tractus {
namespace fakexr {
namespace {
const XrActionSet kSet = reinterpret_cast<XrActionSet>(0xac7);

XrResult XRAPI_CALL create_set(XrInstance, const XrActionSetCreateInfo* info, XrActionSet* out) {
  if (!is(info, XR_TYPE_ACTION_SET_CREATE_INFO)) return violation("xrCreateActionSet: wrong type");
  *out = kSet;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy_set(XrActionSet set) {
  World& w = world();
  if (set != kSet) return violation("xrDestroyActionSet: of none");
  for (Action* action : w.actions) delete action;
  w.actions.clear();
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create(XrActionSet set, const XrActionCreateInfo* info, XrAction* out) {
  World& w = world();
  if (set != kSet || !is(info, XR_TYPE_ACTION_CREATE_INFO))
    return violation("xrCreateAction: set or type");
  if (w.actions_attached)
    return violation("xrCreateAction: the set is attached", XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  auto* made = new Action{info->actionType};
  w.actions.insert(made);
  *out = handle_of<XrAction>(made);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy(XrAction handle) {
  World& w = world();
  Action* action = object_of(w.actions, handle);
  if (!action) return violation("xrDestroyAction: of none", XR_ERROR_HANDLE_INVALID);
  w.actions.erase(action);
  delete action;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL suggest(XrInstance, const XrInteractionProfileSuggestedBinding* info) {
  World& w = world();
  if (!is(info, XR_TYPE_INTERACTION_PROFILE_SUGGESTED_BINDING) || info->countSuggestedBindings == 0)
    return violation("xrSuggestInteractionProfileBindings: type or count");
  if (w.actions_attached)
    return violation("xrSuggestInteractionProfileBindings: after the set was attached",
                     XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  for (std::uint32_t i = 0; i < info->countSuggestedBindings; ++i)
    if (!object_of(w.actions, info->suggestedBindings[i].action) ||
        info->suggestedBindings[i].binding == XR_NULL_PATH)
      return violation("xrSuggestInteractionProfileBindings: action or path");
  return XR_SUCCESS;
}

XrResult XRAPI_CALL attach(XrSession, const XrSessionActionSetsAttachInfo* info) {
  World& w = world();
  if (!is(info, XR_TYPE_SESSION_ACTION_SETS_ATTACH_INFO) || info->countActionSets != 1 ||
      info->actionSets[0] != kSet)
    return violation("xrAttachSessionActionSets: type or set");
  if (w.actions_attached)
    return violation("xrAttachSessionActionSets: twice", XR_ERROR_ACTIONSETS_ALREADY_ATTACHED);
  w.actions_attached = true;
  return XR_SUCCESS;
}

XrResult XRAPI_CALL sync(XrSession, const XrActionsSyncInfo* info) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (!is(info, XR_TYPE_ACTIONS_SYNC_INFO)) return violation("xrSyncActions: wrong type");
  if (!w.actions_attached)
    return violation("xrSyncActions: nothing is attached", XR_ERROR_ACTIONSET_NOT_ATTACHED);
  w.was_pressed = w.pressed;
  w.pressed = w.frame == control().press_at;
  return w.state == XR_SESSION_STATE_FOCUSED ? XR_SUCCESS : XR_SESSION_NOT_FOCUSED;
}

XrResult XRAPI_CALL boolean(XrSession, const XrActionStateGetInfo* info,
                            XrActionStateBoolean* out) {
  World& w = world();
  if (!is(info, XR_TYPE_ACTION_STATE_GET_INFO) || !is(out, XR_TYPE_ACTION_STATE_BOOLEAN))
    return violation("xrGetActionStateBoolean: wrong type");
  const Action* action = object_of(w.actions, info->action);
  if (!action || action->type != XR_ACTION_TYPE_BOOLEAN_INPUT)
    return violation("xrGetActionStateBoolean: no such action", XR_ERROR_ACTION_TYPE_MISMATCH);
  out->isActive = control().controllers ? XR_TRUE : XR_FALSE;
  out->currentState = w.pressed ? XR_TRUE : XR_FALSE;
  out->changedSinceLastSync = w.pressed != w.was_pressed ? XR_TRUE : XR_FALSE;
  out->lastChangeTime = w.now_ns;
  return XR_SUCCESS;
}

}  // namespace

PFN_xrVoidFunction action_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrCreateActionSet", as_void(create_set)},
      {"xrDestroyActionSet", as_void(destroy_set)},
      {"xrCreateAction", as_void(create)},
      {"xrDestroyAction", as_void(destroy)},
      {"xrSuggestInteractionProfileBindings", as_void(suggest)},
      {"xrAttachSessionActionSets", as_void(attach)},
      {"xrSyncActions", as_void(sync)},
      {"xrGetActionStateBoolean", as_void(boolean)}};
  const auto at = all.find(name);
  return at == all.end() ? nullptr : at->second;
}

}  // namespace fakexr
}  // namespace tractus
