#include "station/app/trial_viewer.hpp"

#include <charconv>
#include <cstdio>

#include "core/try.hpp"
#include "station/headset/alignment.hpp"
#include "station/loop/drilling.hpp"
#include "station/loop/placement.hpp"

namespace tractus {
namespace app {
namespace {
constexpr int kWidth_px = 1280, kHeight_px = 800;
constexpr auto kUntilSeen = std::chrono::seconds(10);

// The whole image goes to the graphics each time.
constexpr auto kBetweenLooksAtBone = std::chrono::milliseconds(330);

/// What the loop says, as something to draw.
headset::Moment moment_of(const session::PreparedCase& prepared, const loop::Live& live) {
  headset::Moment now;
  now.state.X_VH = {{live.p_VH_m[0], live.p_VH_m[1], live.p_VH_m[2]},
                    {live.q_VH[0], live.q_VH[1], live.q_VH[2], live.q_VH[3]}};
  now.state.deflection_m = {live.deflection_m[0], live.deflection_m[1]};
  now.state.wrench_H.force_N = {live.rendered_force_N[0], live.rendered_force_N[1],
                                live.rendered_force_N[2]};
  now.state.wrench_H.torque_Nm = {live.rendered_torque_Nm[0], live.rendered_torque_Nm[1],
                                  live.rendered_torque_Nm[2]};
  now.tip_m = prepared.runtime.law().tip_m(now.state.X_VH, now.state.deflection_m);
  return now;
}

sensors::ToolMoment tool_of(const headset::Moment& now) {
  const math::Quat& q_VH = now.state.X_VH.q;
  return {.X_VT = {now.tip_m, q_VH},
          .force_N = q_VH * now.state.wrench_H.force_N,
          .torque_Nm = q_VH * now.state.wrench_H.torque_Nm};
}

/// The same of a recorded sample.
view::ProbeState state_of(const session::PreparedCase& prepared, const trial::Sample& sample) {
  view::ProbeState out;
  out.X_VH = sample.pose();
  out.X_VH.p += prepared.model.base.pose_offset_m;
  out.deflection_m = {sample.deflection_m[0], sample.deflection_m[1]};
  const auto& f = sample.rendered_force_N;
  out.wrench_H.force_N = {f[0], f[1], f[2]};
  return out;
}

/// The alignment that holds for this device, if there is one.
core::Result<std::optional<math::Pose>> room_of(const ViewOptions& look) {
  auto kept = TRY(headset::kept_alignment(look.data));
  if (kept && kept->device == look.device) return std::optional(kept->alignment.X_SD);
  return std::optional<math::Pose>{};
}

}  // namespace

core::Result<TrialViewer> TrialViewer::make(const session::PreparedCase& prepared,
                                            const ViewOptions& look) {
  TrialViewer made;
  made.prepared_ = &prepared;
  made.picture_ = look.picture;
  made.burr_ = look.burr;
  TRY(made.open(look));
  if (!look.igtl_out.empty()) TRY(made.open_sender(look.igtl_out));
  return made;
}

core::Result<void> TrialViewer::open_sender(const std::string& igtl_out) {
  const auto colon = igtl_out.rfind(':');
  const bool stated = colon != std::string::npos;
  const std::string address = stated ? igtl_out.substr(0, colon) : "127.0.0.1";
  const std::string text = stated ? igtl_out.substr(colon + 1) : igtl_out;
  std::uint16_t port = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), port);
  if (failure != std::errc() || end != text.data() + text.size())
    return core::Error{core::Errc::bad_input,
                       "--igtl-out: '" + igtl_out + "': ADDRESS:PORT or PORT is expected"};
  auto started = TRY(sensors::IgtlSender::start(
      address, port,
      [&prepared = *prepared_, followed = live_]() -> std::optional<sensors::ToolMoment> {
        const loop::LiveState* live = followed->load();
        const auto seen = live ? live->read() : std::nullopt;
        if (!seen) return std::nullopt;
        return tool_of(moment_of(prepared, *seen));
      }));
  sender_ = std::move(started);
  std::fprintf(stderr, "OpenIGTLink: sends at %s:%d\n", address.c_str(), sender_->port());
  return {};
}

view::Scene TrialViewer::scene() const {
  const Carved& carved = *carved_;
  view::Scene out{.volume = carved.bone ? *carved.bone : prepared_->volume,
                  .transfer = prepared_->model.transfer,
                  .tract = prepared_->opened.definition.tract,
                  .probe = prepared_->model.base,
                  .burr = burr_,
                  .worn = carved.bone ? &carved.worn : &prepared_->worn};
  if (burr_) out.probe.radius_m = burr_->shank_radius_m;
  return out;
}

