#include "volume/field_sampling.hpp"

#include <immintrin.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace volume {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Four = std::array<float, 4>;
using Six = std::array<float, 6>;

/// w, w′ and w″ of one axis. The middle weights of w′ and w″ close their sums to zero, so that they
/// find nothing in a constant.
struct Weights {
  Four value, slope, curve;
  explicit Weights(float t) {
    const float t2 = t * t, t3 = t2 * t;
    value = {0.5f * (-t3 + 2 * t2 - t), 0.5f * (3 * t3 - 5 * t2) + 1.0f,
             0.5f * (-3 * t3 + 4 * t2 + t), 0.5f * (t3 - t2)};
    slope = {0.5f * (-3 * t2 + 4 * t - 1), 0.0f, 0.5f * (-9 * t2 + 8 * t + 1),
             0.5f * (3 * t2 - 2 * t)};
    slope[1] = -(slope[0] + slope[2] + slope[3]);
    curve = {-3 * t + 2, 0.0f, -9 * t + 4, 3 * t - 1};
    curve[1] = -(curve[0] + curve[2] + curve[3]);
  }
};

/// d_m = (w_{m−1} − w_{m+1})/2 over −2 … 3: central differences folded into weights.
Six differences(const Four& w) {
  return {-0.5f * w[0],         -0.5f * w[1], 0.5f * (w[0] - w[2]),
          0.5f * (w[1] - w[3]), 0.5f * w[2],  0.5f * w[3]};
}

/// The neighbours of a point: `origin` is b at offset (−reach, −reach, −reach) from its cell.
struct Window {
  const float* origin;
  std::ptrdiff_t row, slice;
  std::array<float, 3> t;
  const float* at(int y, int z) const { return origin + y * row + z * slice; }
};

/// Room for the neighbours of a point near or beyond the edge, gathered with the edge repeated.
struct Gathered {
  alignas(32) float b[6 * 6 * 8];
};

void gather(const ScalarGrid& grid, const std::array<int, 3>& first, Gathered& out) {
  const auto& n = grid.dims();
  for (int z = 0; z < 6; ++z)
    for (int y = 0; y < 6; ++y) {
      const float* const row =
          grid.row(std::clamp(first[1] + y, 0, n[1] - 1), std::clamp(first[2] + z, 0, n[2] - 1));
      for (int x = 0; x < 8; ++x)
        out.b[(z * 6 + y) * 8 + x] = row[std::clamp(first[0] + x, 0, n[0] - 1)];
    }
}

/// Neighbours −kReach … kReach + 1 of u on each axis; rows may be read eight floats at a time.
template <int kReach>
Window window(const ScalarGrid& grid, const Vector3d& u, Gathered& room) {
  std::array<int, 3> first{};
  Window found{};
  bool inside = true;
  for (std::size_t a = 0; a < 3; ++a) {
    const int n = grid.dims()[a];
    // Four voxels beyond the edge nothing changes any more; NaN fails both comparisons and becomes
    // 0.
    const double at = u[Eigen::Index(a)];
    const double held = at > -4.0 ? (at < n + 3.0 ? at : n + 3.0) : (at <= -4.0 ? -4.0 : 0.0);
    const double cell = std::floor(held);
    found.t[a] = static_cast<float>(held - cell);
    first[a] = int(cell) - kReach;
    inside = inside && first[a] >= 0 && first[a] + 2 * kReach + 1 < n;
  }
  if (inside) [[likely]] {
    found.origin = grid.at(first[0], first[1], first[2]);
    found.row = grid.row_pitch();
    found.slice = grid.slice_pitch();
  } else {
    gather(grid, first, room);
    found.origin = room.b;
    found.row = 8;
    found.slice = 48;
  }
  return found;
}

__m256 all(float w) { return _mm256_set1_ps(w); }
__m256 fma(float w, __m256 x, __m256 sum) { return _mm256_fmadd_ps(all(w), x, sum); }

__m256 eight(const Six& w) {
  return _mm256_setr_ps(w[0], w[1], w[2], w[3], w[4], w[5], 0.0f, 0.0f);
}
/// The four weights where they lie among six neighbours.
__m256 eight(const Four& w) {
  return _mm256_setr_ps(0.0f, w[0], w[1], w[2], w[3], 0.0f, 0.0f, 0.0f);
}
__m128 four(const Four& w) { return _mm_loadu_ps(w.data()); }

