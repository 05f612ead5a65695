/// Code for SSE, as much of the C library is, is slowed where a function before it left the upper halves of the vector registers in use
/// [IntelOptimization]: exp() took twenty times as long after Eigen, compiled by gcc at -O1 without -fexpensive-optimizations, which
/// brings vzeroupper.
#include <gtest/gtest.h>

#include "statistics/anova/anova.hpp"

#ifdef __x86_64__
#include <cpuid.h>

namespace tractus {
namespace statistics {
namespace {

/// Does the processor tell which of its registers are in use (XGETBV with ECX = 1)?
bool tells() {
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid(1, &a, &b, &c, &d) != 0 && (c & bit_OSXSAVE) != 0 &&
         __get_cpuid_count(0xD, 1, &a, &b, &c, &d) != 0 && (a & 4U) != 0;
}

bool upper_halves_in_use() {
  unsigned low = 0, high = 0;
  asm volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(1));
  return (low & 4U) != 0;
}

TEST(VectorRegisters, UpperHalvesAreNotLeftInUse) {
  if (!tells()) GTEST_SKIP() << "this processor does not tell";
  const Groups groups{{"a", "b"},
                      {Vector::LinSpaced(12, 0.0, 1.0), Vector::LinSpaced(12, 0.5, 2.0)}};
  asm volatile("vzeroupper");
  const auto fit = welch(groups);
  const bool left_in_use = upper_halves_in_use();
  EXPECT_TRUE(fit);
  EXPECT_FALSE(left_in_use);
}

}  // namespace
}  // namespace statistics
}  // namespace tractus
#endif