core::Result<void> TrialViewer::open(const ViewOptions& look) {
  switch (look.show) {
    case Show::none:
      return {};
    case Show::window:
      return open(view::Mode::window);
    case Show::offscreen:
      return open(view::Mode::offscreen);
    case Show::headset:
    case Show::headset_or_window:
      break;
  }
  auto opened = open_headset(look);
  const bool fall = look.show == Show::headset_or_window && !opened &&
                    opened.error().code == core::Errc::unavailable;
  if (!fall) return opened;
  std::fprintf(stderr, "warning: %s; a window instead\n", opened.error().what.c_str());
  return open(view::Mode::window);
}

core::Result<void> TrialViewer::open_headset(const ViewOptions& look) {
  auto X_SD = TRY(room_of(look));
  // With the model's pose offset left out: it is in the poses that the loop gives, not in the room.
  const auto& definition = prepared_->opened.definition;
  const math::Pose X_VD =
      loop::place_device(definition.tract, prepared_->model.base.length_m, math::Vec3::Zero());
  auto started = TRY(headset::HeadsetThread::start(
      {.scene = scene(),
       .X_VD = X_VD,
       .X_SD = X_SD,
       .latest = [&prepared = *prepared_, followed = live_]() -> std::optional<headset::Moment> {
         const loop::LiveState* live = followed->load();
         const auto seen = live ? live->read() : std::nullopt;
         if (!seen) return std::nullopt;
         return moment_of(prepared, *seen);
       },
       .carved =
           [carved = carved_](const headset::TakeBone& take) {
             const std::unique_lock held(carved->mutex, std::try_to_lock);
             if (!held || !carved->fresh) return;
             take(*carved->fresh, *carved->bone, carved->worn);
             carved->fresh.reset();
           }}));
  headset_ = std::move(started);
  if (!X_SD)
    std::fprintf(stderr,
                 "headset: the room is not aligned with %s: the scene stands before the person "
                 "(tractus-station align)\n",
                 look.device.c_str());
  if (!headset_->wait_until_seen(kUntilSeen))
    std::fprintf(stderr, "warning: headset: nobody sees the scene yet; the trial begins\n");
  return {};
}

void TrialViewer::tell_headset() {
  const headset::DisplayState now = headset_->seen();
  if (now == told_) return;
  told_ = now;
  const char* words = "shows the scene";
  if (now == headset::DisplayState::waiting) words = "shows nothing just now; the trial goes on";
  if (now == headset::DisplayState::tracking_lost) words = "tracking lost; the trial goes on";
  if (now == headset::DisplayState::over) words = "its view is over; the trial goes on";
  std::fprintf(stderr, "headset: %s\n", words);
}

core::Json TrialViewer::end_headset() {
  if (!headset_) return {};
  const core::Json figures = headset_->end().to_json();
  headset_.reset();
  return figures;
}

core::Result<void> TrialViewer::open(view::Mode mode) {
  auto view = TRY(view::View::make(scene(), mode, kWidth_px, kHeight_px));
  view_ = std::move(view);
  return {};
}

void TrialViewer::look_at_bone(loop::Drilling& drilling) {
  const std::unique_lock held(carved_->mutex, std::try_to_lock);
  if (!held) return;  // the headset is at it: the next look has it
  Carved& carved = *carved_;
  if (!carved.bone) carved.bone = prepared_->volume;
  const auto box = drilling.show(*carved.bone);
  auto worn = drilling.worn();
  if (!box && !worn) return;
  if (worn) carved.worn = std::move(*worn);
  if (view_) view_->carve_away(box.value_or(volume::Box{}), *carved.bone, carved.worn);
  carved.fresh =
      drilling::united(carved.fresh.value_or(volume::Box{}), box.value_or(volume::Box{}));
}

bool TrialViewer::look(const session::TrialSnapshot& seen) {
  if (headset_) tell_headset();
  if (!view_ && !headset_ && picture_.empty()) return true;
  way_ = &seen.picture->way;
  drilling_ = seen.picture->drilling;
  if (const auto now = std::chrono::steady_clock::now(); drilling_ && now >= next_look_at_bone_) {
    look_at_bone(*drilling_);
    next_look_at_bone_ = now + kBetweenLooksAtBone;
  }
  if (!view_) return true;
  way_->show(path_);
  view_->draw(moment_of(*prepared_, seen.picture->live).state, path_.points_m);
  return !view_->closed();
}

core::Result<void> TrialViewer::leave_picture() {
  end_headset();  // one at a time draws
  if (picture_.empty() || !way_) return {};
  way_->show(path_);
  const auto& sample = burr_ ? path_.withdrawn : path_.deepest;
  if (!sample) return {};
  if (drilling_) look_at_bone(*drilling_);
  if (!view_) TRY(open(view::Mode::offscreen));
  view_->draw(state_of(*prepared_, *sample), path_.points_m);
  return view_->save_png(picture_);
}

}  // namespace app
}  // namespace tractus
