#include "station/session/palpation_rig.hpp"

#include <algorithm>

#include "core/try.hpp"
#include "station/loop/placement.hpp"
#include "station/session/trial_drilling.hpp"

namespace tractus {
namespace session {
namespace {
constexpr std::size_t kRing = 16384;            // four seconds
constexpr std::uint64_t kDrainEveryTicks = 40;  // of a fast trial: 10 ms of its time
constexpr double kGrace_s = 2.0;                // beyond the plan, for a hand that lags

core::Json array_of(const math::Vec3& v) { return core::Json::array({v.x(), v.y(), v.z()}); }

core::Json probe_of(const laws::PalpationParameters& base) {
  return {{"length_m", base.length_m},
          {"radius_m", base.radius_m},
          {"points", base.points},
          {"point_spacing_m", base.point_spacing_m},
          {"pose_offset_m", array_of(base.pose_offset_m)}};
}

devices::KnownTract channel_of(const volume::Tract& in_D, double enclosed_from_m) {
  return {.entry_m = in_D.entry_m,
          .axis = in_D.axis,
          .medial = in_D.medial,
          .superior = in_D.superior,
          .length_m = in_D.length_m,
          .radius_m = in_D.radius_m,
          .enclosed_from_m = enclosed_from_m};
}

/// Of the tip along the tract's axis.
double depth_m(const loop::Live& live, const PreparedCase& prepared) {
  const auto& [w, x, y, z] = live.q_VH;
  const math::Quat turn(w, x, y, z);
  const math::Vec3 tip_H(live.deflection_m[0], live.deflection_m[1], prepared.model.base.length_m);
  const math::Vec3 tip = math::Vec3(live.p_VH_m[0], live.p_VH_m[1], live.p_VH_m[2]) + turn * tip_H;
  const volume::Tract& tract = prepared.opened.definition.tract;
  return (tip - tract.entry_m).dot(tract.axis);
}
}  // namespace

core::Result<std::unique_ptr<PalpationRig>> PalpationRig::make(const StationConfig& config,
                                                               const PreparedCase& prepared,
                                                               const TrialSetup& setup) {
  const auto info = TRY(devices::find(setup.device, devices::DeviceKind::handle));
  return std::unique_ptr<PalpationRig>(new PalpationRig(config, prepared, setup, info));
}

PalpationRig::PalpationRig(const StationConfig& config, const PreparedCase& prepared,
                           const TrialSetup& setup, const devices::DeviceInfo& info)
    : prepared_(prepared),
      setup_(setup),
      info_(info),
      X_VD_(loop::place_device(prepared.opened.definition.tract, prepared.model.base.length_m,
                               prepared.model.base.pose_offset_m)),
      ring_(kRing),
      limiter_(config.limits, static_cast<core::Instant_ns>(1e9 / setup.rate_Hz)),
      way_(trial::ProbeShape{prepared.model.base.length_m, prepared.model.base.pose_offset_m},
           prepared.opened.definition.tract) {}

PalpationRig::~PalpationRig() {
  if (made_.device) made_.device->close();
}

TrialTerms PalpationRig::terms() const {
  return {.speed = setup_.speed,
          .duration_s = setup_.duration_s,
          .rate_Hz = setup_.rate_Hz,
          .outside = setup_.outside,
          .started_utc_us = setup_.started_utc_us};
}

core::Result<void> PalpationRig::prepare(TrialTime& time) {
  time_ = &time;
  TRY(take_tool());
  return open_device();
}

core::Result<void> PalpationRig::take_tool() {
  if (!setup_.burr) {
    contact_.emplace(prepared_.runtime);
    return {};
  }
  if (!prepared_.drilled.empty())
    return core::Error{core::Errc::bad_input,
                       "--drilled: a bone that was drilled is palpated; a burr begins anew"};
  auto drills = TRY(loop::Drilling::make(prepared_.volume, prepared_.model, *setup_.burr));
  drilling_ = std::move(drills);
  contact_.emplace(drilling_->runtime());
  return {};
}

core::Result<void> PalpationRig::open_device() {
  const auto& base = prepared_.model.base;
  const auto& tract = prepared_.opened.definition.tract;
  const double enclosed_from_m =
      info_.simulated ? loop::enclosed_from_m(prepared_.volume, prepared_.model.transfer, tract)
                      : 0.0;
  auto device =
      TRY(info_.make({.seed = setup_.seed,
                      .duration_s = setup_.duration_s,
                      .probe_length_m = base.length_m,
                      .channel = channel_of(loop::tract_in_device(tract, X_VD_, base.pose_offset_m),
                                            enclosed_from_m),
                      .tool = setup_.burr ? devices::Tool::burr : devices::Tool::probe,
                      .sdk = setup_.sdk}));
  made_ = std::move(device);
  auto limits = TRY(made_.device->open());
  loop::HandLimits device_limits = loop::HandLimits::kCeiling;
  device_limits.max_force_N = limits.max_force_N;
  device_limits.max_torque_Nm = limits.max_torque_Nm;
  if (setup_.outside)
    device_limits.max_force_N = std::min(device_limits.max_force_N, setup_.outside->force_N());
  limiter_.lower(device_limits);
  opened_ = limits;
  return {};
}

void PalpationRig::describe(trial::Header& header) const {
  header.case_id = setup_.case_known_as.empty() ? prepared_.opened.id : setup_.case_known_as;
  header.operator_name = made_.trainee ? made_.trainee->name() : "not named";
  if (!setup_.operator_name.empty()) header.operator_name = setup_.operator_name;
  header.simulated = info_.simulated || opened_.simulated;
  header.probe = probe_of(prepared_.model.base);
  if (setup_.burr) header.probe["radius_m"] = setup_.burr->shank_radius_m;
  header.extra.update(extra_of_header());
}

core::Json PalpationRig::extra_of_header() const {
  const bool damped = setup_.passivity == loop::Passivity::controlled;
  core::Json extra = {{"model", prepared_.model.name},
                      {"limits", limiter_.limits().to_json()},
                      {"passivity", damped ? "controlled" : "observed"}};
  if (drilling_) extra["drilling"] = drilling_->setup().to_json();
  if (!prepared_.drilled.empty()) extra["drilled"] = prepared_.drilled;
  if (!opened_.name.empty()) extra["device_name"] = opened_.name;
  if (info_.simulated) extra["seed"] = setup_.seed;
  if (!prepared_.model.effects.empty()) extra["effects"] = prepared_.model.to_json()["effects"];
  return extra;
}

void PalpationRig::record(trial::TrialWriter writer) {
  recorder_.emplace(ring_, std::move(writer), time_->real);
  recorder_->tell([this](std::span<const trial::Sample> samples) { way_.add(samples); });
  loop_.emplace(loop::HapticLoop::Parts{time_->loop(), *made_.device, *contact_, limiter_, ring_,
                                        live_, setup_.passivity, drilling_.get()},
                X_VD_, prepared_.model.base.pose_offset_m, setup_.rate_Hz);
}

void PalpationRig::arm() {
  limiter_.arm();
  if (drilling_ && !time_->fast()) drilling_->start(time_->real);
}

void PalpationRig::run() noexcept {
  loop_->run([this] { after_tick(); });
}

// In real time this is under the tick's rules: only atomics are read.
void PalpationRig::after_tick() {
  const trial::TickCounts& counts = loop_->counts();
  const bool over = made_.trainee && made_.trainee->done();
  const double longest_s = setup_.duration_s + (made_.trainee ? kGrace_s : 0.0);
  const auto passed = static_cast<double>(counts.samples + counts.skipped);
  if (over || passed >= longest_s * setup_.rate_Hz || recorder_->failed()) stop();
  if (drilling_ && drilling_->fell_behind()) stop();
  if (!time_->fast()) return;
  if (drilling_ && counts.samples % drilling::kChunkTicks == 0) drilling_->work();
  if (counts.samples % kDrainEveryTicks == 0) recorder_->drain();
}

void PalpationRig::pause(bool on) noexcept {
  limiter_.pause(on);
  if (made_.trainee) made_.trainee->rest(on);
}

TrialSnapshot PalpationRig::latest(const trial::Header& header) const {
  const auto seen = live_.read().value_or(loop::Live{});
  const double share = static_cast<double>(seen.tick) / (setup_.duration_s * setup_.rate_Hz);
  const auto& force = seen.rendered_force_N;
  return {.header = header,
          .t_s = seen.t_s,
          .progress = made_.trainee ? made_.trainee->progress() : std::min(1.0, share),
          .force_N = math::Vec3(force[0], force[1], force[2]).norm(),
          .depth_m = depth_m(seen, prepared_),
          .late = seen.late_ticks,
          .samples_safe = recorder_->samples_safe(),
          .picture = TrialSnapshot::Picture{seen, way_, drilling_.get()}};
}

Rig::Ended PalpationRig::settle() {
  Ended out;
  if (drilling_) {
    drilling_->finish();
    if (drilling_->fell_behind())
      out.behind =
          "the bone could not be worn as fast as the hand drilled: the machine is too busy";
  }
  if (limiter_.guard() == loop::Guard::latched) out.latched = loop::text_of(limiter_.fault());
  limiter_.disarm();
  return out;
}

std::optional<trial::Answer> PalpationRig::simulated_answer() const {
  if (drilling_) return std::nullopt;  // it made the channel, and felt no walls
  if (!made_.trainee || !made_.trainee->done()) return std::nullopt;
  const devices::SimulatedAnswer said = made_.trainee->answer();
  trial::Answer out{.breach = said.breach, .wall = std::nullopt, .confidence = said.confidence};
  if (said.breach) out.wall = said.wall;
  return out;
}

void PalpationRig::complete(TrialReport& report) {
  report.injected_J = loop_->energy().injected_J();
  if (drilling_)
    report.drilled = {drilled_detail(*drilling_, prepared_), drilling_->lag_quantile_s(0.5),
                      drilling_->lag_quantile_s(0.99)};
}

std::vector<trial::Event> PalpationRig::closing_events(const TrialReport& report,
                                                       double t_s) const {
  if (!report.drilled) return {};
  return {trial::Event::of(t_s, trial::EventKind::drilled, report.drilled->detail)};
}

core::Json PalpationRig::end_detail(const TrialReport& report) const {
  const trial::TickCounts& n = report.counts;
  return {{"ticks", n.samples},          {"late_ticks", n.late},
          {"skipped_ticks", n.skipped},  {"not_converged", n.not_converged},
          {"limited", n.limited},        {"stale", n.stale},
          {"lost_samples", report.lost}, {"injected_J", report.injected_J}};
}

core::Result<void> PalpationRig::keep(const StationFolder& folder,
                                      const trial::Header& header) const {
  if (!drilling_) return {};
  return keep_drilled(folder, *drilling_, header.id, prepared_.opened.id);
}

core::Result<PalpationTrial> palpation_trial(const StationFolder& folder,
                                             const PreparedCase& prepared,
                                             const TrialSetup& setup) {
  auto rig = TRY(PalpationRig::make(folder.config(), prepared, setup));
  return PalpationTrial::make(folder, std::move(rig));
}

}  // namespace session
}  // namespace tractus
