#include "server/jobs/runner.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include "core/bytes.hpp"
#include "core/clock.hpp"
#include "core/errc_words.hpp"
#include "core/try.hpp"
#include "db/store/cases/case_makings.hpp"
#include "db/store/cohort/analyses.hpp"
#include "db/store/lab/lab.hpp"
#include "db/store/trials/trials.hpp"
#include "db/store/volumes/store_away.hpp"
#include "server/jobs/analyse.hpp"
#include "server/jobs/assess.hpp"
#include "server/jobs/certify_case.hpp"
#include "server/jobs/lab_run.hpp"
#include "server/jobs/make_case.hpp"

namespace tractus {
namespace jobs {
namespace {
using store::JobKind;
constexpr std::uint64_t kMostAttempts = 3;  // of what is not a score
constexpr int kScoreNiceness = 5, kLabNiceness = 10;

/// What a person sees of a job that failed.
core::Result<void> show_failure(store::Writing& tx, const store::Job& job,
                                const core::Error& error) {
  const bool cancelled = error.code == core::Errc::cancelled;
  switch (job.kind) {
    case JobKind::metrics:
      return store::set_assessment_failed(tx, job.subject, error.what);
    case JobKind::lab:
      return store::end_lab_run(
          tx, job.subject, cancelled ? store::LabRunState::cancelled : store::LabRunState::failed,
          error.what, core::utc_us());
    case JobKind::analysis:
      return store::end_analysis(tx, job.subject, store::AnalysisState::failed, error.what,
                                 core::utc_us());
    case JobKind::making:
      return store::fail_making(tx, job.subject, error.what, core::utc_us());
    case JobKind::felt:  // the case stays untried, and its page says so
      return {};
  }
  return {};
}
}  // namespace

core::Result<std::unique_ptr<Runner>> Runner::start(store::Store& store,
                                                    const store::Objects& objects, Keys keys,
                                                    Log log, std::chrono::milliseconds lease,
                                                    tracing::Tracer* tracer) {
  if (!store.shared()) {
    TRY(store.write(
        [](store::Writing& tx) { return store::requeue_claimed_jobs(tx, core::utc_us()); }));
  }
  TRY(queue_untried_cases(store));
  auto runner = std::unique_ptr<Runner>(
      new Runner(store, objects, std::move(keys), std::move(log), lease, tracer));
  auto listening = TRY(store.signals().listen(
      store::kJobsChannel, [own = runner.get()](const store::Signal&) { own->wake(); }));
  runner->listening_ = std::move(listening);
  return runner;
}

Runner::Runner(store::Store& store, const store::Objects& objects, Keys keys, Log log,
               std::chrono::milliseconds lease, tracing::Tracer* tracer)
    : store_(store),
      objects_(objects),
      keys_(std::move(keys)),
      log_(std::move(log)),
      worker_{core::new_id(), std::chrono::microseconds(lease).count()},
      tracer_(tracer) {
  // Of the calling thread and those it starts alone. Refused, it only runs as fast as the rest.
  const auto be_nice = [](int niceness) { (void)setpriority(PRIO_PROCESS, 0, niceness); };
  scores_.thread = std::thread([this, be_nice] { be_nice(kScoreNiceness), run(scores_); });
  cases_.thread = std::thread([this] { run(cases_); });
  lab_.thread = std::thread([this, be_nice] { be_nice(kLabNiceness), run(lab_); });
  keeper_ = std::thread([this] { keep(); });
}

Runner::~Runner() { end(); }

void Runner::end() {
  listening_.reset();
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  for (std::thread* thread : {&scores_.thread, &cases_.thread, &lab_.thread, &keeper_})
    if (thread->joinable()) thread->join();
}

void Runner::wake() {
  {
    const std::lock_guard held(mutex_);
    scores_.woken = cases_.woken = lab_.woken = true;
  }
  changed_.notify_all();
}

void Runner::run(Lane& lane) {
  std::unique_lock held(mutex_);
  while (!ending_) {
    if (!lane.woken) {
      changed_.wait(held);
      continue;
    }
    lane.woken = false;
    held.unlock();
    const bool did = do_one(lane);
    held.lock();
    lane.woken = lane.woken || did;
  }
}

/// Three times within every lease, so that two may fail.
void Runner::keep() {
  const std::chrono::microseconds between(worker_.lease_us / 3);
  std::unique_lock held(mutex_);
  while (!changed_.wait_for(held, between, [this] { return ending_; })) {
    const std::vector<std::string> in_hand{scores_.job, cases_.job, lab_.job};
    held.unlock();
    if (in_hand != std::vector<std::string>(3)) renew(in_hand);
    if (store_.shared()) {
      auto back = store_.write(
          [](store::Writing& tx) { return store::requeue_lapsed_jobs(tx, core::utc_us()); });
      if (!back) log_("jobs: " + back.error().what);
      wake();  // a signal may have been missed
    }
    held.lock();
  }
}

/// @param in_hand  what the lanes had before the database was asked: a job claimed since is no loss
void Runner::renew(const std::vector<std::string>& in_hand) {
  auto own = store_.write_beside(
      [&](store::Writing& tx) { return store::renew_claims(tx, worker_, core::utc_us()); });
  if (!own) return log_("jobs: " + own.error().what);
  const std::lock_guard held(mutex_);
  for (Lane* lane : {&scores_, &cases_, &lab_})
    if (!lane->job.empty() && std::ranges::find(in_hand, lane->job) != in_hand.end() &&
        std::ranges::find(*own, lane->job) == own->end())
      lane->lost = true;
}

bool Runner::do_one(Lane& lane) {
  auto job = store_.write_beside([&](store::Writing& tx) {
    return store::claim_job(tx, lane.kinds, core::utc_us(), worker_);
  });
  if (!job) {
    log_("jobs: " + job.error().what);
    return false;
  }
  if (!*job) return false;
  take_in_hand(lane, (*job)->id);
  const auto done = conclude(lane, **job, traced_work_on(lane, **job));
  take_in_hand(lane, "");
  if (!done) log_("jobs: " + done.error().what);
  return !ending();
}

core::Result<void> Runner::conclude(Lane& lane, const store::Job& job,
                                    const core::Result<void>& done) {
  if (is_lost(lane)) return {};
  const bool stopped = !done && done.error().code == core::Errc::cancelled && ending();
  // Where files are kept is away: the job, which did not fail, waits until it is back.
  const bool waits = !done && store::is_store_away(done.error());
  if (waits)
    log_(fmt::format("job {} of {} waits: {}", core::name(job.kind), job.subject,
                     done.error().what));
  if (stopped || waits)
    return store_.write(
        [&](store::Writing& tx) { return store::give_back_job(tx, job, core::utc_us()); });
  if (!done) {
    const auto trace = tracing::parse_traceparent(job.traceparent);
    log_(fmt::format("job {} of {} failed: {}{}", core::name(job.kind), job.subject,
                     done.error().what, trace ? " (trace " + trace->trace_id + ")" : ""));
    return note_failure(job, done.error());
  }
  return store_.write_beside(
      [&](store::Writing& tx) { return store::finish_job(tx, job, core::utc_us()); });
}

void Runner::take_in_hand(Lane& lane, const std::string& job) {
  const std::lock_guard held(mutex_);
  lane.job = job;
  lane.lost = false;
}

bool Runner::is_lost(Lane& lane) {
  const std::lock_guard held(mutex_);
  return lane.lost;
}

bool Runner::ending() {
  const std::lock_guard held(mutex_);
  return ending_;
}

core::Result<void> Runner::traced_work_on(Lane& lane, const store::Job& job) {
  const auto parent = tracing::parse_traceparent(job.traceparent);
  tracing::Span span(parent ? tracer_ : nullptr, fmt::format("job {}", core::name(job.kind)),
                     tracing::SpanKind::consumer, parent);
  span.set("tractus.job.attempt", job.attempts);
  auto done = work_on(lane, job);
  if (!done) span.set_failed(std::string(core::name(done.error().code)));
  return done;
}

core::Result<void> Runner::work_on(Lane& lane, const store::Job& job) {
  if (job.kind == JobKind::metrics) return assess_trial(store_, objects_, job.subject);
  if (job.attempts > kMostAttempts)
    return core::Error{core::Errc::unavailable, "the server ended each time it ran this job"};
  const auto wants_to_end = [this, &lane] { return ending() || is_lost(lane); };
  if (job.kind == JobKind::felt) return certify_case(store_, objects_, job.subject);
  if (job.kind == JobKind::making)
    return make_case(store_, objects_, keys_.cases, job.subject, wants_to_end);
  return job.kind == JobKind::analysis
             ? analyse(store_, objects_, keys_.pseudonyms, job.subject, wants_to_end)
             : run_lab(store_, objects_, job.subject, wants_to_end);
}

core::Result<void> Runner::note_failure(const store::Job& job, const core::Error& error) {
  return store_.write([&](store::Writing& tx) -> core::Result<void> {
    TRY(store::fail_job(tx, job, error.what, core::utc_us()));
    return show_failure(tx, job, error);
  });
}

}  // namespace jobs
}  // namespace tractus
