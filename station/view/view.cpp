#include "station/view/view.hpp"

#include <X11/Xlib.h>
#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCamera.h>
#include <vtkGenericOpenGLRenderWindow.h>
#include <vtkImageData.h>
#include <vtkInteractorStyleTrackballCamera.h>
#include <vtkOpenGLRenderWindow.h>
#include <vtkPNGWriter.h>
#include <vtkPointData.h>
#include <vtkRenderWindowInteractor.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkUnsignedCharArray.h>

#include "core/file.hpp"
#include "core/try.hpp"
#include "station/view/egl_context.hpp"
#include "station/view/lent_context.hpp"
#include "station/view/scene_parts.hpp"

namespace tractus {
namespace view {

struct View::Parts {
  std::unique_ptr<EglContext> egl;  // outlives the window below it
  vtkSmartPointer<vtkRenderWindow> window;
  vtkSmartPointer<vtkRenderWindowInteractor> interactor;  // null off screen
  vtkNew<vtkRenderer> renderer;
  vtkSmartPointer<vtkTextActor> caption, drilled;
  Picture picture;
  double removed_m3 = 0.0;
  bool closed = false;

  void say_drilled(const drilling::ErodedShares& worn) {
    removed_m3 = worn.removed_m3;
    drilled->SetVisibility(!worn.lost.empty());
  }
};

namespace {

core::Result<void> display_is_there() {
  Display* display = XOpenDisplay(nullptr);
  if (!display)
    return core::Error{
        core::Errc::unavailable,
        "--view window: no X display answers; set DISPLAY, or use --view offscreen or none"};
  XCloseDisplay(display);
  return {};
}

void look_at(vtkRenderer& renderer, const volume::Tract& tract) {
  const math::Vec3 focus = tract.entry_m + 0.4 * tract.length_m * tract.axis;
  const math::Vec3 eye = focus + 0.098 * tract.medial - 0.038 * tract.axis + 0.017 * tract.superior;
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetFocalPoint(focus.x(), focus.y(), focus.z());
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetViewUp(tract.superior.x(), tract.superior.y(), tract.superior.z());
  camera->SetViewAngle(32);
  renderer.ResetCameraClippingRange();
}

/// A line of words, in the colour of what they name; line 0 is the lowest.
vtkSmartPointer<vtkTextActor> words(const char* what, const std::array<double, 3>& colour,
                                    int line) {
  auto word = vtkSmartPointer<vtkTextActor>::New();
  word->SetInput(what);
  word->GetTextProperty()->SetFontSize(16);
  word->GetTextProperty()->SetColor(colour[0], colour[1], colour[2]);
  word->SetDisplayPosition(16, 14 + 26 * line);
  return word;
}

}  // namespace

View::View(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}

View::~View() {
  // VTK frees its textures in the context: the window goes first.
  if (parts_->egl) parts_->egl->make_current();
  parts_->window->Finalize();
}

core::Result<std::unique_ptr<View>> View::make(const Scene& scene, Mode mode, int width_px,
                                               int height_px) {
  auto parts = std::make_unique<Parts>();
  if (mode == Mode::window) {
    TRY(display_is_there());
    parts->window = vtkSmartPointer<vtkRenderWindow>::New();
    parts->interactor = vtkSmartPointer<vtkRenderWindowInteractor>::New();
    parts->interactor->SetInteractorStyle(vtkNew<vtkInteractorStyleTrackballCamera>());
    parts->interactor->SetRenderWindow(parts->window);
    vtkNew<vtkCallbackCommand> closing;
    closing->SetClientData(parts.get());
    closing->SetCallback([](vtkObject*, unsigned long, void* data, void*) {
      static_cast<Parts*>(data)->closed = true;
    });
    parts->interactor->AddObserver(vtkCommand::ExitEvent, closing);
  } else {
    auto egl = TRY(EglContext::make());
    parts->egl = std::move(egl);
    vtkNew<vtkGenericOpenGLRenderWindow> window;
    window->SetFrameBlitModeToNoBlit();
    lend_context(*window, *parts->egl);
    parts->window = window;
  }
  parts->window->SetSize(width_px, height_px);
  parts->window->SetMultiSamples(0);
  parts->window->SetWindowName("Tractus");
  parts->window->AddRenderer(parts->renderer);
  if (parts->egl &&
      !static_cast<vtkOpenGLRenderWindow&>(*parts->window).InitializeFromCurrentContext())
    return core::Error{core::Errc::unavailable,
                       "off-screen view: VTK cannot use the OpenGL context"};

  parts->picture.add(*parts->renderer, scene);
  parts->caption = words("", {0.92, 0.94, 0.96}, 0);
  parts->drilled = words("drilled channel", kDrilled, 3);
  for (const auto& line : {parts->caption, parts->drilled, words("way of the tip", kWay, 1),
                           words("planned tract", kPlanned, 2)})
    parts->renderer->AddActor2D(line);
  parts->say_drilled(scene.worn ? *scene.worn : drilling::ErodedShares{});
  look_at(*parts->renderer, scene.tract);
  if (parts->interactor) parts->interactor->Initialize();
  return std::unique_ptr<View>(new View(std::move(parts)));
}

void View::draw(const ProbeState& state, std::span<const math::Vec3> path_m) {
  parts_->picture.pose(state);
  parts_->picture.path(path_m);
  const math::Vec3& f = state.wrench_H.force_N;
  std::string caption =
      fmt::format("F_xy {:.2f} N   F_z {:.2f} N   bend {:.1f} mm", std::hypot(f.x(), f.y()),
                  std::abs(f.z()), 1e3 * state.deflection_m.norm());
  if (parts_->removed_m3 > 0.0)
    caption += fmt::format("   {:.0f} mm\u00b3 of bone drilled away", 1e9 * parts_->removed_m3);
  parts_->caption->SetInput(caption.c_str());
  parts_->window->Render();
  if (parts_->interactor) parts_->interactor->ProcessEvents();
}

void View::carve_away(const volume::Box& box, const volume::Volume& volume,
                      const drilling::ErodedShares& worn) {
  parts_->picture.carve_away(box, volume, worn);
  parts_->say_drilled(worn);
}

core::Result<void> View::save_png(const std::filesystem::path& path) const {
  const int* size = parts_->window->GetSize();
  vtkNew<vtkUnsignedCharArray> pixels;  // RGB, row by row from below
  parts_->window->GetPixelData(0, 0, size[0] - 1, size[1] - 1, 0, pixels, 0);
  vtkNew<vtkImageData> image;
  image->SetDimensions(size[0], size[1], 1);
  image->GetPointData()->SetScalars(pixels);
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputData(image);
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* png = writer->GetResult();
  if (!png || png->GetNumberOfValues() == 0)
    return core::Error{core::Errc::unavailable,
                       path.string() + ": the picture could not be read back"};
  const std::span bytes(png->GetPointer(0), static_cast<std::size_t>(png->GetNumberOfValues()));
  return core::write_file(path, std::as_bytes(bytes));
}

bool View::closed() const { return parts_->closed; }

}  // namespace view
}  // namespace tractus
