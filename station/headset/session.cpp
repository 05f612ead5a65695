#include "station/headset/session.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"

namespace tractus {
namespace headset {
namespace {
constexpr auto kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;

Fov fov_of(const XrFovf& fov) {
  return {.left_rad = fov.angleLeft,
          .right_rad = fov.angleRight,
          .up_rad = fov.angleUp,
          .down_rad = fov.angleDown};
}

core::Result<XrSpace> space_of(XrSession session, XrReferenceSpaceType type) {
  auto info = typed<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  info.referenceSpaceType = type;
  info.poseInReferenceSpace.orientation.w = 1.0F;
  XrSpace made = XR_NULL_HANDLE;
  if (const XrResult result = xrCreateReferenceSpace(session, &info, &made); XR_FAILED(result))
    return refused("no frame of reference", result);
  return made;
}
}  // namespace

math::Pose pose_of(const XrPosef& pose) {
  const auto& q = pose.orientation;
  const auto& p = pose.position;
  return {{p.x, p.y, p.z}, math::Quat(q.w, q.x, q.y, q.z).normalized()};
}

core::Result<std::unique_ptr<Session>> Session::make(const Instance& instance,
                                                     const Graphics& graphics) {
  std::unique_ptr<Session> made(new Session(instance));
  TRY(made->open(graphics));
  TRY(made->make_spaces());
  TRY(made->make_pictures());
  return made;
}

Session::~Session() {
  pictures_.clear();
  if (head_) xrDestroySpace(head_);
  if (room_) xrDestroySpace(room_);
  if (handle_) xrDestroySession(handle_);
}

core::Result<void> Session::open(const Graphics& graphics) {
  auto info = typed<XrSessionCreateInfo>(XR_TYPE_SESSION_CREATE_INFO);
  info.next = graphics.binding();
  info.systemId = instance_.system();
  const XrResult result = xrCreateSession(instance_.handle(), &info, &handle_);
  if (XR_FAILED(result)) return refused("the runtime opens no session", result);
  return {};
}

core::Result<void> Session::make_spaces() {
  std::array<XrReferenceSpaceType, 16> types{};
  std::uint32_t count = 0;
  const XrResult result = xrEnumerateReferenceSpaces(
      handle_, static_cast<std::uint32_t>(types.size()), &count, types.data());
  if (XR_FAILED(result)) return refused("no frames of reference", result);
  in_stage_ = std::find(types.begin(), types.begin() + count, XR_REFERENCE_SPACE_TYPE_STAGE) !=
              types.begin() + count;
  auto room = TRY(
      space_of(handle_, in_stage_ ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL));
  room_ = room;
  auto head = TRY(space_of(handle_, XR_REFERENCE_SPACE_TYPE_VIEW));
  head_ = head;
  return {};
}

core::Result<void> Session::make_pictures() {
  for (const XrViewConfigurationView& eye : instance_.eyes()) {
    width_px_ = std::max(width_px_, static_cast<int>(eye.recommendedImageRectWidth));
    height_px_ = std::max(height_px_, static_cast<int>(eye.recommendedImageRectHeight));
  }
  pictures_.reserve(2);
  for (int eye = 0; eye < 2; ++eye) {
    auto made = TRY(Swapchain::make(handle_, width_px_, height_px_));
    pictures_.push_back(std::move(made));
  }
  return {};
}

bool Session::went(const char* what, XrResult result) {
  if (result == XR_SESSION_LOSS_PENDING)
    lifecycle_.end("the runtime lost the session");
  else if (XR_FAILED(result))
    lifecycle_.end(fmt::format("{}: {}", what, name_of(result)));
  return !lifecycle_.over();
}

void Session::process_events() {
  for (;;) {
    auto event = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    const XrResult result = xrPollEvent(instance_.handle(), &event);
    if (result == XR_EVENT_UNAVAILABLE || !went("the runtime says no more", result)) return;
    if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING)
      lifecycle_.end("the runtime itself is ending");
    if (event.type != XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) continue;
    const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
    if (changed.session == handle_) on_state_changed(changed.state);
  }
}

void Session::on_state_changed(XrSessionState state) {
  switch (lifecycle_.on_state_changed(state)) {
    case LifecycleAction::begin: {
      auto info = typed<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
      info.primaryViewConfigurationType = kStereo;
      went("the session does not begin", xrBeginSession(handle_, &info));
      return;
    }
    case LifecycleAction::end:
      went("the session does not end", xrEndSession(handle_));
      return;
    case LifecycleAction::leave:
    case LifecycleAction::none:
      return;
  }
}

void Session::ask_to_leave() {
  if (lifecycle_.running()) went("the session does not end", xrRequestExitSession(handle_));
}

std::optional<Frame> Session::begin_frame() {
  const auto wait = typed<XrFrameWaitInfo>(XR_TYPE_FRAME_WAIT_INFO);
  auto state = typed<XrFrameState>(XR_TYPE_FRAME_STATE);
  if (!went("no frame", xrWaitFrame(handle_, &wait, &state))) return std::nullopt;
  const auto begin = typed<XrFrameBeginInfo>(XR_TYPE_FRAME_BEGIN_INFO);
  if (!went("no frame", xrBeginFrame(handle_, &begin))) return std::nullopt;
  return Frame{.shown_at = state.predictedDisplayTime,
               .period_ns = state.predictedDisplayPeriod,
               .wanted = state.shouldRender == XR_TRUE};
}

std::optional<Located> Session::locate(const Frame& frame) {
  constexpr XrViewStateFlags kBoth =
      XR_VIEW_STATE_ORIENTATION_VALID_BIT | XR_VIEW_STATE_POSITION_VALID_BIT;
  Located out;
  for (const XrSpace space : {room_, head_}) {
    auto info = typed<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
    info.viewConfigurationType = kStereo;
    info.displayTime = frame.shown_at;
    info.space = out.space = space;
    auto state = typed<XrViewState>(XR_TYPE_VIEW_STATE);
    out.views.fill(typed<XrView>(XR_TYPE_VIEW));
    std::uint32_t count = 0;
    if (!went("the eyes are not found",
              xrLocateViews(handle_, &info, &state, 2, &count, out.views.data())))
      return std::nullopt;
    out.tracked = space == room_;
    if ((state.viewStateFlags & kBoth) != kBoth) continue;
    for (std::size_t eye = 0; eye < 2; ++eye)
      out.eyes[eye] = {pose_of(out.views[eye].pose), fov_of(out.views[eye].fov)};
    out.X_SW = {0.5 * (out.eyes[0].X_VE.p + out.eyes[1].X_VE.p), out.eyes[0].X_VE.q};
    return out;
  }
  return std::nullopt;  // not even the head knows where its eyes are
}

void Session::end_frame(const Frame& frame, const Located* drawn) {
  std::array<XrCompositionLayerProjectionView, 2> views;
  auto layer = typed<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  const auto* const layers = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
  auto info = typed<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
  info.displayTime = frame.shown_at;
  info.environmentBlendMode = instance_.blend();
  if (drawn) {
    for (std::size_t eye = 0; eye < 2; ++eye) {
      views[eye] =
          typed<XrCompositionLayerProjectionView>(XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW);
      views[eye].pose = drawn->views[eye].pose;
      views[eye].fov = drawn->views[eye].fov;
      views[eye].subImage.swapchain = pictures_[eye].handle();
      views[eye].subImage.imageRect.extent = {width_px_, height_px_};
    }
    layer.space = drawn->space;
    layer.viewCount = 2;
    layer.views = views.data();
    info.layerCount = 1;
    info.layers = &layers;
  }
  went("a frame is not taken", xrEndFrame(handle_, &info));
}

}  // namespace headset
}  // namespace tractus
