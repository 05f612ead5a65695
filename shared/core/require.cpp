#include "core/require.hpp"

#include <cstdio>
#include <cstdlib>

namespace tractus::core {

void broken_belief(const char* belief, const char* file, int line) noexcept {
  std::fprintf(stderr, "%s:%d: this was believed and is not so: %s\n", file, line, belief);
  std::abort();
}

}  // namespace tractus::core
