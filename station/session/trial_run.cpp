#include "station/session/trial_run.hpp"

#include <fmt/format.h>

#include "station/loop/placement.hpp"
#include "station/loop/recorder.hpp"
#include "station/session/trial_drilling.hpp"

namespace tractus {
namespace session {
namespace {
constexpr std::size_t kRing = 16384;            // four seconds
constexpr std::uint64_t kDrainEveryTicks = 40;  // of a fast trial: 10 ms of its time
constexpr auto kWatch = std::chrono::milliseconds(30);
constexpr double kGrace_s = 2.0;  // beyond the plan, for a hand that lags

core::Json array_of(const math::Vec3& v) { return core::Json::array({v.x(), v.y(), v.z()}); }

core::Json probe_of(const laws::PalpationParameters& base) {
  return {{"length_m", base.length_m},
          {"radius_m", base.radius_m},
          {"points", base.points},
          {"point_spacing_m", base.point_spacing_m},
          {"pose_offset_m", array_of(base.pose_offset_m)}};
}

devices::KnownTract channel_of(const volume::Tract& in_D) {
  return {.entry_m = in_D.entry_m,
          .axis = in_D.axis,
          .medial = in_D.medial,
          .superior = in_D.superior,
          .length_m = in_D.length_m,
          .radius_m = in_D.radius_m};
}

core::Json json_of(const trial::TickCounts& counts, std::uint64_t lost) {
  return {{"ticks", counts.samples},
          {"late_ticks", counts.late},
          {"skipped_ticks", counts.skipped},
          {"not_converged", counts.not_converged},
          {"limited", counts.limited},
          {"stale", counts.stale},
          {"lost_samples", lost}};
}
}  // namespace

core::Json TrialReport::to_json() const {
  core::Json out = {{"trial_id", trial_id},
                    {"file", file.string()},
                    {"simulated", simulated},
                    {"complete", complete},
                    {"fault", fault},
                    {"duration_s", duration_s},
                    {"wake_p50_us", wake_p50_us},
                    {"wake_p99_us", wake_p99_us},
                    {"work_p50_us", work_p50_us},
                    {"work_p99_us", work_p99_us},
                    {"injected_J", injected_J},
                    {"realtime", grant.to_json()}};
  out.update(json_of(counts, lost));
  if (bus)
    out["bus"] = {{"missed_periods", counts.missed},
                  {"lost_exchanges", counts.bus_lost},
                  {"restarts", bus->restarts},
                  {"round_trip_p50_us", bus->p50_us},
                  {"round_trip_p99_us", bus->p99_us}};
  if (!headset.is_null()) out["headset"] = headset;
  if (drilled) {
    out["drilled"] = drilled->detail;
    out["drilled"]["lag_p50_s"] = drilled->lag_p50_s;
    out["drilled"]["lag_p99_s"] = drilled->lag_p99_s;
  }
  out["answer"] = answer ? answer->to_json() : core::Json();
  return out;
}

struct TrialRun::Parts {
  const StationFolder& folder;
  const PreparedCase& prepared;
  TrialSetup setup;
  trial::Header header;
  devices::MadeDevice made;
  devices::Limits opened;
  core::MonotonicClock real_clock;
  core::ManualClock manual_clock;
  loop::SampleRing ring{kRing};
  loop::LiveState live;
  std::unique_ptr<loop::Drilling> drilling;  // null with a probe
  std::optional<loop::PalpationContact> contact;
  loop::Limiter limiter;
  std::optional<TipWay> way;
  std::optional<loop::Recorder> recorder;
  std::optional<loop::HapticLoop> loop;
  loop::RealtimeGrant grant;
  std::string fault;

  Parts(const StationFolder& where, const PreparedCase& on, const TrialSetup& how)
      : folder(where),
        prepared(on),
        setup(how),
        limiter(where.config().limits, static_cast<core::Instant_ns>(1e9 / how.rate_Hz)) {}

