#include "server/jobs/runner.hpp"

#include <fmt/format.h>
#include <sys/resource.h>

#include "core/clock.hpp"
#include "db/store/analyses.hpp"
#include "db/store/case_makings.hpp"
#include "db/store/lab.hpp"
#include "db/store/trials.hpp"
#include "server/jobs/analyse.hpp"
#include "server/jobs/assess.hpp"
#include "server/jobs/lab_run.hpp"
#include "server/jobs/make_case.hpp"

namespace jobs {
namespace {
constexpr std::uint64_t kMostAttempts = 3;  // of what is not a score
constexpr int kLabNiceness = 10;

/// What a person sees of a job that failed.
core::Result<void> show_failure(store::Writing& tx, const store::Job& job,
                                const core::Error& error) {
  if (job.kind == "analysis")
    return store::fail_analysis(tx, job.subject, error.what, core::utc_us());
  if (job.kind == "case") return store::fail_making(tx, job.subject, error.what, core::utc_us());
  if (job.kind != "lab") return store::set_assessment_failed(tx, job.subject, error.what);
  const bool cancelled = error.code == core::Errc::cancelled;
  return store::end_lab_run(tx, job.subject, cancelled ? "cancelled" : "failed", error.what,
                            core::utc_us());
}
}  // namespace

core::Result<std::unique_ptr<Runner>> Runner::start(store::Store& store,
                                                    const store::Objects& objects,
                                                    core::KeyPair case_key, Log log) {
  auto back = store.write(
      [](store::Writing& tx) { return store::requeue_claimed_jobs(tx, core::utc_us()); });
  if (!back) return back.error();
  return std::unique_ptr<Runner>(new Runner(store, objects, std::move(case_key), std::move(log)));
}

Runner::Runner(store::Store& store, const store::Objects& objects, core::KeyPair case_key, Log log)
    : store_(store), objects_(objects), case_key_(std::move(case_key)), log_(std::move(log)) {
  scores_.thread = std::thread([this] { run(scores_); });
  cases_.thread = std::thread([this] { run(cases_); });
  lab_.thread = std::thread([this] {
    // Of this thread and those it starts alone. Refused, the lab only runs as fast as the rest.
    (void)setpriority(PRIO_PROCESS, 0, kLabNiceness);
    run(lab_);
  });
}

Runner::~Runner() {
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  scores_.thread.join();
  cases_.thread.join();
  lab_.thread.join();
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
    const bool did = do_one(lane.kinds);
    held.lock();
    lane.woken = lane.woken || did;
  }
}

bool Runner::do_one(const std::vector<std::string>& kinds) {
  auto job =
      store_.write([&](store::Writing& tx) { return store::claim_job(tx, kinds, core::utc_us()); });
  if (!job) {
    log_("jobs: " + job.error().what);
    return false;
  }
  if (!*job) return false;
  core::Result<void> done = work_on(**job);
  if (!done && done.error().code == core::Errc::cancelled && ending())
    return false;  // still claimed: it waits again after the next start
  if (!done) {
    log_(fmt::format("job {} of {} failed: {}", (*job)->kind, (*job)->subject, done.error().what));
    done = note_failure(**job, done.error());
  } else {
    done = store_.write(
        [&](store::Writing& tx) { return store::finish_job(tx, (*job)->id, core::utc_us()); });
  }
  if (!done) log_("jobs: " + done.error().what);
  return true;
}

bool Runner::ending() {
  const std::lock_guard held(mutex_);
  return ending_;
}

core::Result<void> Runner::work_on(const store::Job& job) {
  if (job.kind == "metrics") return assess_trial(store_, objects_, job.subject);
  if (job.attempts > kMostAttempts)
    return core::Error{core::Errc::unavailable, "it ended the server before it was done"};
  const auto wants_to_end = [this] { return ending(); };
  if (job.kind == "case") return make_case(store_, objects_, case_key_, job.subject, wants_to_end);
  return job.kind == "analysis" ? analyse(store_, objects_, job.subject, wants_to_end)
                                : run_lab(store_, objects_, job.subject, wants_to_end);
}

core::Result<void> Runner::note_failure(const store::Job& job, const core::Error& error) {
  return store_.write([&](store::Writing& tx) -> core::Result<void> {
    if (auto shown = show_failure(tx, job, error); !shown) return shown;
    return store::fail_job(tx, job.id, error.what, core::utc_us());
  });
}

}  // namespace jobs
