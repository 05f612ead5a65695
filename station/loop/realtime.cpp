#include "station/loop/realtime.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstring>

namespace tractus {
namespace loop {
namespace {
constexpr int kPriority = 80;
constexpr const char* kLatency = "/dev/cpu_dma_latency";
constexpr std::size_t kStack_bytes = 256 * 1024;

[[gnu::noinline]] void touch_stack() {
  char stack[kStack_bytes];
  std::memset(stack, 0, sizeof stack);
  asm volatile("" : : "r"(stack) : "memory");  // or the compiler leaves it out
}
}  // namespace

core::Json RealtimeGrant::to_json() const {
  return {{"fifo", fifo},
          {"memory_locked", locked},
          {"processors_awake", awake},
          {"warnings", warnings}};
}

Realtime::Realtime() : awake_fd_(::open(kLatency, O_WRONLY | O_CLOEXEC)) {
  const sched_param priority{.sched_priority = kPriority};
  if (const int refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
      refused == 0)
    grant_.fifo = true;
  else
    grant_.warnings.push_back(fmt::format(
        "no real-time priority (SCHED_FIFO): {}; ticks may be late", std::strerror(refused)));
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0)
    grant_.locked = true;
  else
    grant_.warnings.push_back(fmt::format("memory is not locked: {}; a page fault may delay a tick",
                                          std::strerror(errno)));
  const std::int32_t at_once_us = 0;
  if (awake_fd_ >= 0 && ::write(awake_fd_, &at_once_us, sizeof at_once_us) == sizeof at_once_us)
    grant_.awake = true;
  else
    grant_.warnings.push_back(
        fmt::format("processors may sleep between ticks ({}): {}; ticks may be late", kLatency,
                    std::strerror(errno)));
  touch_stack();
}

Realtime::~Realtime() {
  if (awake_fd_ >= 0) ::close(awake_fd_);
}

}  // namespace loop
}  // namespace tractus