  bool fast() const { return setup.speed == Speed::fast; }
  loop::Pace pace() const { return fast() ? loop::Pace::as_fast_as_goes : loop::Pace::real_time; }
  core::Clock& clock() { return fast() ? static_cast<core::Clock&>(manual_clock) : real_clock; }
  double elapsed_s() {
    return static_cast<double>(clock().now() - loop->periods().started()) * 1e-9;
  }
  TrialSnapshot glimpse() const;
  core::Result<void> open_device(const devices::DeviceInfo& info, const math::Pose& X_VD);
  core::Result<void> take_tool();
  core::Result<void> make_file(const devices::DeviceInfo& info);
  void finish_drilling();
  void after_tick();
  void watch_until_end(const loop::LoopThread& thread, const Watch& watch);
  void apply_remote_commands();
  core::Result<void> append_end(const TrialReport& report);
};

TrialSnapshot TrialRun::Parts::glimpse() const {
  const auto seen = live.read().value_or(loop::Live{});
  const double share = static_cast<double>(seen.tick) / (setup.duration_s * setup.rate_Hz);
  return {.trial_id = header.id,
          .live = seen,
          .progress = made.trainee ? made.trainee->progress() : std::min(1.0, share),
          .samples_safe = recorder->samples_safe(),
          .way = *way,
          .drilling = drilling.get()};
}

core::Result<void> TrialRun::Parts::open_device(const devices::DeviceInfo& info,
                                                const math::Pose& X_VD) {
  const auto& base = prepared.model.base;
  const auto& tract = prepared.opened.definition.tract;
  auto device =
      info.make({.seed = setup.seed,
                 .duration_s = setup.duration_s,
                 .probe_length_m = base.length_m,
                 .channel = channel_of(loop::tract_in_device(tract, X_VD, base.pose_offset_m)),
                 .tool = setup.burr ? devices::Tool::burr : devices::Tool::probe,
                 .sdk = setup.sdk});
  if (!device) return device.error();
  made = std::move(*device);
  auto limits = made.device->open();
  if (!limits) return limits.error();
  loop::HandLimits device_limits = loop::HandLimits::kCeiling;
  device_limits.max_force_N = limits->max_force_N;
  device_limits.max_torque_Nm = limits->max_torque_Nm;
  if (setup.outside)
    device_limits.max_force_N = std::min(device_limits.max_force_N, setup.outside->force_N());
  limiter.lower(device_limits);
  opened = *limits;
  return {};
}

core::Result<void> TrialRun::Parts::take_tool() {
  if (!setup.burr) {
    contact.emplace(prepared.runtime);
    return {};
  }
  if (!prepared.drilled.empty())
    return core::Error{core::Errc::bad_input,
                       "--drilled: a bone that was drilled is palpated; a burr begins anew"};
  auto drills = loop::Drilling::make(prepared.volume, prepared.model, *setup.burr);
  if (!drills) return drills.error();
  drilling = std::move(*drills);
  contact.emplace(drilling->runtime());
  return {};
}

core::Result<void> TrialRun::Parts::make_file(const devices::DeviceInfo& info) {
  header.id = core::new_id();
  header.case_id = setup.case_known_as.empty() ? prepared.opened.id : setup.case_known_as;
  header.station = folder.config().name;
  header.operator_name = made.trainee ? made.trainee->name() : "not named";
  if (!setup.operator_name.empty()) header.operator_name = setup.operator_name;
  header.simulated = info.simulated || opened.simulated;
  header.device = info.id;
  header.started_utc_us = setup.started_utc_us.value_or(core::utc_us());
  header.rate_Hz = setup.rate_Hz;
  header.probe = probe_of(prepared.model.base);
  if (setup.burr) header.probe["radius_m"] = setup.burr->shank_radius_m;
  header.extra = {
      {"clock", fast() ? "manual: simulated time, run as fast as it goes" : "monotonic: real time"},
      {"model", prepared.model.name},
      {"limits", limiter.limits().to_json()},
      {"passivity", setup.passivity == loop::Passivity::controlled ? "controlled" : "observed"}};
  if (drilling) header.extra["drilling"] = drilling->setup().to_json();
  if (!prepared.drilled.empty()) header.extra["drilled"] = prepared.drilled;
  if (!opened.name.empty()) header.extra["device_name"] = opened.name;
  if (info.simulated) header.extra["seed"] = setup.seed;
  if (setup.started_utc_us) header.extra["date"] = "simulated";
  if (!prepared.model.effects.empty())
    header.extra["effects"] = prepared.model.to_json()["effects"];
  auto writer = trial::TrialWriter::create(folder.trial_file(header.id), header);
  if (!writer) return writer.error();
  recorder.emplace(ring, std::move(*writer), real_clock);
  const auto& base = prepared.model.base;
  way.emplace(trial::ProbeShape{base.length_m, base.pose_offset_m},
              prepared.opened.definition.tract);
  recorder->tell([this](std::span<const trial::Sample> samples) { way->add(samples); });
  return {};
}

core::Result<std::unique_ptr<TrialRun>> TrialRun::make(const StationFolder& folder,
                                                       const PreparedCase& prepared,
                                                       const TrialSetup& setup) {
  auto info = devices::find(setup.device, devices::DeviceKind::handle);
  if (!info) return info.error();
  if (setup.speed == Speed::fast && !info->simulated)
    return core::Error{core::Errc::bad_input,
                       fmt::format("--speed fast: {} is held by a person", info->id)};
  if (setup.started_utc_us && setup.speed != Speed::fast)
    return core::Error{core::Errc::bad_input, "--started: is of simulated time, --speed fast"};
  if (!(setup.duration_s >= 1.0 && setup.duration_s <= 3600.0))
    return core::Error{core::Errc::out_of_range,
                       fmt::format("--duration {}: 1 … 3600 s are possible", setup.duration_s)};
  const double bytes = setup.duration_s * setup.rate_Hz * 1.1 * double(sizeof(trial::Sample));
  if (auto checked = folder.check_room(static_cast<std::uint64_t>(bytes)); !checked)
    return checked.error();
  auto parts = std::make_unique<Parts>(folder, prepared, setup);
  const auto& base = prepared.model.base;
  const math::Pose X_VD =
      loop::place_device(prepared.opened.definition.tract, base.length_m, base.pose_offset_m);
  if (auto taken = parts->take_tool(); !taken) return taken.error();
  if (auto opened = parts->open_device(*info, X_VD); !opened) return opened.error();
  if (auto created = parts->make_file(*info); !created) return created.error();
  parts->loop.emplace(
      loop::HapticLoop::Parts{parts->clock(), *parts->made.device, *parts->contact, parts->limiter,
                              parts->ring, parts->live, setup.passivity, parts->drilling.get()},
      X_VD, base.pose_offset_m, setup.rate_Hz);
  return std::unique_ptr<TrialRun>(new TrialRun(std::move(parts)));
}

TrialRun::TrialRun(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
TrialRun::~TrialRun() { parts_->made.device->close(); }
const loop::LiveState& TrialRun::live() const { return parts_->live; }
bool TrialRun::faulted() const { return !parts_->fault.empty(); }

// In real time this is under the tick's rules: only atomics are read.
void TrialRun::Parts::after_tick() {
  const trial::TickCounts& counts = loop->counts();
  const bool over = made.trainee && made.trainee->done();
  const double longest_s = setup.duration_s + (made.trainee ? kGrace_s : 0.0);
  const auto passed = static_cast<double>(counts.samples + counts.skipped);
  if (over || passed >= longest_s * setup.rate_Hz || recorder->failed()) loop->stop();
  if (drilling && drilling->fell_behind()) loop->stop();
  if (drilling && fast() && counts.samples % drilling::kChunkTicks == 0) drilling->work();
  if (fast() && counts.samples % kDrainEveryTicks == 0) recorder->drain();
}

void TrialRun::Parts::apply_remote_commands() {
  if (!setup.outside) return;
  limiter.cap_force(setup.outside->force_N());
  if (setup.outside->stopped()) loop->stop();
}

void TrialRun::Parts::watch_until_end(const loop::LoopThread& thread, const Watch& watch) {
  for (bool over = false; !over;) {
    over = thread.ended_within(kWatch);
    apply_remote_commands();
    if (watch && !watch(glimpse())) loop->stop();
  }
}

core::Result<void> TrialRun::run(const Watch& watch) {
  Parts& p = *parts_;
  loop::LoopThread thread(p.pace(), [&p] { p.loop->run([&p] { p.after_tick(); }); });
  p.grant = thread.grant();
  const core::Json detail = {{"realtime", p.grant.to_json()}};
  if (!p.recorder->append({0.0, "start", detail})) p.loop->stop();  // the error is kept for stop()
  p.limiter.arm();
  if (!p.fast()) p.recorder->start();
  if (p.drilling && !p.fast()) p.drilling->start(p.real_clock);
  thread.go();
  p.watch_until_end(thread, watch);
  thread.join();
  p.finish_drilling();
  if (p.setup.outside && p.setup.outside->stopped()) p.fault = stop_message(*p.setup.outside);
  if (p.limiter.guard() == loop::Guard::latched) p.fault = loop::text_of(p.limiter.fault());
  if (const std::uint64_t lost = p.loop->periods().lost(); lost > 0)
    p.fault = fmt::format("{} samples were not recorded: the disk was too slow", lost);
  p.limiter.disarm();
  return p.recorder->stop();
}

void TrialRun::Parts::finish_drilling() {
  if (!drilling) return;
  drilling->finish();
  if (drilling->fell_behind())
    fault = "the bone could not be worn as fast as the hand drilled: the machine is too busy";
}

std::optional<trial::Answer> TrialRun::simulated_answer() const {
  if (parts_->drilling) return std::nullopt;  // it made the channel, and felt no walls
  if (!parts_->made.trainee || !parts_->made.trainee->done()) return std::nullopt;
  const devices::SimulatedAnswer said = parts_->made.trainee->answer();
  trial::Answer out{.breach = said.breach, .wall = std::nullopt, .confidence = said.confidence};
  if (said.breach) out.wall = said.wall;
  return out;
}

core::Result<void> TrialRun::note(const std::string& kind, const core::Json& detail) {
  return parts_->recorder->append({parts_->elapsed_s(), kind, detail});
}

core::Result<void> TrialRun::Parts::append_end(const TrialReport& report) {
  if (report.drilled) {
    const trial::Event drilled{elapsed_s(), "drilled", report.drilled->detail};
    if (auto said = recorder->append(drilled); !said) return said;
  }
  if (!fault.empty()) return recorder->append({elapsed_s(), "fault", {{"what", fault}}});
  if (report.answer) {
    const trial::Event answered{elapsed_s(), "answer", report.answer->to_json()};
    if (auto said = recorder->append(answered); !said) return said;
  }
  core::Json detail = json_of(report.counts, report.lost);
  detail["injected_J"] = report.injected_J;
  return recorder->append({elapsed_s(), "end", detail});
}

core::Result<TrialReport> TrialRun::finish(const std::optional<trial::Answer>& answer) {
  Parts& p = *parts_;
  const loop::PeriodicLoop& periods = p.loop->periods();
  TrialReport report{.trial_id = p.header.id,
                     .file = p.folder.trial_file(p.header.id),
                     .complete = p.fault.empty(),
                     .fault = p.fault,
                     .duration_s = periods.passed_s(),
                     .counts = periods.counts(),
                     .lost = periods.lost(),
                     .wake_p50_us = periods.wake().quantile_us(0.5),
                     .wake_p99_us = periods.wake().quantile_us(0.99),
                     .work_p50_us = periods.work().quantile_us(0.5),
                     .work_p99_us = periods.work().quantile_us(0.99),
                     .injected_J = p.loop->energy().injected_J(),
                     .grant = p.grant,
                     .answer = answer,
                     .simulated = p.header.simulated};
  if (p.drilling)
    report.drilled = {drilled_detail(*p.drilling, p.prepared), p.drilling->lag_quantile_s(0.5),
                      p.drilling->lag_quantile_s(0.99)};
  if (auto ended = p.append_end(report); !ended) return ended.error();
  if (auto sealed = p.recorder->finish(); !sealed) return sealed.error();
  auto queued = p.folder.outbox().queue(p.header.id, p.header.case_id, report.file);
  if (!queued) return queued.error();
  if (p.drilling)
    if (auto kept = keep_drilled(p.folder, *p.drilling, p.header.id, p.prepared.opened.id); !kept)
      return kept.error();
  return report;
}

}  // namespace session
}  // namespace tractus
