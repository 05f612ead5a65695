#include "server/app/freed_memory.hpp"

#include <malloc.h>

#include <chrono>

namespace tractus {
namespace app {
namespace {

constexpr std::chrono::seconds kBetweenReturns{2};

}  // namespace

FreedMemory::FreedMemory() : thread_([this] { run(); }) {}

FreedMemory::~FreedMemory() {
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void FreedMemory::run() {
  std::unique_lock held(mutex_);
  while (!changed_.wait_for(held, kBetweenReturns, [this] { return ending_; }))
    if (requests_.exchange(false, std::memory_order_relaxed)) ::malloc_trim(0);
}

}  // namespace app
}  // namespace tractus
