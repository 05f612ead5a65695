#include "station/session/probing_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "core/bytes.hpp"
#include "station/devices/felt_breach.hpp"
#include "station/loop/loop_thread.hpp"
#include "station/loop/probing_loop.hpp"
#include "station/loop/recorder.hpp"
#include "station/session/fast_rig.hpp"
#include "station/session/rig_entry.hpp"

namespace tractus {
namespace session {
namespace {
constexpr std::size_t kRing = 8192;              // eight seconds
constexpr std::uint64_t kDrainEveryTicks = 100;  // of a fast trial
constexpr auto kWatch = std::chrono::milliseconds(30);

core::Error wrong(std::string what) { return {core::Errc::out_of_range, std::move(what)}; }

core::Result<void> check(const RigSetup& setup, const devices::DeviceInfo& info) {
  if (setup.speed == Speed::fast && !info.simulated)
    return core::Error{core::Errc::bad_input,
                       fmt::format("--speed fast: {} is held by a person", info.id)};
  if (!(setup.rate_Hz >= 100.0 && setup.rate_Hz <= 1000.0))
    return wrong(fmt::format("--rate {}: 100 … 1000 Hz are possible", setup.rate_Hz));
  if (setup.started_utc_us && setup.speed != Speed::fast)
    return core::Error{core::Errc::bad_input, "--started: is of simulated time, --speed fast"};
  if (setup.speed == Speed::fast && setup.rate_Hz != 1000.0)
    return wrong("--speed fast: its clock moves by 1 ms a period, --rate 1000 is expected");
  if (!(setup.duration_s >= 1.0 && setup.duration_s <= 3600.0))
    return wrong(fmt::format("--duration {}: 1 … 3600 s are possible", setup.duration_s));
  if (!(setup.skill >= 0.0 && setup.skill <= 1.0))
    return wrong(fmt::format("--skill {}: 0 … 1 is expected", setup.skill));
  return {};
}

/// The layers as far as the probe can go: a model may say more of the bone than a rig reaches.
std::vector<laws::Layer> within_travel(std::vector<laws::Layer> layers, double travel_m) {
  std::erase_if(layers, [&](const laws::Layer& layer) { return layer.start_m >= travel_m; });
  for (laws::Layer& layer : layers)
    layer.thickness_m = std::min(layer.thickness_m, travel_m - layer.start_m);
  return layers;
}
}  // namespace

core::Result<ProbingTask> task_of(const scenarios::Scenario& scenario,
                                  const std::optional<models::ProbingModel>& model) {
  auto law = scenario.expanded();
  if (!law) return law.error();
  ProbingTask task;
  task.case_id = scenario.id();
  task.law = std::move(*law);
  task.extra["scenario"] = scenario.to_json();
  if (model) {
    task.law.layers = within_travel(model->layers, task.law.travel_m);
    task.law.rotary = model->rotary;
    task.effects = model->effects;
    task.extra["model"] = model->to_json();
  }
  if (auto fits = models::ProbingRuntime::make(task.law, task.effects); !fits) return fits.error();
  return task;
}

core::Result<ProbingTask> task_of(const models::ProbingModel& model, double travel_m) {
  ProbingTask task;
  const core::Json json = model.to_json();
  task.case_id =
      core::sha256(core::bytes_of(json.dump(-1, ' ', true, core::Json::error_handler_t::replace)));
  task.law.layers = within_travel(model.layers, travel_m);
  task.law.rotary = model.rotary;
  task.law.travel_m = travel_m;
  task.effects = model.effects;
  task.extra["model"] = json;
  if (auto fits = models::ProbingRuntime::make(task.law, task.effects); !fits) return fits.error();
  return task;
}

struct ProbingTrialRun::Parts {
  const StationFolder& folder;
  ProbingTask task;
  RigSetup setup;
  devices::DeviceInfo info;
  std::optional<devices::MadeRig> rig;
  devices::RigIdentity identity;
  trial::Header header;
  core::MonotonicClock real_clock;
  core::ManualClock manual_clock;
  loop::ProbingRing ring{kRing};
  loop::Seqlock<loop::ProbingLoopSnapshot> live;
  loop::RigLimits limits;
  std::optional<loop::ProbingGuard> guard;
  std::vector<std::unique_ptr<models::ProbingRuntime>> laws;  // all that were ever felt
  std::optional<devices::FeltBreach> felt;
  std::optional<loop::ProbingRecorder> recorder;
  std::optional<loop::ProbingLoop> loop;
  loop::RealtimeGrant grant;
  std::string fault;
  std::vector<trial::Event> retuned;

