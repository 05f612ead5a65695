/// Freed memory goes back to the system while the server serves.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace tractus::app {

/// glibc keeps the memory that requests freed. A thread returns it every two seconds, if there were
/// requests since: malloc_trim(3), a few milliseconds in which other threads may wait for memory.
class FreedMemory {
 public:
  FreedMemory();
  ~FreedMemory();
  FreedMemory(const FreedMemory&) = delete;
  FreedMemory& operator=(const FreedMemory&) = delete;

  void note_request() { requests_.store(true, std::memory_order_relaxed); }

 private:
  void run();

  std::atomic<bool> requests_ = false;
  std::mutex mutex_;  ///< guards ending_
  bool ending_ = false;
  std::condition_variable changed_;
  std::thread thread_;
};

}  // namespace tractus::app
