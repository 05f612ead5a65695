#define GL_GLEXT_PROTOTYPES
#include "station/headset/painter.hpp"

#include <GL/gl.h>
#include <GL/glext.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkMatrix4x4.h>
#include <vtkOpenGLFramebufferObject.h>
#include <vtkOpenGLState.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSphereSource.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>

#include "station/headset/gpu_timer.hpp"
#include "station/view/scene_parts.hpp"

namespace tractus {
namespace headset {
namespace {
constexpr double kNear_m = 0.03, kFar_m = 10.0;
constexpr double kGrip_m = 0.02;
const math::Vec3 kWordsAt_m{0.0, -0.05, -1.0};  // in the head's frame
constexpr double kWordsHigh_rad = 0.03;

vtkSmartPointer<vtkActor> grip() {
  vtkNew<vtkSphereSource> ball;
  ball->SetRadius(kGrip_m);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(ball->GetOutputPort());
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(0.45, 0.65, 0.45);
  actor->VisibilityOff();
  return actor;
}
}  // namespace

struct Painter::Parts {
  const view::LentContext& context;
  int width_px, height_px;
  vtkNew<vtkGenericOpenGLRenderWindow> window;
  vtkNew<vtkRenderer> scene, board;  // one is drawn: what there is, or words
  vtkNew<vtkTextActor> words;
  std::array<vtkSmartPointer<vtkActor>, 2> grips{grip(), grip()};
  view::Picture picture;
  unsigned target = 0;  // framebuffer that holds the runtime's texture
  std::optional<GpuTimer> timer;
  bool saying = false;

  Parts(const view::LentContext& with, int width, int height)
      : context(with), width_px(width), height_px(height) {}
  void aim(vtkRenderer& renderer, const Eye& eye) const;
  core::Result<void> copy_to(unsigned texture);
};

Painter::Painter(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

Painter::~Painter() {
  parts_->context.make_current();
  parts_->timer.reset();
  if (parts_->target) glDeleteFramebuffers(1, &parts_->target);
  parts_->window->Finalize();
}

core::Result<std::unique_ptr<Painter>> Painter::make(const view::Scene& scene,
                                                     const view::LentContext& context, int width_px,
                                                     int height_px) {
  auto parts = std::make_unique<Parts>(context, width_px, height_px);
  Parts& p = *parts;
  p.window->SetFrameBlitModeToNoBlit();
  view::lend_context(*p.window, context);
  p.window->SetSize(width_px, height_px);
  p.window->SetMultiSamples(0);
  p.window->AddRenderer(p.scene);
  p.window->AddRenderer(p.board);
  if (!p.window->InitializeFromCurrentContext())
    return core::Error{core::Errc::unavailable, "headset: VTK cannot use the OpenGL context"};
  p.picture.add(*p.scene, scene);
  for (const auto& grip : p.grips) p.scene->AddActor(grip);
  p.words->GetTextProperty()->SetColor(0.95, 0.86, 0.55);
  p.words->GetTextProperty()->SetJustificationToCentered();
  p.board->SetBackground(0.05, 0.05, 0.06);
  p.board->AddActor2D(p.words);
  p.board->DrawOff();
  p.timer.emplace();
  glGenFramebuffers(1, &p.target);
  // Shaders are made and the volume goes to the GPU now, not in the first frame.
  p.aim(*p.scene, {});
  p.window->Render();
  return std::unique_ptr<Painter>(new Painter(std::move(parts)));
}

void Painter::carve_away(const volume::Box& box, const volume::Volume& volume,
                         const drilling::ErodedShares& worn) {
  parts_->picture.carve_away(box, volume, worn);
}
void Painter::pose(const view::ProbeState& state) { parts_->picture.pose(state); }
void Painter::path(std::span<const math::Vec3> path_m) { parts_->picture.path(path_m); }

void Painter::grips(const std::array<std::optional<math::Pose>, 2>& X_VG) {
  for (std::size_t hand = 0; hand < 2; ++hand) {
    vtkActor& actor = *parts_->grips[hand];
    actor.SetVisibility(X_VG[hand].has_value());
    if (!X_VG[hand]) continue;
    const math::Vec3& at = X_VG[hand]->p;
    actor.SetPosition(at.x(), at.y(), at.z());
  }
}

void Painter::say(const std::string& words) {
  parts_->saying = !words.empty();
  parts_->scene->SetDraw(!parts_->saying);
  parts_->board->SetDraw(parts_->saying);
  parts_->words->SetInput(words.c_str());
}

void Painter::Parts::aim(vtkRenderer& renderer, const Eye& eye) const {
  vtkCamera* camera = renderer.GetActiveCamera();
  const math::Vec3 at = eye.X_VE.p, ahead = eye.X_VE * -math::Vec3::UnitZ();
  const math::Vec3 up = eye.X_VE.q * math::Vec3::UnitY();
  camera->SetPosition(at.x(), at.y(), at.z());
  camera->SetFocalPoint(ahead.x(), ahead.y(), ahead.z());
  camera->SetViewUp(up.x(), up.y(), up.z());
  camera->SetClippingRange(kNear_m, kFar_m);
  const Eigen::Matrix4d P = projection(eye.fov, kNear_m, kFar_m);
  vtkNew<vtkMatrix4x4> matrix;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) matrix->SetElement(r, c, P(r, c));
  camera->SetExplicitProjectionTransformMatrix(matrix);
  camera->UseExplicitProjectionTransformMatrixOn();
}

core::Result<void> Painter::paint(const Eye& eye, const math::Pose& X_WE, unsigned texture) {
  Parts& p = *parts_;
  p.timer->begin();
  p.aim(*p.scene, eye);
  const math::Vec3 words_E = X_WE.inverse() * kWordsAt_m;
  const math::Vec2 at = pixel_of(words_E, eye.fov, p.width_px, p.height_px);
  p.words->SetDisplayPosition(int(std::lround(at.x())), int(std::lround(at.y())));
  const double tall = std::tan(eye.fov.up_rad) - std::tan(eye.fov.down_rad);
  p.words->GetTextProperty()->SetFontSize(
      std::max(8, int(std::lround(kWordsHigh_rad / tall * p.height_px))));
  p.window->Render();
  auto copied = p.copy_to(texture);
  p.timer->end();
  return copied;
}

core::Result<void> Painter::Parts::copy_to(unsigned texture) {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target);
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  const bool whole = glCheckFramebufferStatus(GL_DRAW_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  if (whole) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, window->GetRenderFramebuffer()->GetFBOIndex());
    // VTK's colours are encoded for a screen already: copied as they are.
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_SCISSOR_TEST);
    glBlitFramebuffer(0, 0, width_px, height_px, 0, 0, width_px, height_px, GL_COLOR_BUFFER_BIT,
                      GL_NEAREST);
  }
  glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, 0, 0);
  window->GetState()->Reset();
  window->GetState()->ResetFramebufferBindings();
  if (!whole)
    return core::Error{core::Errc::unavailable, "headset: its pictures cannot be drawn in"};
  return {};
}

std::optional<double> Painter::gpu_s() { return parts_->timer->frame_s(); }

}  // namespace headset
}  // namespace tractus
