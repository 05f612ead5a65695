/// For tests: counts what operator new gives out. The counting operators are in
/// allocation_guard_test.cpp.
#pragma once

#include <cstdint>

namespace tractus::loop {
extern thread_local std::uint64_t allocations_of_this_thread;

/// Allocations of this thread since it was made.
class AllocationGuard {
 public:
  std::uint64_t allocations() const noexcept { return allocations_of_this_thread - before_; }

 private:
  std::uint64_t before_ = allocations_of_this_thread;
};
}  // namespace tractus::loop
