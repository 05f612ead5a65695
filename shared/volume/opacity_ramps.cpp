#include "volume/opacity_ramps.hpp"

#include <immintrin.h>

#include <algorithm>
#include <cmath>

namespace tractus {
namespace volume {
namespace {

constexpr double kLastCount = 65535.0;

/// A straight piece of α over counts.
struct Piece {
  double from, to, opacity_from, opacity_to;
};

/// The part of a piece that counts can reach.
Piece within_counts(const Piece& piece) {
  const auto at = [&](double count) {
    const double share = (count - piece.from) / (piece.to - piece.from);
    return piece.opacity_from + share * (piece.opacity_to - piece.opacity_from);
  };
  Piece cut = piece;
  if (piece.from < 0.0) cut.from = 0.0, cut.opacity_from = at(0.0);
  if (piece.to > kLastCount) cut.to = kLastCount, cut.opacity_to = at(kLastCount);
  return cut;
}

}  // namespace

OpacityRamps::OpacityRamps(const TransferFunction& transfer, double slope, double intercept) {
  base_ = static_cast<float>(transfer.opacity(intercept));  // α of count 0; the ramps lie above it
  const auto& points = transfer.points();
  for (std::size_t k = 1; k < points.size() && slope != 0.0; ++k) {
    Piece piece{(points[k - 1].value - intercept) / slope, (points[k].value - intercept) / slope,
                points[k - 1].opacity, points[k].opacity};
    if (piece.from > piece.to) {
      std::swap(piece.from, piece.to);
      std::swap(piece.opacity_from, piece.opacity_to);
    }
    if (!(piece.to > 0.0 && piece.from < kLastCount && piece.to > piece.from)) continue;
    piece = within_counts(piece);
    const double start = std::round(piece.from), inverse = 1.0 / (piece.to - piece.from);
    ramps_.push_back({static_cast<float>(start), static_cast<float>(inverse),
                      static_cast<float>((piece.from - start) * inverse),
                      static_cast<float>(piece.opacity_to - piece.opacity_from)});
  }
}

float OpacityRamps::opacity(std::uint16_t count) const noexcept {
  float sum = base_;
  for (const Ramp& ramp : ramps_) {
    const float t = std::fma(float(count) - ramp.start, ramp.inverse_width, -ramp.offset);
    sum = std::fma(ramp.rise, std::min(std::max(t, 0.0f), 1.0f), sum);
  }
  return sum;
}

void OpacityRamps::opacities(const std::uint16_t* counts, int n, float* out) const noexcept {
  const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1.0f);
  int at = 0;
  for (; at + 8 <= n; at += 8) {
    const __m128i packed = _mm_loadu_si128(reinterpret_cast<const __m128i*>(counts + at));
    const __m256 count = _mm256_cvtepi32_ps(_mm256_cvtepu16_epi32(packed));
    __m256 sum = _mm256_set1_ps(base_);
    for (const Ramp& ramp : ramps_) {
      const __m256 from_start = _mm256_sub_ps(count, _mm256_set1_ps(ramp.start));
      __m256 t = _mm256_fmsub_ps(from_start, _mm256_set1_ps(ramp.inverse_width),
                                 _mm256_set1_ps(ramp.offset));
      t = _mm256_min_ps(_mm256_max_ps(t, zero), one);
      sum = _mm256_fmadd_ps(_mm256_set1_ps(ramp.rise), t, sum);
    }
    _mm256_storeu_ps(out + at, sum);
  }
  for (; at < n; ++at) out[at] = opacity(counts[at]);
}

}  // namespace volume
}  // namespace tractus
