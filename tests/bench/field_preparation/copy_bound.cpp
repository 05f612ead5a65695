#include <immintrin.h>

#include "bench/field_preparation/rivals.hpp"
#include "bench/support/report.hpp"
#include "volume/scalar_grid.hpp"

namespace tractus::bench {

double copy_bound_s(std::span<const std::uint16_t> counts, int times) {
  const int n = int(counts.size());
  auto out = volume::ScalarGrid::make({n, 1, 1});  // the same kind of memory as ours
  if (!out) return 0.0;
  float* const to = out->row(0, 0);
  const auto copy = [&] {
    for (int k = 0; k + 8 <= n; k += 8) {
      const __m128i eight = _mm_loadu_si128(reinterpret_cast<const __m128i*>(counts.data() + k));
      _mm256_stream_ps(to + k, _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(eight)));
    }
    _mm_sfence();
  };
  copy();  // the memory is there before the time counts
  return seconds(times, process_s, copy);
}

}  // namespace tractus::bench
