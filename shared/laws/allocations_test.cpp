/// Counts what this program allocates, so that a step can be shown to allocate nothing.
#include <atomic>
#include <cstdlib>
#include <new>

namespace tractus::laws {
namespace {
std::atomic<long> count{0};

void* counted(std::size_t alignment, std::size_t size) {
  ++count;
  if (void* const memory =
          std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment))
    return memory;
  std::abort();
}
}  // namespace

long allocations() noexcept { return count; }
}  // namespace tractus::laws

void* operator new(std::size_t size) { return tractus::laws::counted(16, size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return tractus::laws::counted(std::size_t(alignment), size);
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept { std::free(memory); }