double sum(__m256 v) {
  __m128 s = _mm_add_ps(_mm256_castps256_ps128(v), _mm256_extractf128_ps(v, 1));
  s = _mm_add_ps(s, _mm_movehl_ps(s, s));
  return double(_mm_cvtss_f32(_mm_add_ss(s, _mm_movehdup_ps(s))));
}
double dot(__m256 a, __m256 b) { return sum(_mm256_mul_ps(a, b)); }
double dot(__m128 a, __m128 b) {
  __m128 s = _mm_mul_ps(a, b);
  s = _mm_add_ps(s, _mm_movehl_ps(s, s));
  return double(_mm_cvtss_f32(_mm_add_ss(s, _mm_movehdup_ps(s))));
}

// --- the published field: rows of eight, summed over y and z, then weighed along x
// ---------------------------------

/// Weights of the published field along one axis: w and d and their derivatives.
struct PaperAxis {
  Four w, w1;
  Six d, d1;
  explicit PaperAxis(float t) {
    const Weights weights(t);
    w = weights.value;
    w1 = weights.slope;
    d = differences(w);
    d1 = differences(w1);
  }
};

/// Σ_y over one slice: with w (rows 1 … 4) and with d (rows 0 … 5), and their derivatives.
struct SliceSums {
  __m256 w, w1, d, d1;
};

template <bool kJacobian>
SliceSums slice_sums(const Window& at, const PaperAxis& y, int z) {
  SliceSums s;
  s.w = s.w1 = s.d = s.d1 = _mm256_setzero_ps();
  const bool corner = z == 0 || z == 5;  // there only w is asked for
  for (int r = corner ? 1 : 0; r < (corner ? 5 : 6); ++r) {
    const __m256 row = _mm256_loadu_ps(at.at(r, z));
    const auto k = std::size_t(r);
    if (r >= 1 && r <= 4) {
      s.w = fma(y.w[k - 1], row, s.w);
      if (kJacobian) s.w1 = fma(y.w1[k - 1], row, s.w1);
    }
    if (corner) continue;
    s.d = fma(y.d[k], row, s.d);
    if (kJacobian) s.d1 = fma(y.d1[k], row, s.d1);
  }
  return s;
}

/// Sums over y and z; the letters say the weights along y and z: w, d, or with 1 their derivative.
struct PaperSums {
  __m256 ww, w1w, ww1, dw, d1w, dw1, wd, w1d, wd1;
};

template <bool kJacobian>
PaperSums paper_sums(const Window& at, const PaperAxis& y, const PaperAxis& z) {
  PaperSums s;
  s.ww = s.w1w = s.ww1 = s.dw = s.d1w = s.dw1 = s.wd = s.w1d = s.wd1 = _mm256_setzero_ps();
#pragma GCC unroll 6
  for (int k = 0; k < 6; ++k) {
    const auto six = std::size_t(k);
    const SliceSums slice = slice_sums<kJacobian>(at, y, k);
    s.wd = fma(z.d[six], slice.w, s.wd);
    if (kJacobian) {
      s.w1d = fma(z.d[six], slice.w1, s.w1d);
      s.wd1 = fma(z.d1[six], slice.w, s.wd1);
    }
    if (k == 0 || k == 5) continue;
    const float w = z.w[six - 1], w1 = z.w1[six - 1];
    s.ww = fma(w, slice.w, s.ww);
    s.dw = fma(w, slice.d, s.dw);
    if (kJacobian) {
      s.w1w = fma(w, slice.w1, s.w1w);
      s.ww1 = fma(w1, slice.w, s.ww1);
      s.d1w = fma(w, slice.d1, s.d1w);
      s.dw1 = fma(w1, slice.d, s.dw1);
    }
  }
  return s;
}

// --- the potential field: rows of four
// ------------------------------------------------------------------------------

/// Sums over y and z; the digits are the orders of differentiation along y and z.
struct PotentialSums {
  __m128 s00, s10, s01, s20, s11, s02;
};

