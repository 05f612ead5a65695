#include "station/loop/realtime.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>

namespace loop {
namespace {
constexpr int kPriority = 80;
constexpr std::size_t kStack_bytes = 256 * 1024;

[[gnu::noinline]] void touch_stack() {
  char stack[kStack_bytes];
  std::memset(stack, 0, sizeof stack);
  asm volatile("" : : "r"(stack) : "memory");  // or the compiler leaves it out
}
}  // namespace

core::Json RealtimeGrant::to_json() const {
  return {{"fifo", fifo}, {"memory_locked", locked}, {"warnings", warnings}};
}

RealtimeGrant prepare_realtime() {
  RealtimeGrant grant;
  const sched_param priority{.sched_priority = kPriority};
  if (const int refused = pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
      refused == 0)
    grant.fifo = true;
  else
    grant.warnings.push_back(fmt::format(
        "no real-time priority (SCHED_FIFO): {}; ticks may be late", std::strerror(refused)));
  if (::mlockall(MCL_CURRENT | MCL_FUTURE) == 0)
    grant.locked = true;
  else
    grant.warnings.push_back(fmt::format("memory is not locked: {}; a page fault may delay a tick",
                                         std::strerror(errno)));
  touch_stack();
  return grant;
}

}  // namespace loop
