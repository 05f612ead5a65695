#include "station/app/onlooker.hpp"

#include "station/loop/drilling.hpp"

namespace app {
namespace {
constexpr int kWidth_px = 1280, kHeight_px = 800;

constexpr int kLooksPerBone = 10;  // a third of a second: the whole image goes to the graphics

view::Scene scene_of(const session::PreparedCase& prepared, const volume::Volume& bone) {
  return {bone, prepared.model.transfer, prepared.opened.definition.tract, prepared.model.base};
}
}  // namespace

core::Result<Onlooker> Onlooker::make(const session::PreparedCase& prepared, Show show,
                                      std::filesystem::path picture) {
  Onlooker made;
  made.prepared_ = &prepared;
  made.picture_ = std::move(picture);
  if (show != Show::none)
    if (auto opened = made.open(show == Show::window ? view::Mode::window : view::Mode::offscreen);
        !opened)
      return opened.error();
  return made;
}

core::Result<void> Onlooker::open(view::Mode mode) {
  auto view = view::View::make(scene_of(*prepared_, bone_ ? *bone_ : prepared_->volume), mode,
                               kWidth_px, kHeight_px);
  if (!view) return view.error();
  view_ = std::move(*view);
  return {};
}

Onlooker::Moment Onlooker::moment(const loop::Live& live) const {
  Moment now;
  now.state.X_VH = {{live.p_VH_m[0], live.p_VH_m[1], live.p_VH_m[2]},
                    {live.q_VH[0], live.q_VH[1], live.q_VH[2], live.q_VH[3]}};
  now.state.deflection_m = {live.deflection_m[0], live.deflection_m[1]};
  now.state.wrench_H.force_N = {live.rendered_force_N[0], live.rendered_force_N[1],
                                live.rendered_force_N[2]};
  now.tip_m = prepared_->runtime.law().tip_m(now.state.X_VH, now.state.deflection_m);
  return now;
}

void Onlooker::look_at_bone(loop::Drilling& drilling) {
  drilling_ = &drilling;
  if (!bone_) bone_ = prepared_->volume;
  const auto box = drilling.show(*bone_);
  if (box && view_) view_->carve_away(*box, *bone_);
}

bool Onlooker::look(const session::Glimpse& seen) {
  if (!view_ && picture_.empty()) return true;
  if (seen.drilling && looks_++ % kLooksPerBone == 0) look_at_bone(*seen.drilling);
  const Moment now = moment(seen.live);
  path_m_.push_back(now.tip_m);
  const volume::Tract& tract = prepared_->opened.definition.tract;
  if (!deepest_ || tract.depth_of(now.tip_m) > tract.depth_of(deepest_->tip_m)) deepest_ = now;
  if (view_) view_->draw(now.state, path_m_);
  return !(view_ && view_->closed());
}

core::Result<void> Onlooker::leave_picture() {
  if (picture_.empty() || !deepest_) return {};
  if (drilling_) look_at_bone(*drilling_);
  if (!view_)
    if (auto opened = open(view::Mode::offscreen); !opened) return opened.error();
  view_->draw(deepest_->state, path_m_);
  return view_->save_png(picture_);
}

}  // namespace app
