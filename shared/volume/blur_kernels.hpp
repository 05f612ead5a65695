/// The inner loops of the blur: 13 symmetric taps over floats, eight at a time (AVX2).
#pragma once

#include <immintrin.h>

#include <array>
#include <cmath>

namespace volume::blur_kernels {

inline constexpr int kTaps = 6;  ///< taps each side that are computed (blur.hpp says why not seven)

/// w_0 … w_6 of the 15-tap Gaussian, normalised over all 15.
inline std::array<float, kTaps + 1> weights() {
  double sum = 0.0;
  for (int k = -7; k <= 7; ++k) sum += std::exp(-0.5 * k * k);
  std::array<float, kTaps + 1> w{};
  for (int k = 0; k <= kTaps; ++k)
    w[std::size_t(k)] = static_cast<float>(std::exp(-0.5 * k * k) / sum);
  return w;
}

/// The weights, each in all lanes.
struct Weights {
  __m256 w[kTaps + 1];
  Weights() {
    const auto scalar = weights();
    for (std::size_t k = 0; k < scalar.size(); ++k) w[k] = _mm256_set1_ps(scalar[k]);
  }
};

/// Along a row: out[0 … n) from in[−6 … n+6); n a multiple of 8.
inline void along_row(Weights weights, const float* in, int n, float* out) {
  for (int x = 0; x < n; x += 8) {
    __m256 sum = _mm256_mul_ps(weights.w[0], _mm256_loadu_ps(in + x));
    for (int k = 1; k <= kTaps; ++k) {
      const __m256 pair = _mm256_add_ps(_mm256_loadu_ps(in + x - k), _mm256_loadu_ps(in + x + k));
      sum = _mm256_fmadd_ps(weights.w[k], pair, sum);
    }
    _mm256_storeu_ps(out + x, sum);
  }
}

/// Where a result goes: kept in the caches, or past them (32-byte aligned).
enum class Store { cached, streamed };

template <Store kStore>
inline void store(float* to, __m256 value) {
  if constexpr (kStore == Store::streamed)
    _mm256_stream_ps(to, value);
  else
    _mm256_storeu_ps(to, value);
}

/// Across 13 rows in[0 … 13): out[0 … n).
template <Store kStore>
inline void across_one(Weights weights, const float* const* in, int n, float* out) {
  for (int x = 0; x < n; x += 8) {
    const auto row = [&](int m) { return _mm256_loadu_ps(in[m] + x); };
    __m256 sum = _mm256_mul_ps(weights.w[0], row(kTaps));
    for (int k = 1; k <= kTaps; ++k)
      sum = _mm256_fmadd_ps(weights.w[k], _mm256_add_ps(row(kTaps - k), row(kTaps + k)), sum);
    store<kStore>(out + x, sum);
  }
}

/// Across 16 rows: four neighbouring results out[0 … 4). From the middle outward, so that each row
/// is loaded once: at step k the results need rows 6 − k … 9 − k, which slide down, and 6 + k … 9 +
/// k, which slide up.
template <Store kStore>
inline void across_four(const Weights& weights, const float* const* in, int n, float* const* out) {
  for (int x = 0; x < n; x += 8) {
    const auto row = [&](int m) { return _mm256_loadu_ps(in[m] + x); };
    __m256 low[4] = {row(kTaps), row(kTaps + 1), row(kTaps + 2), row(kTaps + 3)};
    __m256 high[4] = {low[0], low[1], low[2], low[3]};
    __m256 sum[4];
    for (int j = 0; j < 4; ++j) sum[j] = _mm256_mul_ps(weights.w[0], low[j]);
#pragma GCC unroll 6
    for (int k = 1; k <= kTaps; ++k) {
      low[3] = low[2], low[2] = low[1], low[1] = low[0], low[0] = row(kTaps - k);
      high[0] = high[1], high[1] = high[2], high[2] = high[3], high[3] = row(kTaps + 3 + k);
#pragma GCC unroll 4
      for (int j = 0; j < 4; ++j)
        sum[j] = _mm256_fmadd_ps(weights.w[k], _mm256_add_ps(low[j], high[j]), sum[j]);
    }
    for (int j = 0; j < 4; ++j) store<kStore>(out[j] + x, sum[j]);
  }
}

}  // namespace volume::blur_kernels
