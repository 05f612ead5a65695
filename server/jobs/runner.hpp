/// The threads that work on jobs.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

#include "core/signing.hpp"
#include "db/store/jobs.hpp"
#include "db/store/objects.hpp"
#include "db/store/store.hpp"

namespace jobs {

/// Threads, each for its kinds of jobs: scores and the making of cases, which someone waits for,
/// and what takes minutes (the lab, analyses of a cohort) and runs at low priority, so that it
/// delays neither scores nor requests. Each claims and does one job after the other until nothing
/// waits, then waits to be woken. They end with their object, after the job in hand; a run of the
/// lab or an analysis is left off and begins again after the next start, three times at most.
class Runner {
 public:
  /// Called with one line when something is to be known: a job that failed, a database that
  /// refuses. From any of the threads.
  using Log = std::function<void(const std::string& line)>;

  /// Puts jobs that a dead process had claimed back in the queue, then starts.
  /// @param case_key  signs the cases that are made here.
  static core::Result<std::unique_ptr<Runner>> start(store::Store& store,
                                                     const store::Objects& objects,
                                                     core::KeyPair case_key, Log log);
  ~Runner();
  Runner(const Runner&) = delete;
  Runner& operator=(const Runner&) = delete;
  /// Something was queued. Safe from any thread.
  void wake();

 private:
  struct Lane {
    std::vector<std::string> kinds;
    bool woken = true;
    std::thread thread = {};
  };

  Runner(store::Store& store, const store::Objects& objects, core::KeyPair case_key, Log log);
  void run(Lane& lane);
  /// Does one job; false when there is none.
  bool do_one(const std::vector<std::string>& kinds);
  core::Result<void> work_on(const store::Job& job);
  core::Result<void> note_failure(const store::Job& job, const core::Error& error);
  bool ending();

  store::Store& store_;
  const store::Objects& objects_;
  const core::KeyPair case_key_;
  Log log_;
  std::mutex mutex_;  ///< guards ending_ and what the lanes were woken for
  bool ending_ = false;
  std::condition_variable changed_;
  Lane scores_{{"metrics"}}, cases_{{"case"}}, lab_{{"lab", "analysis"}};
};

}  // namespace jobs
