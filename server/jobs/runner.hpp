/// The threads that work on jobs.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "core/signing.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/people/pseudonyms.hpp"
#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"
#include "tracing/tracer.hpp"

namespace tractus::jobs {

/// Threads, each for its kinds of jobs: scores and the making of cases, which someone waits for,
/// and what takes minutes (the lab, analyses of a cohort) and runs at low priority, so that it
/// delays neither scores nor requests. Each claims and does one job after the other until nothing
/// waits, then waits to be woken, by this process or by another on the same database. One more
/// renews the claims while they work, and puts back what processes that died had claimed. They end
/// with their object, after the job in hand; a run of the lab or an analysis is left off and waits
/// again; one that ended its process three times is given up.
class Runner {
 public:
  /// Called with one line when something is to be known: a job that failed, a database that
  /// refuses. From any of the threads.
  using Log = std::function<void(const std::string& line)>;

  struct Keys {
    core::KeyPair cases;  ///< signs the cases that are made here
    /// Of the names in analyses; none: there are no analyses.
    std::optional<store::PseudonymKey> pseudonyms = {};
  };

  /// On a database of this process alone, puts jobs that a dead process had claimed back in the
  /// queue; on a shared one they wait until their `lease` is over. Then starts.
  /// @param tracer  null: jobs are not traced
  static core::Result<std::unique_ptr<Runner>> start(
      store::Store& store, const store::Objects& objects, Keys keys, Log log,
      std::chrono::milliseconds lease = std::chrono::seconds(30),
      tracing::Tracer* tracer = nullptr);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;
  /// Something was queued. Safe from any thread.
  void wake();
  /// Returns when no job runs any more; none is begun from then on.
  void end();

 private:
  struct Lane {
    std::vector<store::JobKind> kinds;
    bool woken = true;
    std::string job = {};  ///< the id of the one in hand
    bool lost = false;     ///< it is another process's by now
    std::thread thread = {};
  };

  Runner(store::Store& store, const store::Objects& objects, Keys keys, Log log,
         std::chrono::milliseconds lease, tracing::Tracer* tracer);
  void run(Lane& lane);
  void keep();
  void renew(const std::vector<std::string>& in_hand);
  /// Does one job; false when there is none.
  bool do_one(Lane& lane);
  core::Result<void> work_on(Lane& lane, const store::Job& job);
  /// As a span, if the job belongs to a trace.
  core::Result<void> traced_work_on(Lane& lane, const store::Job& job);
  core::Result<void> conclude(Lane& lane, const store::Job& job, const core::Result<void>& done);
  core::Result<void> note_failure(const store::Job& job, const core::Error& error);
  void take_in_hand(Lane& lane, const std::string& job);
  bool is_lost(Lane& lane);
  bool ending();

  store::Store& store_;
  const store::Objects& objects_;
  const Keys keys_;
  Log log_;
  store::Worker worker_;
  tracing::Tracer* const tracer_;
  std::mutex mutex_;  ///< guards ending_ and the lanes' woken, job, lost
  bool ending_ = false;
  std::condition_variable changed_;
  Lane scores_{{store::JobKind::metrics}}, cases_{{store::JobKind::making, store::JobKind::felt}},
      lab_{{store::JobKind::lab, store::JobKind::analysis}};
  std::thread keeper_;
  std::unique_ptr<store::Listening> listening_;
};

}  // namespace tractus::jobs
