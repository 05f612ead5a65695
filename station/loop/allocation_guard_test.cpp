/// The counting operator new of this test program, and the proof that it counts.
#include "station/loop/allocation_guard.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>
#include <vector>

[[gnu::noinline]] void* operator new(std::size_t size) {
  ++tractus::loop::allocations_of_this_thread;
  if (void* memory = std::malloc(size ? size : 1)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++tractus::loop::allocations_of_this_thread;
  const auto align = static_cast<std::size_t>(alignment);
  if (void* memory = std::aligned_alloc(align, (size + align - 1) / align * align)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace tractus {
namespace loop {
thread_local std::uint64_t allocations_of_this_thread = 0;

namespace {
TEST(AllocationGuard, SeesAnAllocation) {
  const AllocationGuard guard;
  const std::vector<int> some(1000);
  EXPECT_EQ(some.size(), 1000u);
  EXPECT_EQ(guard.allocations(), 1u);
}
}  // namespace
}  // namespace loop
}  // namespace tractus
