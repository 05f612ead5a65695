/// The inner loops of the blur: 13 symmetric taps over floats, eight at a time (AVX2).
#pragma once

#include <immintrin.h>

#include <array>
#include <cmath>

namespace tractus::volume::blur_kernels {

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

/// Eight floats that begin `kBy` floats into `low`, `high` following it by four.
template <int kBy>
inline __m256 shifted(__m256 high, __m256 low) {
  return _mm256_castsi256_ps(
      _mm256_alignr_epi8(_mm256_castps_si256(high), _mm256_castps_si256(low), 4 * kBy));
}

/// Along a row: out[0 … n) from in[−8 … n + 8); n a multiple of 8. Neighbours up to four away are
/// shifted in from what is loaded already, as loads straddle cache lines; two sums, so that neither
/// waits for the other.
inline void along_row(Weights weights, const float* in, int n, float* out) {
  __m256 here = _mm256_loadu_ps(in), entering = _mm256_loadu_ps(in - 4);
  for (int x = 0; x < n; x += 8) {
    const __m256 after = _mm256_loadu_ps(in + x + 8);
    const __m256 leaving = _mm256_permute2f128_ps(here, after, 0x21);  // from in + x + 4
    const auto add = [&](__m256 sum, int k, __m256 left, __m256 right) {
      return _mm256_fmadd_ps(weights.w[k], _mm256_add_ps(left, right), sum);
    };
    __m256 even = _mm256_mul_ps(weights.w[0], here);
    __m256 odd = _mm256_mul_ps(
        weights.w[1], _mm256_add_ps(shifted<3>(here, entering), shifted<1>(leaving, here)));
    even = add(even, 2, shifted<2>(here, entering), shifted<2>(leaving, here));
    odd = add(odd, 3, shifted<1>(here, entering), shifted<3>(leaving, here));
    even = add(even, 4, entering, leaving);
    odd = add(odd, 5, _mm256_loadu_ps(in + x - 5), _mm256_loadu_ps(in + x + 5));
    even = add(even, 6, _mm256_loadu_ps(in + x - 6), _mm256_loadu_ps(in + x + 6));
    _mm256_storeu_ps(out + x, _mm256_add_ps(even, odd));
    here = after, entering = leaving;
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

}  // namespace tractus::volume::blur_kernels
