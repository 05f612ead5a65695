#include "station/headset/headset.hpp"

#include "core/try.hpp"
#include "station/headset/controls.hpp"
#include "station/headset/painter.hpp"
#include "station/headset/session.hpp"

namespace tractus {
namespace headset {
namespace {
constexpr double kPathStep_m = 5e-4;
constexpr std::size_t kPathPoints = 4000;
constexpr const char* kLost = "Tracking lost\nlook towards the room";
}  // namespace

struct Headset::Parts {
  Shown shown;
  const core::Clock& clock;
  // Destroyed from below: pictures before the session, the session before context and instance.
  std::unique_ptr<Instance> instance;
  std::unique_ptr<Graphics> graphics;
  std::unique_ptr<Session> session;
  std::unique_ptr<Painter> painter;
  std::unique_ptr<Controls> controls;
  std::optional<math::Pose> X_SD;  // fixed at the first frame when the room is not aligned
  bool aligned = false;
  std::vector<math::Vec3> path_m;
  DisplayState seen = DisplayState::waiting;
  FrameTimes work, gpu;
  DueFrames due;
  std::uint64_t untracked = 0;
  double period_s = 0.0;

  Parts(const Shown& what, const core::Clock& with) : shown(what), clock(with) {}
  core::Result<void> open();
  void follow_probe();
  void on_controls(const Frame& frame, const Located& located);
  bool paint(const Frame& frame, const Located& located);
  void frame();
};

Headset::Headset(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Headset::~Headset() = default;

core::Result<std::unique_ptr<Headset>> Headset::make(const Shown& shown, const core::Clock& clock) {
  auto parts = std::make_unique<Parts>(shown, clock);
  TRY(parts->open());
  return std::unique_ptr<Headset>(new Headset(std::move(parts)));
}

core::Result<void> Headset::Parts::open() {
  auto found = TRY(Instance::make());
  instance = std::move(found);
  auto context = TRY(Graphics::make(*instance));
  graphics = std::move(context);
  auto opened = TRY(Session::make(*instance, *graphics));
  session = std::move(opened);
  auto made = TRY(
      Painter::make(shown.scene, graphics->context(), session->width_px(), session->height_px()));
  painter = std::move(made);
  controls = std::make_unique<Controls>(*instance, *session);
  aligned = shown.X_SD && session->in_stage();
  if (aligned) X_SD = shown.X_SD;
  return {};
}

bool Headset::step() {
  Parts& p = *parts_;
  p.session->process_events();
  if (p.session->lifecycle().running())
    p.frame();
  else
    p.due.pause();
  if (!p.session->lifecycle().visible()) p.seen = DisplayState::waiting;
  if (p.session->lifecycle().over()) p.seen = DisplayState::over;
  return p.seen != DisplayState::over;
}

void Headset::Parts::frame() {
  const auto begun = session->begin_frame();
  if (!begun) return;
  const core::Instant_ns start = clock.now();
  due.add(begun->shown_at, begun->period_ns);
  period_s = 1e-9 * double(begun->period_ns);
  const auto located = begun->wanted ? session->locate(*begun) : std::nullopt;
  const bool drawn = located && paint(*begun, *located);
  if (session->lifecycle().over()) return;
  session->end_frame(*begun, drawn ? &*located : nullptr);
  if (!drawn) return;
  work.add(1e-9 * double(clock.now() - start));
  if (const auto spent_s = painter->gpu_s()) gpu.add(*spent_s);
  seen = located->tracked ? DisplayState::shown : DisplayState::tracking_lost;
  if (!located->tracked) ++untracked;
}

void Headset::Parts::follow_probe() {
  if (shown.carved)
    shown.carved(
        [this](const volume::Box& box, const volume::Volume& bone,
               const drilling::ErodedShares& worn) { painter->carve_away(box, bone, worn); });
  const auto now = shown.latest ? shown.latest() : std::nullopt;
  if (!now) return;
  painter->pose(now->state);
  if (!path_m.empty() && (now->tip_m - path_m.back()).norm() < kPathStep_m) return;
  if (path_m.size() >= kPathPoints) path_m.erase(path_m.begin(), path_m.begin() + kPathPoints / 4);
  path_m.push_back(now->tip_m);
  painter->path(path_m);
}

void Headset::Parts::on_controls(const Frame& frame, const Located& located) {
  Controls::State hands = controls->look(*session, frame);
  if (hands.recentre && !aligned) X_SD = device_ahead_of(located.X_SW);
  const math::Pose X_VS = shown.X_VD * X_SD->inverse();
  for (auto& grip : hands.X_SG)
    if (grip) grip = X_VS * *grip;
  painter->grips(hands.X_SG);
}

bool Headset::Parts::paint(const Frame& frame, const Located& located) {
  if (located.tracked) {
    if (!X_SD) X_SD = device_ahead_of(located.X_SW);
    follow_probe();
    on_controls(frame, located);
  }
  painter->say(located.tracked ? "" : kLost);
  const math::Pose X_VS = X_SD ? shown.X_VD * X_SD->inverse() : math::Pose{};
  for (std::size_t eye = 0; eye < 2; ++eye) {
    auto texture = session->pictures(eye).acquire();
    if (!texture) return false;
    const Eye in_V{X_VS * located.eyes[eye].X_VE, located.eyes[eye].fov};
    const math::Pose X_WE = located.X_SW.inverse() * located.eyes[eye].X_VE;
    const auto painted = painter->paint(in_V, X_WE, *texture);
    if (!painted) session->give_up(painted.error().what);
    if (!session->pictures(eye).release() || !painted) return false;
  }
  return true;
}

void Headset::ask_to_leave() { parts_->session->ask_to_leave(); }
DisplayState Headset::seen() const { return parts_->seen; }
bool Headset::running() const { return parts_->session->lifecycle().running(); }
const std::string& Headset::why() const { return parts_->session->lifecycle().why(); }

Figures Headset::figures() const {
  const Parts& p = *parts_;
  return {.runtime = p.instance->runtime(),
          .device = p.instance->device(),
          .simulated = p.instance->simulated(),
          .aligned = p.aligned,
          .frames = p.work.size(),
          .dropped = p.due.missed(),
          .untracked = p.untracked,
          .rate_Hz = p.period_s > 0.0 ? 1.0 / p.period_s : 0.0,
          .p50_ms = p.work.quantile_ms(0.5),
          .p99_ms = p.work.quantile_ms(0.99),
          .gpu_p50_ms = p.gpu.quantile_ms(0.5),
          .gpu_p99_ms = p.gpu.quantile_ms(0.99),
          .ended = {}};
}

}  // namespace headset
}  // namespace tractus