  Parts(const StationFolder& where, const ProbingTask& what, const RigSetup& how,
        const devices::DeviceInfo& of)
      : folder(where), task(what), setup(how), info(of) {}
  bool fast() const { return setup.speed == Speed::fast; }
  loop::Pace pace() const { return fast() ? loop::Pace::as_fast_as_goes : loop::Pace::real_time; }
  core::Clock& clock() { return fast() ? static_cast<core::Clock&>(manual_clock) : real_clock; }
  double elapsed_s() {
    return static_cast<double>(clock().now() - loop->periods().started()) * 1e-9;
  }
  std::string operator_name() const;
  core::Result<void> make_device();
  core::Result<void> open_device();
  core::Result<void> make_file();
  core::Result<void> add_law(const laws::ProbingParameters& law);
  void after_tick(const trial::ProbingSample& sample);
  ProbingTrialSnapshot glimpse() const;
  void apply_remote_commands();
  void watch_until_end(const loop::LoopThread& thread, const ProbingWatch& watch);
  core::Result<void> append_end(const std::optional<trial::Answer>& answer);
};

core::Result<void> ProbingTrialRun::Parts::make_device() {
  auto made = fast() ? core::Result<devices::MadeRig>(fast_rig(setup))
                     : info.make_rig({.address = setup.address,
                                      .program = setup.program,
                                      .seed = setup.seed,
                                      .skill = setup.skill,
                                      .surgeon = setup.surgeon});
  if (!made) return made.error();
  rig.emplace(std::move(*made));
  return {};
}

core::Result<void> ProbingTrialRun::Parts::open_device() {
  if (auto made = make_device(); !made) return made;
  auto found = rig->device->open();
  if (!found) return found.error();
  identity = *found;
  if (identity.bus_clock != fast())
    return core::Error{core::Errc::unavailable,
                       fmt::format("rig at {}: its clock is {}", rig->address,
                                   identity.bus_clock ? "on the bus: not for real time"
                                                      : "its own: not for --speed fast")};
  if (task.law.travel_m > identity.travel_m + 1e-9)
    return wrong(fmt::format("the probe stop at {} m lies beyond the rig's travel of {} m",
                             task.law.travel_m, identity.travel_m));
  limits.max_speed_m_s = std::min(limits.max_speed_m_s, identity.top_speed_m_s);
  return bring_to_entry(*rig->device, clock(), setup.rate_Hz);
}

std::string ProbingTrialRun::Parts::operator_name() const {
  if (!task.operator_name.empty()) return task.operator_name;
  if (!info.simulated) return "not named";
  if (!setup.surgeon) return "nobody";
  return fmt::format("simulated surgeon, seed {}, skill {:.2f}", setup.seed, setup.skill);
}

core::Result<void> ProbingTrialRun::Parts::make_file() {
  header.id = core::new_id();
  header.case_id = task.case_id;
  header.station = folder.config().name;
  header.operator_name = operator_name();
  header.simulated = identity.simulated;
  header.device = info.id;
  header.started_utc_us = setup.started_utc_us.value_or(core::utc_us());
  header.rate_Hz = setup.rate_Hz;
  header.rig = trial::Rig::probing;
  if (!task.blind) header.probe = {{"travel_m", task.law.travel_m}};
  header.extra = task.extra;
  header.extra["clock"] =
      fast() ? "manual: simulated time, run as fast as it goes" : "monotonic: real time";
  header.extra["limits"] = limits.to_json();
  if (setup.started_utc_us) header.extra["date"] = "simulated";
  if (info.simulated)
    header.extra["simulated_surgeon"] = {{"seed", setup.seed}, {"skill", setup.skill}};
  auto writer = trial::TrialWriter::create(folder.trial_file(header.id), header);
  if (!writer) return writer.error();
  recorder.emplace(ring, std::move(*writer), real_clock);
  return {};
}

core::Result<void> ProbingTrialRun::Parts::add_law(const laws::ProbingParameters& law) {
  auto made = models::ProbingRuntime::make(law, task.effects);
  if (!made) return made.error();
  laws.push_back(std::make_unique<models::ProbingRuntime>(std::move(*made)));
  return {};
}

core::Result<std::unique_ptr<ProbingTrialRun>> ProbingTrialRun::make(const StationFolder& folder,
                                                                     const ProbingTask& task,
                                                                     const RigSetup& setup) {
  auto info = devices::find(setup.device, devices::DeviceKind::rig);
  if (!info) return info.error();
  if (auto fine = check(setup, *info); !fine) return fine.error();
  const double bytes =
      setup.duration_s * setup.rate_Hz * 1.1 * double(sizeof(trial::ProbingSample));
  if (auto room = folder.check_room(static_cast<std::uint64_t>(bytes)); !room) return room.error();
  auto parts = std::make_unique<Parts>(folder, task, setup, *info);
  if (auto made = parts->add_law(task.law); !made) return made.error();
  if (auto opened = parts->open_device(); !opened) return opened.error();
  if (auto created = parts->make_file(); !created) return created.error();
  parts->guard.emplace(parts->limits, task.law.travel_m, 1.0 / setup.rate_Hz);
  if (info->simulated && setup.surgeon)
    parts->felt.emplace(setup.seed, setup.skill, 1.0 / setup.rate_Hz);
  parts->loop.emplace(
      loop::ProbingLoop::Parts{parts->clock(), parts->real_clock, *parts->rig->device,
                               *parts->guard, parts->ring, parts->live},
      *parts->laws.front(), task.law.travel_m, setup.rate_Hz);
  return std::unique_ptr<ProbingTrialRun>(new ProbingTrialRun(std::move(parts)));
}

ProbingTrialRun::ProbingTrialRun(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
ProbingTrialRun::~ProbingTrialRun() { parts_->rig->device->close(); }
const std::string& ProbingTrialRun::fault() const { return parts_->fault; }

// In real time this is under the tick's rules: only atomics are read.
void ProbingTrialRun::Parts::after_tick(const trial::ProbingSample& sample) {
  if (felt && guard->enabled())
    felt->feel(double(sample.speed_m_s), double(sample.fz_N), sample.x_m);
  if (sample.t_s >= setup.duration_s || recorder->failed()) loop->stop();
  if (fast() && sample.tick % kDrainEveryTicks == 0) recorder->drain();
}

ProbingTrialSnapshot ProbingTrialRun::Parts::glimpse() const {
  const auto seen = live.read().value_or(loop::ProbingLoopSnapshot{});
  ProbingTrialSnapshot out{.trial_id = header.id,
                           .t_s = seen.t_s,
                           .missed = seen.missed,
                           .samples_safe = recorder->samples_safe()};
  if (task.blind) return out;
  out.x_m = seen.x_m, out.speed_m_s = seen.speed_m_s, out.push_N = seen.fz_N, out.mode = seen.mode;
  return out;
}

void ProbingTrialRun::Parts::apply_remote_commands() {
  if (!setup.outside) return;
  guard->cap_push(setup.outside->force_N());
  if (setup.outside->stopped()) loop->stop();
}

void ProbingTrialRun::Parts::watch_until_end(const loop::LoopThread& thread,
                                             const ProbingWatch& watch) {
  for (bool over = false; !over;) {
    over = thread.ended_within(kWatch);
    apply_remote_commands();
    if (watch && !watch(glimpse())) loop->stop();
  }
}

core::Result<void> ProbingTrialRun::run(const ProbingWatch& watch) {
  Parts& p = *parts_;
  loop::LoopThread thread(p.pace(), [&p] {
    p.loop->run([&p](const trial::ProbingSample& sample) { p.after_tick(sample); });
  });
  p.grant = thread.grant();
  const core::Json detail = {{"realtime", p.grant.to_json()}};
  if (!p.recorder->append({0.0, "start", detail})) p.loop->stop();  // the error is kept for stop()
  if (!p.fast()) p.recorder->start();
  thread.go();
  p.watch_until_end(thread, watch);
  thread.join();
  if (p.setup.outside && p.setup.outside->stopped()) p.fault = stop_message(*p.setup.outside);
  if (p.guard->latched()) p.fault = loop::text_of(p.guard->fault());
  if (const std::uint64_t lost = p.loop->periods().lost(); lost > 0)
    p.fault = fmt::format("{} samples were not recorded: the disk was too slow", lost);
  return p.recorder->stop();
}

std::optional<trial::Answer> ProbingTrialRun::simulated_answer() const {
  if (!parts_->felt) return std::nullopt;
  const devices::SimulatedAnswer said = parts_->felt->answer();
  trial::Answer out{.breach = said.breach, .wall = std::nullopt, .confidence = said.confidence};
  if (!said.breach) return out;
  out.wall = said.wall;
  out.depth_m = parts_->felt->depth_m();
  return out;
}

core::Result<void> ProbingTrialRun::retune(const laws::ProbingParameters& law, core::Json what) {
  Parts& p = *parts_;
  if (law.travel_m != p.task.law.travel_m)
    return wrong("the probe stop cannot be moved while a trial runs");
  if (auto made = p.add_law(law); !made) return made;
  p.loop->exchange_law(*p.laws.back());
  const auto seen = p.live.read().value_or(loop::ProbingLoopSnapshot{});
  p.retuned.push_back({seen.t_s, "retuned", std::move(what)});
  return {};
}

core::Result<void> ProbingTrialRun::Parts::append_end(const std::optional<trial::Answer>& answer) {
  for (const trial::Event& event : retuned)
    if (auto said = recorder->append(event); !said) return said;
  const core::Json tare = {{"fz_N", guard->tare_N()}, {"tz_Nm", guard->tare_Nm()}};
  if (auto said = recorder->append({elapsed_s(), "tare", tare}); !said) return said;
  if (!fault.empty()) return recorder->append({elapsed_s(), "fault", {{"what", fault}}});
  if (answer)
    if (auto said = recorder->append({elapsed_s(), "answer", answer->to_json()}); !said)
      return said;
  const trial::TickCounts& n = loop->counts();
  return recorder->append({elapsed_s(),
                           "end",
                           {{"ticks", n.samples},
                            {"late_ticks", n.late},
                            {"skipped_ticks", n.skipped},
                            {"missed_periods", n.missed},
                            {"lost_exchanges", n.bus_lost},
                            {"restarts", guard->restarts()},
                            {"limited", n.limited},
                            {"injected_J", loop->injected_J()}}});
}

core::Result<TrialReport> ProbingTrialRun::finish(const std::optional<trial::Answer>& answer) {
  Parts& p = *parts_;
  p.rig->device->close();
  const loop::PeriodicLoop& periods = p.loop->periods();
  TrialReport report{
      .trial_id = p.header.id,
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
      .injected_J = p.loop->injected_J(),
      .grant = p.grant,
      .answer = p.fault.empty() ? answer : std::nullopt,
      .simulated = p.header.simulated,
      .bus = TrialReport::Bus{p.guard->restarts(), p.loop->round_trip().quantile_us(0.5),
                              p.loop->round_trip().quantile_us(0.99)}};
  if (auto ended = p.append_end(answer); !ended) return ended.error();
  if (auto sealed = p.recorder->finish(); !sealed) return sealed.error();
  auto queued = p.folder.outbox().queue(p.header.id, p.header.case_id, report.file);
  if (!queued) return queued.error();
  return report;
}

core::Result<TrialReport> run_probing_trial(
    const StationFolder& folder, const ProbingTask& task, const RigSetup& setup,
    const ProbingWatch& watch,
    const std::function<core::Result<std::optional<trial::Answer>>(const ProbingTrialRun&)>& ask) {
  auto made = ProbingTrialRun::make(folder, task, setup);
  if (!made) return made.error();
  ProbingTrialRun& trial = **made;
  if (auto ran = trial.run(watch); !ran) return ran.error();
  if (!trial.fault().empty()) return trial.finish(std::nullopt);
  if (!ask) return trial.finish(trial.simulated_answer());
  auto said = ask(trial);
  if (said) return trial.finish(*said);
  static_cast<void>(trial.finish(std::nullopt));  // kept, without an answer
  return said.error();
}

}  // namespace session
}  // namespace tractus
