#include "station/session/probing_rig.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/try.hpp"
#include "station/session/fast_rig.hpp"
#include "station/session/rig_entry.hpp"

namespace tractus {
namespace session {
namespace {
constexpr std::size_t kProbingRing = 8192;              // eight seconds
constexpr std::uint64_t kDrainProbingEveryTicks = 100;  // of a fast trial

core::Error wrong(std::string what) { return {core::Errc::out_of_range, std::move(what)}; }
}  // namespace

core::Result<std::unique_ptr<ProbingRig>> ProbingRig::make(const ProbingTask& task,
                                                           const RigSetup& setup) {
  const auto info = TRY(devices::find(setup.device, devices::DeviceKind::rig));
  std::unique_ptr<ProbingRig> made(new ProbingRig(task, setup, info));
  TRY(made->check());
  TRY(made->add_law(task.law));
  return made;
}

ProbingRig::ProbingRig(const ProbingTask& task, const RigSetup& setup,
                       const devices::DeviceInfo& info)
    : task_(task), setup_(setup), info_(info), ring_(kProbingRing) {}

ProbingRig::~ProbingRig() {
  if (made_) made_->device->close();
}

core::Result<void> ProbingRig::check() const {
  if (!(setup_.rate_Hz >= 100.0 && setup_.rate_Hz <= 1000.0))
    return wrong(fmt::format("--rate {}: 100 … 1000 Hz are possible", setup_.rate_Hz));
  if (setup_.speed == Speed::fast && setup_.rate_Hz != 1000.0)
    return wrong("--speed fast: its clock moves by 1 ms a period, --rate 1000 is expected");
  if (!(setup_.skill >= 0.0 && setup_.skill <= 1.0))
    return wrong(fmt::format("--skill {}: 0 … 1 is expected", setup_.skill));
  return {};
}

TrialTerms ProbingRig::terms() const {
  return {.speed = setup_.speed,
          .duration_s = setup_.duration_s,
          .rate_Hz = setup_.rate_Hz,
          .outside = setup_.outside,
          .started_utc_us = setup_.started_utc_us};
}

core::Result<void> ProbingRig::prepare(TrialTime& time) {
  time_ = &time;
  auto made = TRY(time.fast() ? core::Result<devices::MadeRig>(fast_rig(setup_))
                              : info_.make_rig({.address = setup_.address,
                                                .program = setup_.program,
                                                .seed = setup_.seed,
                                                .skill = setup_.skill,
                                                .surgeon = setup_.surgeon}));
  made_.emplace(std::move(made));
  return open_device();
}

core::Result<void> ProbingRig::open_device() {
  auto found = TRY(made_->device->open());
  identity_ = found;
  if (identity_.bus_clock != time_->fast())
    return core::Error{core::Errc::unavailable,
                       fmt::format("rig at {}: its clock is {}", made_->address,
                                   identity_.bus_clock ? "on the bus: not for real time"
                                                       : "its own: not for --speed fast")};
  if (task_.law.travel_m > identity_.travel_m + 1e-9)
    return wrong(fmt::format("the probe stop at {} m lies beyond the rig's travel of {} m",
                             task_.law.travel_m, identity_.travel_m));
  limits_.max_speed_m_s = std::min(limits_.max_speed_m_s, identity_.top_speed_m_s);
  return bring_to_entry(*made_->device, time_->loop(), setup_.rate_Hz);
}

std::string ProbingRig::operator_name() const {
  if (!task_.operator_name.empty()) return task_.operator_name;
  if (!info_.simulated) return "not named";
  if (!setup_.surgeon) return "nobody";
  return fmt::format("simulated surgeon, seed {}, skill {:.2f}", setup_.seed, setup_.skill);
}

void ProbingRig::describe(trial::Header& header) const {
  header.case_id = task_.case_id;
  header.operator_name = operator_name();
  header.simulated = identity_.simulated;
  header.rig = trial::Rig::probing;
  if (!task_.blind) header.probe = {{"travel_m", task_.law.travel_m}};
  header.extra.update(task_.extra);
  header.extra["limits"] = limits_.to_json();
  if (info_.simulated)
    header.extra["simulated_surgeon"] = {{"seed", setup_.seed}, {"skill", setup_.skill}};
}

void ProbingRig::record(trial::TrialWriter writer) {
  recorder_.emplace(ring_, std::move(writer), time_->real);
  guard_.emplace(limits_, task_.law.travel_m, 1.0 / setup_.rate_Hz);
  if (info_.simulated && setup_.surgeon)
    felt_.emplace(setup_.seed, setup_.skill, 1.0 / setup_.rate_Hz);
  loop_.emplace(
      loop::ProbingLoop::Parts{time_->loop(), time_->real, *made_->device, *guard_, ring_, live_},
      *laws_.front(), task_.law.travel_m, setup_.rate_Hz);
}

core::Result<void> ProbingRig::add_law(const laws::ProbingParameters& law) {
  auto made = TRY(models::ProbingRuntime::make(law, task_.effects));
  laws_.push_back(std::make_unique<models::ProbingRuntime>(std::move(made)));
  return {};
}

void ProbingRig::run() noexcept {
  loop_->run([this](const trial::ProbingSample& sample) { after_tick(sample); });
}

// In real time this is under the tick's rules: only atomics are read.
void ProbingRig::after_tick(const trial::ProbingSample& sample) {
  if (felt_ && guard_->enabled())
    felt_->feel(double(sample.speed_m_s), double(sample.fz_N), sample.x_m);
  if (sample.t_s >= setup_.duration_s || recorder_->failed()) stop();
  if (time_->fast() && sample.tick % kDrainProbingEveryTicks == 0) recorder_->drain();
}

TrialSnapshot ProbingRig::latest(const trial::Header& header) const {
  const auto seen = live_.read().value_or(loop::ProbingLoopSnapshot{});
  TrialSnapshot out{.header = header,
                    .blind = task_.blind,
                    .t_s = seen.t_s,
                    .late = seen.missed,
                    .samples_safe = recorder_->samples_safe()};
  if (task_.blind) return out;
  out.progress = std::min(1.0, seen.x_m / task_.law.travel_m);
  out.force_N = std::abs(seen.fz_N);
  out.depth_m = seen.x_m;
  return out;
}

Rig::Ended ProbingRig::settle() {
  Ended out;
  if (guard_->latched()) out.latched = loop::text_of(guard_->fault());
  return out;
}

std::optional<trial::Answer> ProbingRig::simulated_answer() const {
  if (!felt_) return std::nullopt;
  const devices::SimulatedAnswer said = felt_->answer();
  trial::Answer out{.breach = said.breach, .wall = std::nullopt, .confidence = said.confidence};
  if (!said.breach) return out;
  out.wall = said.wall;
  out.depth_m = felt_->depth_m();
  return out;
}

core::Result<void> ProbingRig::retune(const laws::ProbingParameters& law, core::Json what) {
  if (law.travel_m != task_.law.travel_m)
    return wrong("the probe stop cannot be moved while a trial runs");
  TRY(add_law(law));
  loop_->exchange_law(*laws_.back());
  const auto seen = live_.read().value_or(loop::ProbingLoopSnapshot{});
  retuned_.push_back(trial::Event::of(seen.t_s, trial::EventKind::retuned, std::move(what)));
  return {};
}

void ProbingRig::complete(TrialReport& report) {
  made_->device->close();
  report.injected_J = loop_->injected_J();
  report.bus = TrialReport::Bus{guard_->restarts(), loop_->round_trip().quantile_us(0.5),
                                loop_->round_trip().quantile_us(0.99)};
}

std::vector<trial::Event> ProbingRig::closing_events(const TrialReport&, double t_s) const {
  std::vector<trial::Event> out = retuned_;
  out.push_back({t_s, "tare", {{"fz_N", guard_->tare_N()}, {"tz_Nm", guard_->tare_Nm()}}});
  return out;
}

core::Json ProbingRig::end_detail(const TrialReport& report) const {
  const trial::TickCounts& n = report.counts;
  return {{"ticks", n.samples},           {"late_ticks", n.late},
          {"skipped_ticks", n.skipped},   {"missed_periods", n.missed},
          {"lost_exchanges", n.bus_lost}, {"restarts", guard_->restarts()},
          {"limited", n.limited},         {"injected_J", report.injected_J}};
}

core::Result<ProbingTrial> probing_trial(const StationFolder& folder, const ProbingTask& task,
                                         const RigSetup& setup) {
  auto rig = TRY(ProbingRig::make(task, setup));
  return ProbingTrial::make(folder, std::move(rig));
}

core::Result<TrialReport> run_probing_trial(const StationFolder& folder, const ProbingTask& task,
                                            const RigSetup& setup, const Watch& watch,
                                            const Ask& ask) {
  auto made = TRY(probing_trial(folder, task, setup));
  TrialRunner& trial = *made.runner;
  TRY(trial.run(watch));
  if (!trial.fault().empty()) return trial.finish(std::nullopt);
  if (!ask) return trial.finish(trial.simulated_answer());
  auto said = ask(trial.simulated_answer());
  if (said) return trial.finish(*said);
  static_cast<void>(trial.finish(std::nullopt));  // kept, without an answer
  return said.error();
}

}  // namespace session
}  // namespace tractus
