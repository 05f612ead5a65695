/// Sampling of a force field between its voxels.
///
/// Catmull–Rom [Catmull1974; Zoller2020, "Haptic rendering"] weighs four neighbours at −1, 0, 1, 2,
/// t of the way from 0 to 1, by  w(t) = ½ (−t³ + 2t² − t,  3t³ − 5t² + 2,  −3t³ + 4t² + t,  t³ −
/// t²)  along each axis. The potential field is the gradient of b = ω∗α so interpolated. The
/// published field interpolates the central differences of b at the voxels; they are folded into
/// the weights, so that along the differentiated axis b is weighed over six neighbours, −2 … 3:
///
///     Σ_i w_i (b_{i+1} − b_{i−1})/2 = Σ_m d_m b_m,   d_m = (w_{m−1} − w_{m+1})/2
///
/// All is computed per voxel index and turned into V, per metre, at the end.
#include <immintrin.h>

#include <algorithm>

#include "volume/force_field_grid.hpp"

namespace tractus {
namespace volume {
namespace {

__m256 lanes(float a, float b, float c, float d, float e, float f) {
  return _mm256_setr_ps(a, b, c, d, e, f, 0.0f, 0.0f);
}

/// c₀ + c₁ t + c₂ t² + c₃ t³, in pairs: what waits for t is two steps long.
__m256 cubic(float t, __m256 c0, __m256 c1, __m256 c2, __m256 c3) {
  const __m256 x = _mm256_set1_ps(t);
  return _mm256_fmadd_ps(_mm256_fmadd_ps(c3, x, c2), _mm256_mul_ps(x, x),
                         _mm256_fmadd_ps(c1, x, c0));
}
__m256 quadratic(float t, __m256 c0, __m256 c1, __m256 c2) {
  const __m256 x = _mm256_set1_ps(t);
  return _mm256_fmadd_ps(c2, _mm256_mul_ps(x, x), _mm256_fmadd_ps(c1, x, c0));
}

/// The neighbours −2 … 3 of one axis lie in lanes 0 … 5; the four weights w of Catmull–Rom in lanes
/// 1 … 4.
__m256 value_weights(float t) {
  return cubic(t, lanes(0, 0, 1, 0, 0, 0), lanes(0, -0.5f, 0, 0.5f, 0, 0),
               lanes(0, 1, -2.5f, 2, -0.5f, 0), lanes(0, -0.5f, 1.5f, -1.5f, 0.5f, 0));
}
/// w′.
__m256 slope_weights(float t) {
  return quadratic(t, lanes(0, -0.5f, 0, 0.5f, 0, 0), lanes(0, 2, -5, 4, -1, 0),
                   lanes(0, -1.5f, 4.5f, -4.5f, 1.5f, 0));
}
/// w″.
__m256 curve_weights(float t) {
  return quadratic(t, lanes(0, 2, -5, 4, -1, 0), lanes(0, -3, 9, -9, 3, 0), _mm256_setzero_ps());
}
/// d_m = (w_{m−1} − w_{m+1})/2.
__m256 difference_weights(float t) {
  return cubic(t, lanes(0, -0.5f, 0, 0.5f, 0, 0), lanes(0.25f, 0, -0.5f, 0, 0.25f, 0),
               lanes(-0.5f, 1.25f, -0.5f, -1.0f, 1.0f, -0.25f),
               lanes(0.25f, -0.75f, 0.5f, 0.5f, -0.75f, 0.25f));
}
/// d′.
__m256 difference_slope_weights(float t) {
  return quadratic(t, lanes(0.25f, 0, -0.5f, 0, 0.25f, 0), lanes(-1, 2.5f, -1, -2, 2, -0.5f),
                   lanes(0.75f, -2.25f, 1.5f, 1.5f, -2.25f, 0.75f));
}

/// Weights of one axis as they are multiplied with whole rows, one at a time.
struct Each {
  alignas(32) float w[8];
  explicit Each(__m256 weights) { _mm256_store_ps(w, weights); }
  __m256 operator[](int neighbour) const { return _mm256_broadcast_ss(w + neighbour); }
  __m128 narrow(int neighbour) const { return _mm_broadcast_ss(w + neighbour); }
};

/// The neighbours of a point: `origin` is b at the lowest of them.
struct Window {
  const float* origin;
  std::ptrdiff_t row, slice;
  float x, y, z;  // the point's place within its cell, 0 … 1
  const float* at(int j, int k) const { return origin + j * row + k * slice; }
  /// b of the point's own voxel. Rows are read less this: what is differentiated does not see it,
  /// and what is left is small where b is even, and so are its roundings.
  template <int kReach>
  const float* own() const {
    return at(kReach, kReach) + kReach;
  }
};

/// Room for the neighbours of a point near or beyond the edge, gathered with the edge repeated.
struct Gathered {
  alignas(32) float b[6 * 6 * 8];
};

/// A window with the place of the point within its cell, and nothing else yet.
[[gnu::always_inline]] inline Window within_cell(__m256d place) {
  const __m128 t = _mm256_cvtpd_ps(place);
  return {nullptr,
          0,
          0,
          _mm_cvtss_f32(t),
          _mm_cvtss_f32(_mm_movehdup_ps(t)),
          _mm_cvtss_f32(_mm_movehl_ps(t, t))};
}

/// Whether neighbours first … first + 2 reach + 1 of an axis, the edge repeated, are all known.
template <class Grid>
bool knows(const Grid& field, const int (&cell)[4], int reach) {
  bool all = true;
  for (int a = 0; a < 3; ++a) {
    const int last = field.geometry.dims[std::size_t(a)] - 1;
    all = all && std::clamp(cell[a] - reach, 0, last) >= field.known_begin[a] &&
          std::clamp(cell[a] + reach + 1, 0, last) < field.known_end[a];
  }
  return all;
}

/// The window of a point whose neighbours do not all lie in the known part of the grid. Three voxels
/// beyond the edge nothing changes any more, and u is held there.
template <class Grid>
[[gnu::noinline]] Window gathered(const Grid& field, __m256d u, int reach, Gathered& room) {
  const ScalarGrid& grid = field.blurred;
  const auto& n = grid.dims();
  u = _mm256_max_pd(
      u, _mm256_set1_pd(-4.0));  // and no number becomes −4: `max` then answers its second operand
  u = _mm256_min_pd(u, _mm256_setr_pd(n[0] + 3.0, n[1] + 3.0, n[2] + 3.0, 0.0));
  const __m256d floor = _mm256_floor_pd(u);
  alignas(16) int cell[4];
  _mm_store_si128(reinterpret_cast<__m128i*>(cell), _mm256_cvttpd_epi32(floor));
  if (!knows(field, cell, reach)) field.left_part.store(true, std::memory_order_relaxed);
  for (int z = 0; z < 6; ++z)
    for (int y = 0; y < 6; ++y) {
      const float* const row = grid.row(std::clamp(cell[1] - reach + y, 0, n[1] - 1),
                                        std::clamp(cell[2] - reach + z, 0, n[2] - 1));
      for (int x = 0; x < 8; ++x)
        room.b[(z * 6 + y) * 8 + x] = row[std::clamp(cell[0] - reach + x, 0, n[0] - 1)];
    }
  Window found = within_cell(_mm256_sub_pd(u, floor));
  found.origin = room.b;
  found.row = 8;
  found.slice = 48;
  return found;
}

__m256d load(const double* column) { return _mm256_load_pd(column); }

/// Neighbours −kReach … kReach + 1 of p on each axis; rows may be read eight floats at a time.
template <int kReach, class Grid>
[[gnu::always_inline]] inline Window window(const Grid& field, const Vec3& p, Gathered& room) {
  const ScalarGrid& grid = field.blurred;
  const __m128i begin = _mm_load_si128(reinterpret_cast<const __m128i*>(field.known_begin));
  const __m128i end = _mm_load_si128(reinterpret_cast<const __m128i*>(field.known_end));
  __m256d u = _mm256_fmadd_pd(load(field.index_of[0].v), _mm256_set1_pd(p[0]),
                              load(field.index_at_origin.v));
  u = _mm256_fmadd_pd(load(field.index_of[1].v), _mm256_set1_pd(p[1]), u);
  u = _mm256_fmadd_pd(load(field.index_of[2].v), _mm256_set1_pd(p[2]), u);
  const __m256d floor = _mm256_floor_pd(u);
  const __m128i first =
      _mm_sub_epi32(_mm256_cvttpd_epi32(floor), _mm_set1_epi32(kReach));  // INT_MIN: no int
  const __m128i most = _mm_sub_epi32(end, _mm_set1_epi32(2 * kReach + 2));
  const __m128i beyond = _mm_or_si128(_mm_cmpgt_epi32(begin, first), _mm_cmpgt_epi32(first, most));
  if (_mm_movemask_ps(_mm_castsi128_ps(beyond)) & 7) [[unlikely]]
    return gathered(field, u, kReach, room);
  Window found = within_cell(_mm256_sub_pd(u, floor));
  found.origin = grid.at(_mm_extract_epi32(first, 0), _mm_extract_epi32(first, 1),
                         _mm_extract_epi32(first, 2));
  found.row = grid.row_pitch();
  found.slice = grid.slice_pitch();
  return found;
}

/// Three or one inner products at once: (a0·b0, a1·b1, a2·b2, 0).
__m256d dots(__m128 ab0, __m128 ab1, __m128 ab2) {
  const __m128 pairs = _mm_hadd_ps(ab0, ab1);
  return _mm256_cvtps_pd(_mm_hadd_ps(pairs, _mm_hadd_ps(ab2, _mm_setzero_ps())));
}
__m128 folded(__m256 a, __m256 b) {
  const __m256 product = _mm256_mul_ps(a, b);
  return _mm_add_ps(_mm256_castps256_ps128(product), _mm256_extractf128_ps(product, 1));
}
__m256d dots(__m256 a0, __m256 b0, __m256 a1, __m256 b1, __m256 a2, __m256 b2) {
  return dots(folded(a0, b0), folded(a1, b1), folded(a2, b2));
}
__m256d dots(__m128 a0, __m128 b0, __m128 a1, __m128 b1, __m128 a2, __m128 b2) {
  return dots(_mm_mul_ps(a0, b0), _mm_mul_ps(a1, b1), _mm_mul_ps(a2, b2));
}

/// matrix · v of three columns.
template <class Column>
__m256d times(const Column (&matrix)[3], __m256d v) {
  const __m256d x = _mm256_permute4x64_pd(v, 0x00), y = _mm256_permute4x64_pd(v, 0x55),
                z = _mm256_permute4x64_pd(v, 0xaa);
  const __m256d xy = _mm256_fmadd_pd(load(matrix[1].v), y, _mm256_mul_pd(load(matrix[0].v), x));
  return _mm256_fmadd_pd(load(matrix[2].v), z, xy);
}

void store(__m256d v, double* three) {
  _mm_storeu_pd(three, _mm256_castpd256_pd128(v));
  _mm_store_sd(three + 2, _mm256_extractf128_pd(v, 1));
}

/// ∇b and how it changes along each axis, per voxel index; fourth lanes are zero.
struct IndexSample {
  __m256d gradient;
  __m256d along[3];  // ∂(∇b)/∂u_b
};

// --- the published field: rows of eight, summed over y and z, then weighed along x

/// Weights of the published field along y or z: w and d, and with 1 their derivatives.
struct PaperAxis {
  Each w, d, w1, d1;
  explicit PaperAxis(float t)
      : w(value_weights(t)),
        d(difference_weights(t)),
        w1(slope_weights(t)),
        d1(difference_slope_weights(t)) {}
};

/// Sums over y and z; the letters say the weights along y and z: w, d, or with 1 their derivative.
struct PaperSums {
  __m256 ww, w1w, ww1, dw, d1w, dw1, wd, w1d, wd1;
};

/// Adds what the rows of slice kZ came to.
template <bool kJacobian, int kZ>
[[gnu::always_inline]] inline void add_rows(const PaperAxis& z, __m256 w, __m256 w1, __m256 d,
                                            __m256 d1, PaperSums& s) {
  constexpr bool kInner = kZ >= 1 && kZ <= 4;
  s.wd = _mm256_fmadd_ps(z.d[kZ], w, s.wd);
  if (kJacobian) {
    s.w1d = _mm256_fmadd_ps(z.d[kZ], w1, s.w1d);
    s.wd1 = _mm256_fmadd_ps(z.d1[kZ], w, s.wd1);
  }
  if (!kInner) return;
  s.ww = _mm256_fmadd_ps(z.w[kZ], w, s.ww);
  s.dw = _mm256_fmadd_ps(z.w[kZ], d, s.dw);
  if (!kJacobian) return;
  s.w1w = _mm256_fmadd_ps(z.w[kZ], w1, s.w1w);
  s.d1w = _mm256_fmadd_ps(z.w[kZ], d1, s.d1w);
  s.ww1 = _mm256_fmadd_ps(z.w1[kZ], w, s.ww1);
  s.dw1 = _mm256_fmadd_ps(z.w1[kZ], d, s.dw1);
}

/// Adds the slice kZ, 0 … 5. In the outermost slices and rows only what is differentiated that way
/// has weight.
template <bool kJacobian, int kZ>
[[gnu::always_inline]] inline void add_slice(const Window& at, __m256 own, const PaperAxis& y,
                                             const PaperAxis& z, PaperSums& s) {
  constexpr bool kInner = kZ >= 1 && kZ <= 4;
  // In two sums each, of even and odd rows: a chain of six would wait for itself.
  __m256 w[2] = {}, w1[2] = {}, d[2] = {}, d1[2] = {};
#pragma GCC unroll 6
  for (int r = kInner ? 0 : 1; r < (kInner ? 6 : 5); ++r) {
    const __m256 row = _mm256_sub_ps(_mm256_loadu_ps(at.at(r, kZ)), own);
    const int k = r & 1;
    if (r >= 1 && r <= 4) {
      w[k] = _mm256_fmadd_ps(y.w[r], row, w[k]);
      if (kJacobian) w1[k] = _mm256_fmadd_ps(y.w1[r], row, w1[k]);
    }
    if (!kInner) continue;
    d[k] = _mm256_fmadd_ps(y.d[r], row, d[k]);
    if (kJacobian) d1[k] = _mm256_fmadd_ps(y.d1[r], row, d1[k]);
  }
  add_rows<kJacobian, kZ>(z, w[0] + w[1], w1[0] + w1[1], d[0] + d[1], d1[0] + d1[1], s);
}

template <bool kJacobian>
[[gnu::always_inline]] inline PaperSums paper_sums(const Window& at) {
  const PaperAxis y(at.y), z(at.z);
  PaperSums s;
  s.ww = s.w1w = s.ww1 = s.dw = s.d1w = s.dw1 = s.wd = s.w1d = s.wd1 = _mm256_setzero_ps();
  const __m256 own = _mm256_broadcast_ss(at.own<2>());
  add_slice<kJacobian, 0>(at, own, y, z, s);
  add_slice<kJacobian, 1>(at, own, y, z, s);
  add_slice<kJacobian, 2>(at, own, y, z, s);
  add_slice<kJacobian, 3>(at, own, y, z, s);
  add_slice<kJacobian, 4>(at, own, y, z, s);
  add_slice<kJacobian, 5>(at, own, y, z, s);
  return s;
}

// --- the potential field: rows of four

/// Weights along one axis of four neighbours, and their first and second derivatives.
struct PotentialAxis {
  Each w, w1, w2;
  explicit PotentialAxis(float t)
      : w(value_weights(t)), w1(slope_weights(t)), w2(curve_weights(t)) {}
};
/// The four weights alone.
__m128 narrow(__m256 weights) {
  const __m256i from = _mm256_setr_epi32(1, 2, 3, 4, 0, 0, 0, 0);
  return _mm256_castps256_ps128(_mm256_permutevar8x32_ps(weights, from));
}

/// Sums over y and z; the digits are the orders of differentiation along y and z.
struct PotentialSums {
  __m128 s00, s10, s01, s20, s11, s02;
};

template <bool kHessian>
[[gnu::always_inline]] inline PotentialSums potential_sums(const Window& at) {
  const PotentialAxis y(at.y), z(at.z);
  PotentialSums s;
  const __m128 own = _mm_broadcast_ss(at.own<1>());
  s.s00 = s.s10 = s.s01 = s.s20 = s.s11 = s.s02 = _mm_setzero_ps();
#pragma GCC unroll 4
  for (int k = 0; k < 4; ++k) {
    __m128 a0 = _mm_setzero_ps(), a1 = a0, a2 = a0;
#pragma GCC unroll 4
    for (int r = 0; r < 4; ++r) {
      const __m128 row = _mm_sub_ps(_mm_loadu_ps(at.at(r, k)), own);
      a0 = _mm_fmadd_ps(y.w.narrow(r + 1), row, a0);
      a1 = _mm_fmadd_ps(y.w1.narrow(r + 1), row, a1);
      if (kHessian) a2 = _mm_fmadd_ps(y.w2.narrow(r + 1), row, a2);
    }
    s.s00 = _mm_fmadd_ps(z.w.narrow(k + 1), a0, s.s00);
    s.s10 = _mm_fmadd_ps(z.w.narrow(k + 1), a1, s.s10);
    s.s01 = _mm_fmadd_ps(z.w1.narrow(k + 1), a0, s.s01);
    if (!kHessian) continue;
    s.s20 = _mm_fmadd_ps(z.w.narrow(k + 1), a2, s.s20);
    s.s11 = _mm_fmadd_ps(z.w1.narrow(k + 1), a1, s.s11);
    s.s02 = _mm_fmadd_ps(z.w2.narrow(k + 1), a0, s.s02);
  }
  return s;
}

[[gnu::always_inline]] inline __m256d gradient(const Window& at, const PotentialSums& s) {
  const __m128 w = narrow(value_weights(at.x)), w1 = narrow(slope_weights(at.x));
  return dots(s.s00, w1, s.s10, w, s.s01, w);
}

[[gnu::always_inline]] inline IndexSample sample(const Window& at, const PotentialSums& s) {
  const __m128 w = narrow(value_weights(at.x)), w1 = narrow(slope_weights(at.x)),
               w2 = narrow(curve_weights(at.x));
  return {gradient(at, s),
          {dots(s.s00, w2, s.s10, w1, s.s01, w1), dots(s.s10, w1, s.s20, w, s.s11, w),
           dots(s.s01, w1, s.s11, w, s.s02, w)}};
}

[[gnu::always_inline]] inline __m256d gradient(const Window& at, const PaperSums& s) {
  const __m256 w = value_weights(at.x);
  return dots(s.ww, difference_weights(at.x), s.dw, w, s.wd, w);
}

[[gnu::always_inline]] inline IndexSample sample(const Window& at, const PaperSums& s) {
  const __m256 w = value_weights(at.x), w1 = slope_weights(at.x);
  const __m256 d = difference_weights(at.x), d1 = difference_slope_weights(at.x);
  return {dots(s.ww, d, s.dw, w, s.wd, w),
          {dots(s.ww, d1, s.dw, w1, s.wd, w1), dots(s.w1w, d, s.d1w, w, s.w1d, w),
           dots(s.ww1, d, s.dw1, w, s.wd1, w)}};
}

}  // namespace

double ForceField::opacity(const Vec3& p_V_m) const noexcept {
  Gathered room;
  const Window at = window<1>(*grid_, p_V_m, room);
  const __m128 none = _mm_setzero_ps();
  const __m128 product = _mm_mul_ps(potential_sums<false>(at).s00, narrow(value_weights(at.x)));
  return _mm256_cvtsd_f64(dots(product, none, none)) + double(*at.own<1>());
}

Vec3 ForceField::gradient_per_m(const Vec3& p_V_m) const noexcept {
  const Grid& grid = *grid_;
  Gathered room;
  Vec3 g_per_m;
  if (grid.kind == FieldKind::paper) {
    const Window at = window<2>(grid, p_V_m, room);
    store(times(grid.g_of, gradient(at, paper_sums<false>(at))), g_per_m.data());
  } else {
    const Window at = window<1>(grid, p_V_m, room);
    store(times(grid.g_of, gradient(at, potential_sums<false>(at))), g_per_m.data());
  }
  return g_per_m;
}

FieldSample ForceField::sample(const Vec3& p_V_m) const noexcept {
  const Grid& grid = *grid_;
  Gathered room;
  IndexSample found;
  if (grid.kind == FieldKind::paper) {
    const Window at = window<2>(grid, p_V_m, room);
    found = volume::sample(at, paper_sums<true>(at));
  } else {
    const Window at = window<1>(grid, p_V_m, room);
    found = volume::sample(at, potential_sums<true>(at));
  }
  // g = −D ∇b and ∂g/∂p = −D J Dᵀ: first the components of g, then the directions it changes along.
  FieldSample out;
  store(times(grid.g_of, found.gradient), out.g_per_m.data());
  __m256d along[3];
  for (int c = 0; c < 3; ++c) along[c] = times(grid.g_of, found.along[c]);
  for (int b = 0; b < 3; ++b) {
    __m256d sum = _mm256_mul_pd(along[0], _mm256_set1_pd(grid.V_from_index(b, 0)));
    sum = _mm256_fmadd_pd(along[1], _mm256_set1_pd(grid.V_from_index(b, 1)), sum);
    sum = _mm256_fmadd_pd(along[2], _mm256_set1_pd(grid.V_from_index(b, 2)), sum);
    store(sum, out.jacobian_per_m2.col(b).data());
  }
  return out;
}

}  // namespace volume
}  // namespace tractus
