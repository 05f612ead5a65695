#include "station/session/trial_runner.hpp"

#include <fmt/format.h>

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus {
namespace session {
namespace {
using trial::Event;
using trial::EventKind;

constexpr auto kWatch = std::chrono::milliseconds(30);

core::Result<void> check(const TrialTerms& terms, const devices::DeviceInfo& device) {
  if (terms.speed == Speed::fast && !device.simulated)
    return core::Error{core::Errc::bad_input,
                       fmt::format("--speed fast: {} is held by a person", device.id)};
  if (terms.started_utc_us && terms.speed != Speed::fast)
    return core::Error{core::Errc::bad_input, "--started: is of simulated time, --speed fast"};
  if (!(terms.duration_s >= 1.0 && terms.duration_s <= 3600.0))
    return core::Error{core::Errc::out_of_range,
                       fmt::format("--duration {}: 1 … 3600 s are possible", terms.duration_s)};
  return {};
}
}  // namespace

TrialRunner::TrialRunner(const StationFolder& folder, std::unique_ptr<Rig> rig)
    : folder_(folder), terms_(rig->terms()), time_{.speed = terms_.speed}, rig_(std::move(rig)) {}

core::Result<std::unique_ptr<TrialRunner>> TrialRunner::make(const StationFolder& folder,
                                                             std::unique_ptr<Rig> rig) {
  const TrialTerms terms = rig->terms();
  TRY(check(terms, rig->device()));
  const double bytes = terms.duration_s * terms.rate_Hz * 1.1 * double(rig->sample_bytes());
  TRY(folder.check_room(static_cast<std::uint64_t>(bytes)));
  std::unique_ptr<TrialRunner> made(new TrialRunner(folder, std::move(rig)));
  TRY(made->rig_->prepare(made->time_));
  TRY(made->make_file());
  return made;
}

core::Result<void> TrialRunner::make_file() {
  header_.id = core::new_id();
  header_.station = folder_.config().name;
  header_.device = rig_->device().id;
  header_.started_utc_us = terms_.started_utc_us.value_or(core::utc_us());
  header_.rate_Hz = terms_.rate_Hz;
  header_.extra["clock"] =
      time_.fast() ? "manual: simulated time, run as fast as it goes" : "monotonic: real time";
  if (terms_.started_utc_us) header_.extra["date"] = "simulated";
  rig_->describe(header_);
  auto writer = TRY(trial::TrialWriter::create(folder_.trial_file(header_.id), header_));
  rig_->record(std::move(writer));
  return {};
}

void TrialRunner::apply_remote_commands() {
  if (!terms_.outside) return;
  rig_->cap_force(terms_.outside->force_N());
  if (terms_.outside->stopped()) rig_->stop();
  follow_pause(terms_.outside->paused());
}

// A pause has no time in the trial: its event stands where the samples go on.
void TrialRunner::follow_pause(bool on) {
  if (on == paused_since_.has_value()) return;
  rig_->pause(on);
  const core::Instant_ns now = time_.loop().now();
  if (on) {
    paused_since_ = now;
    return;
  }
  const core::Instant_ns lasted = now - *paused_since_;
  paused_ns_ += lasted;
  pauses_.push_back(
      {rig_->latest(header_).t_s, "paused", {{"lasted_s", static_cast<double>(lasted) * 1e-9}}});
  paused_since_.reset();
}

void TrialRunner::watch_until_end(const loop::LoopThread& thread, const Watch& watch) {
  for (bool over = false; !over;) {
    over = thread.ended_within(kWatch);
    apply_remote_commands();
    if (watch && !watch(rig_->latest(header_))) rig_->stop();
  }
}

core::Result<void> TrialRunner::run(const Watch& watch) {
  loop::LoopThread thread(time_.pace(), [this] { rig_->run(); });
  grant_ = thread.grant();
  loop::TrialRecorder& recorder = rig_->recorder();
  const core::Json detail = {{"realtime", grant_.to_json()}};
  if (!recorder.append(Event::of(0.0, EventKind::start, detail)))
    rig_->stop();  // the error is kept for stop()
  if (!time_.fast()) recorder.start();
  rig_->arm();
  thread.go();
  watch_until_end(thread, watch);
  thread.join();
  follow_pause(false);  // a trial may end in a pause
  settle();
  TRY(recorder.stop());
  for (const trial::Event& event : pauses_) TRY(recorder.append(event));
  return {};
}

// The last reason that holds is the fault.
void TrialRunner::settle() {
  const Rig::Ended ended = rig_->settle();
  fault_ = ended.behind;
  if (terms_.outside && terms_.outside->stopped()) fault_ = stop_message(*terms_.outside);
  if (!ended.latched.empty()) fault_ = ended.latched;
  if (const std::uint64_t lost = rig_->periods().lost(); lost > 0)
    fault_ = fmt::format("{} samples were not recorded: the disk was too slow", lost);
}

double TrialRunner::elapsed_s() {
  return static_cast<double>(time_.loop().now() - rig_->periods().started() - paused_ns_) * 1e-9;
}

core::Result<void> TrialRunner::note(trial::EventKind kind, const core::Json& detail) {
  return rig_->recorder().append(Event::of(elapsed_s(), kind, detail));
}

TrialReport TrialRunner::report_of(const std::optional<trial::Answer>& answer) {
  const loop::PeriodicLoop& periods = rig_->periods();
  TrialReport report{.trial_id = header_.id,
                     .file = folder_.trial_file(header_.id),
                     .complete = fault_.empty(),
                     .fault = fault_,
                     .duration_s = periods.passed_s(),
                     .counts = periods.counts(),
                     .lost = periods.lost(),
                     .wake_p50_us = periods.wake().quantile_us(0.5),
                     .wake_p99_us = periods.wake().quantile_us(0.99),
                     .work_p50_us = periods.work().quantile_us(0.5),
                     .work_p99_us = periods.work().quantile_us(0.99),
                     .grant = grant_,
                     .answer = fault_.empty() ? answer : std::nullopt,
                     .simulated = header_.simulated};
  rig_->complete(report);
  return report;
}

core::Result<void> TrialRunner::append_end(const TrialReport& report) {
  loop::TrialRecorder& recorder = rig_->recorder();
  for (const trial::Event& event : rig_->closing_events(report, elapsed_s()))
    TRY(recorder.append(event));
  if (!fault_.empty())
    return recorder.append(Event::of(elapsed_s(), EventKind::fault, {{"what", fault_}}));
  if (report.answer)
    TRY(recorder.append(Event::of(elapsed_s(), EventKind::answer, report.answer->to_json())));
  return recorder.append(Event::of(elapsed_s(), EventKind::end, rig_->end_detail(report)));
}

core::Result<TrialReport> TrialRunner::finish(const std::optional<trial::Answer>& answer) {
  TrialReport report = report_of(answer);
  TRY(append_end(report));
  TRY(rig_->recorder().finish());
  TRY(folder_.outbox().queue(header_.id, header_.case_id, report.file));
  TRY(rig_->keep(folder_, header_));
  return report;
}

}  // namespace session
}  // namespace tractus