template <bool kHessian>
PotentialSums potential_sums(const Window& at, const Weights& y, const Weights& z) {
  PotentialSums s;
  s.s00 = s.s10 = s.s01 = s.s20 = s.s11 = s.s02 = _mm_setzero_ps();
#pragma GCC unroll 4
  for (int k = 0; k < 4; ++k) {
    __m128 a0 = _mm_setzero_ps(), a1 = a0, a2 = a0;
#pragma GCC unroll 4
    for (int r = 0; r < 4; ++r) {
      const __m128 row = _mm_loadu_ps(at.at(r, k));
      a0 = _mm_fmadd_ps(_mm_set1_ps(y.value[std::size_t(r)]), row, a0);
      a1 = _mm_fmadd_ps(_mm_set1_ps(y.slope[std::size_t(r)]), row, a1);
      if (kHessian) a2 = _mm_fmadd_ps(_mm_set1_ps(y.curve[std::size_t(r)]), row, a2);
    }
    const __m128 w = _mm_set1_ps(z.value[std::size_t(k)]),
                 w1 = _mm_set1_ps(z.slope[std::size_t(k)]);
    s.s00 = _mm_fmadd_ps(w, a0, s.s00);
    s.s10 = _mm_fmadd_ps(w, a1, s.s10);
    s.s01 = _mm_fmadd_ps(w1, a0, s.s01);
    if (!kHessian) continue;
    s.s20 = _mm_fmadd_ps(w, a2, s.s20);
    s.s11 = _mm_fmadd_ps(w1, a1, s.s11);
    s.s02 = _mm_fmadd_ps(_mm_set1_ps(z.curve[std::size_t(k)]), a0, s.s02);
  }
  return s;
}

}  // namespace

double interpolated(const ScalarGrid& grid, const Vector3d& u) noexcept {
  Gathered room;
  const Window at = window<1>(grid, u, room);
  const PotentialSums s = potential_sums<false>(at, Weights(at.t[1]), Weights(at.t[2]));
  return dot(s.s00, four(Weights(at.t[0]).value));
}

Vector3d potential_gradient(const ScalarGrid& grid, const Vector3d& u) noexcept {
  Gathered room;
  const Window at = window<1>(grid, u, room);
  const Weights x(at.t[0]);
  const PotentialSums s = potential_sums<false>(at, Weights(at.t[1]), Weights(at.t[2]));
  const __m128 w = four(x.value);
  return {dot(s.s00, four(x.slope)), dot(s.s10, w), dot(s.s01, w)};
}

IndexSample potential_sample(const ScalarGrid& grid, const Vector3d& u) noexcept {
  Gathered room;
  const Window at = window<1>(grid, u, room);
  const Weights x(at.t[0]);
  const PotentialSums s = potential_sums<true>(at, Weights(at.t[1]), Weights(at.t[2]));
  const __m128 w = four(x.value), w1 = four(x.slope);
  const double xx = dot(s.s00, four(x.curve)), xy = dot(s.s10, w1), xz = dot(s.s01, w1);
  const double yy = dot(s.s20, w), yz = dot(s.s11, w), zz = dot(s.s02, w);
  IndexSample out;
  out.gradient = {dot(s.s00, w1), dot(s.s10, w), dot(s.s01, w)};
  out.jacobian << xx, xy, xz, xy, yy, yz, xz, yz, zz;
  return out;
}

Vector3d paper_gradient(const ScalarGrid& grid, const Vector3d& u) noexcept {
  Gathered room;
  const Window at = window<2>(grid, u, room);
  const PaperAxis x(at.t[0]);
  const PaperSums s = paper_sums<false>(at, PaperAxis(at.t[1]), PaperAxis(at.t[2]));
  const __m256 w = eight(x.w);
  return {dot(s.ww, eight(x.d)), dot(s.dw, w), dot(s.wd, w)};
}

IndexSample paper_sample(const ScalarGrid& grid, const Vector3d& u) noexcept {
  Gathered room;
  const Window at = window<2>(grid, u, room);
  const PaperAxis x(at.t[0]);
  const PaperSums s = paper_sums<true>(at, PaperAxis(at.t[1]), PaperAxis(at.t[2]));
  const __m256 w = eight(x.w), w1 = eight(x.w1), d = eight(x.d), d1 = eight(x.d1);
  IndexSample out;
  out.gradient = {dot(s.ww, d), dot(s.dw, w), dot(s.wd, w)};
  out.jacobian << dot(s.ww, d1), dot(s.w1w, d), dot(s.ww1, d),  //
      dot(s.dw, w1), dot(s.d1w, w), dot(s.dw1, w),              //
      dot(s.wd, w1), dot(s.w1d, w), dot(s.wd1, w);
  return out;
}

}  // namespace volume
