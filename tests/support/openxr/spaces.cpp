/// Where things are: the head stands where it is told, its eyes to both sides of it.
#include <cmath>
#include <map>

#include "tests/support/openxr/runtime.hpp"

namespace tractus {
namespace fakexr {
namespace {

/// The head in the room, in either of its frames: turned about the vertical, then nodding.
XrPosef head() {
  XrPosef pose{};
  const double yaw = 0.5 * control().head_yaw_rad, pitch = 0.5 * control().head_pitch_rad;
  pose.orientation = {static_cast<float>(std::cos(yaw) * std::sin(pitch)),
                      static_cast<float>(std::sin(yaw) * std::cos(pitch)),
                      static_cast<float>(-std::sin(yaw) * std::sin(pitch)),
                      static_cast<float>(std::cos(yaw) * std::cos(pitch))};
  pose.position = {static_cast<float>(control().head_m[0]), static_cast<float>(control().head_m[1]),
                   static_cast<float>(control().head_m[2])};
  return pose;
}

/// A point of the head's frame in the room.
XrVector3f in_room(const XrVector3f& p) {
  const double yaw = control().head_yaw_rad, pitch = control().head_pitch_rad;
  const double y = std::cos(pitch) * double(p.y) - std::sin(pitch) * double(p.z);
  const double z = std::sin(pitch) * double(p.y) + std::cos(pitch) * double(p.z);
  const XrPosef at = head();
  return {static_cast<float>(std::cos(yaw) * double(p.x) + std::sin(yaw) * z) + at.position.x,
          static_cast<float>(y) + at.position.y,
          static_cast<float>(-std::sin(yaw) * double(p.x) + std::cos(yaw) * z) + at.position.z};
}

XrResult XRAPI_CALL reference_spaces(XrSession, std::uint32_t capacity, std::uint32_t* count,
                                     XrReferenceSpaceType* out) {
  std::vector all{XR_REFERENCE_SPACE_TYPE_VIEW, XR_REFERENCE_SPACE_TYPE_LOCAL};
  if (control().offer_stage) all.push_back(XR_REFERENCE_SPACE_TYPE_STAGE);
  return fill(all, capacity, count, out);
}

XrResult XRAPI_CALL create_reference(XrSession, const XrReferenceSpaceCreateInfo* info,
                                     XrSpace* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrCreateReferenceSpace"); bad != XR_SUCCESS) return bad;
  if (!is(info, XR_TYPE_REFERENCE_SPACE_CREATE_INFO))
    return violation("xrCreateReferenceSpace: wrong type");
  if (info->referenceSpaceType == XR_REFERENCE_SPACE_TYPE_STAGE && !control().offer_stage)
    return violation("xrCreateReferenceSpace: STAGE", XR_ERROR_REFERENCE_SPACE_UNSUPPORTED);
  const auto& q = info->poseInReferenceSpace.orientation;
  if (std::abs(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w - 1.0F) > 1e-3F)
    return violation("xrCreateReferenceSpace: no rotation", XR_ERROR_POSE_INVALID);
  auto* made = new Space{info->referenceSpaceType, -1};
  w.spaces.insert(made);
  *out = handle_of<XrSpace>(made);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL create_of_action(XrSession, const XrActionSpaceCreateInfo* info, XrSpace* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (!is(info, XR_TYPE_ACTION_SPACE_CREATE_INFO))
    return violation("xrCreateActionSpace: wrong type");
  if (!object_of(w.actions, info->action))
    return violation("xrCreateActionSpace: no such action", XR_ERROR_HANDLE_INVALID);
  const bool known = info->subactionPath > 0 && info->subactionPath <= w.paths.size();
  const bool left = known && w.paths[info->subactionPath - 1] == "/user/hand/left";
  auto* made = new Space{XR_REFERENCE_SPACE_TYPE_VIEW, left ? 0 : 1};
  w.spaces.insert(made);
  *out = handle_of<XrSpace>(made);
  return XR_SUCCESS;
}

XrResult XRAPI_CALL destroy(XrSpace handle) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  Space* space = object_of(w.spaces, handle);
  if (!space) return violation("xrDestroySpace: of none", XR_ERROR_HANDLE_INVALID);
  w.spaces.erase(space);
  delete space;
  return XR_SUCCESS;
}

/// A controller: a hand's breadth to its side, at the hip.
XrResult XRAPI_CALL locate_space(XrSpace handle, XrSpace, XrTime, XrSpaceLocation* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  const Space* space = object_of(w.spaces, handle);
  if (!space || !is(out, XR_TYPE_SPACE_LOCATION)) return violation("xrLocateSpace: space or type");
  out->locationFlags = 0;
  out->pose = {{0, 0, 0, 1}, {0, 0, 0}};
  if (space->hand < 0 || !control().controllers || !tracked()) return XR_SUCCESS;
  out->locationFlags =
      XR_SPACE_LOCATION_POSITION_VALID_BIT | XR_SPACE_LOCATION_ORIENTATION_VALID_BIT;
  out->pose.position = in_room({space->hand == 0 ? -0.12F : 0.12F, -0.3F, -0.5F});
  return XR_SUCCESS;
}

XrFovf fov(bool left) {
  const Control& c = control();
  const auto out = static_cast<float>(c.outward_rad), in = static_cast<float>(c.inward_rad);
  return {left ? -out : -in, left ? in : out, static_cast<float>(c.up_rad),
          -static_cast<float>(c.down_rad)};
}

XrResult XRAPI_CALL locate_views(XrSession, const XrViewLocateInfo* info, XrViewState* state,
                                 std::uint32_t capacity, std::uint32_t* count, XrView* out) {
  World& w = world();
  const std::lock_guard held(w.mutex);
  if (const auto bad = missing_session("xrLocateViews"); bad != XR_SUCCESS) return bad;
  if (!is(info, XR_TYPE_VIEW_LOCATE_INFO) || !is(state, XR_TYPE_VIEW_STATE))
    return violation("xrLocateViews: wrong type");
  const Space* space = object_of(w.spaces, info->space);
  if (!space) return violation("xrLocateViews: no such space", XR_ERROR_HANDLE_INVALID);
  if (info->displayTime != w.shown_at) violation("xrLocateViews: not of the time of the frame");
  *count = 2;
  if (capacity < 2) return capacity == 0 ? XR_SUCCESS : XR_ERROR_SIZE_INSUFFICIENT;
  const bool in_head = space->type == XR_REFERENCE_SPACE_TYPE_VIEW;
  state->viewStateFlags = 0;
  if (in_head || tracked())
    state->viewStateFlags = XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT |
                            XR_VIEW_STATE_POSITION_TRACKED_BIT |
                            XR_VIEW_STATE_ORIENTATION_TRACKED_BIT;
  World::Told told{info->space, {}};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    if (!is(&out[eye], XR_TYPE_VIEW)) return violation("xrLocateViews: wrong type of view");
    const auto side = static_cast<float>((eye == 0 ? -0.5 : 0.5) * control().eyes_apart_m);
    out[eye].pose = in_head ? XrPosef{{0, 0, 0, 1}, {side, 0, 0}} : head();
    if (!in_head) out[eye].pose.position = in_room({side, 0, 0});
    out[eye].fov = fov(eye == 0);
    told.views[eye] = out[eye];
  }
  w.told.push_back(told);
  return XR_SUCCESS;
}

}  // namespace

PFN_xrVoidFunction space_function(const std::string& name) {
  static const std::map<std::string, PFN_xrVoidFunction> all{
      {"xrEnumerateReferenceSpaces", as_void(reference_spaces)},
      {"xrCreateReferenceSpace", as_void(create_reference)},
      {"xrCreateActionSpace", as_void(create_of_action)},
      {"xrDestroySpace", as_void(destroy)},
      {"xrLocateSpace", as_void(locate_space)},
      {"xrLocateViews", as_void(locate_views)}};
  const auto at = all.find(name);
  return at == all.end() ? nullptr : at->second;
}

}  // namespace fakexr
}  // namespace tractus
