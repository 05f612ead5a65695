#include "lab/signal/smoother.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

#include "core/require.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

/// Symmetric 3 × 3: 00 01 02 11 12 22.
using Sym = std::array<double, 6>;
using Three = std::array<double, 3>;

/// What the forward pass leaves for the backward one: the state expected before a sample, its
/// covariance, and by how much the sample surprised.
struct Before {
  Three x;
  Sym p;
  double innovation, variance;
};

/// A break in the filter's units.
struct Jump {
  double share, rate_variance, acceleration_variance;
};

/// The filter in units of one sample's noise and of the mean spacing.
class Filter {
 public:
  /// @param r  variance of each sample's noise.
  /// @param jumps  by sample: the break before it.
  Filter(std::span<const double> dt, std::span<const double> y, std::span<const double> r,
         std::map<std::size_t, Jump> jumps)
      : dt_(dt), y_(y), r_(r), jumps_(std::move(jumps)) {
    before_.resize(y.size());
    double most = 1.0;
    for (std::size_t k = 1; k < y.size(); ++k) most = std::max(most, std::abs(y[k] - y[k - 1]));
    first_ = {1e2, 0, 0, 1e2 * most * most, 0, most * most};
  }

  /// @param q  intensity of the third derivative's noise before each sample.
  void forward(std::span<const double> q) {
    Three x{y_[0], 0.0, 0.0};
    Sym p = first_;
    for (std::size_t k = 0; k < y_.size(); ++k) {
      if (k > 0) advance(k, q[k], x, p);
      Before& now = before_[k];
      now = {x, p, y_[k] - x[0], p[0] + r_[k]};
      update(now, x, p);
    }
  }

  /// Squares of what each sample differs by from what the others say of it, in units of its noise,
  /// into `left_out`.
  void leave_out(std::span<double> left_out) const {
    backward([&](std::size_t k, const Three&, const Sym&, double u, double d) {
      left_out[k] = (u / d) * (u / d) / r_[k];
    });
  }

  /// take(sample, smoothed state, its covariance).
  template <class Take>
  void smooth(const Take& take) const {
    backward([&](std::size_t k, const Three& r, const Sym& n, double, double) {
      const Before& b = before_[k];
      const auto row = [](const Sym& s, int i) {
        constexpr std::array<std::array<std::size_t, 3>, 3> at{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
        const auto& a = at[std::size_t(i)];
        return Three{s[a[0]], s[a[1]], s[a[2]]};
      };
      Three x = b.x, var{};
      for (int i = 0; i < 3; ++i) {
        const Three p = row(b.p, i);
        x[std::size_t(i)] += p[0] * r[0] + p[1] * r[1] + p[2] * r[2];
        double lost = 0.0;
        for (int j = 0; j < 3; ++j) {
          const Three nj = row(n, j);
          lost += p[std::size_t(j)] * (nj[0] * p[0] + nj[1] * p[1] + nj[2] * p[2]);
        }
        var[std::size_t(i)] = std::max(0.0, p[std::size_t(i)] - lost);
      }
      take(k, x, var);
    });
  }

 private:
  /// From sample k − 1 to k, with the jump between them if there is one.
  void advance(std::size_t k, double q, Three& x, Sym& p) const {
    const auto jump = jumps_.find(k);
    if (jump == jumps_.end()) return predict(dt_[k], q, x, p);
    predict(jump->second.share * dt_[k], q, x, p);
    p[3] += jump->second.rate_variance;
    p[5] += jump->second.acceleration_variance;
    predict((1.0 - jump->second.share) * dt_[k], q, x, p);
  }

  static void predict(double h, double q, Three& x, Sym& p) {
    x[0] += h * (x[1] + 0.5 * h * x[2]);
    x[1] += h * x[2];
    const double g = 0.5 * h * h;
    const double a00 = p[0] + h * p[1] + g * p[2], a01 = p[1] + h * p[3] + g * p[4],
                 a02 = p[2] + h * p[4] + g * p[5];
    const double a11 = p[3] + h * p[4], a12 = p[4] + h * p[5];
    const double h2 = h * h, h3 = h2 * h;
    p = {a00 + h * a01 + g * a02 + q * h3 * h2 / 20.0,
         a01 + h * a02 + q * h2 * h2 / 8.0,
         a02 + q * h3 / 6.0,
         a11 + h * a12 + q * h3 / 3.0,
         a12 + q * h2 / 2.0,
         p[5] + q * h};
  }

  static void update(const Before& b, Three& x, Sym& p) {
    const double k0 = b.p[0] / b.variance, k1 = b.p[1] / b.variance, k2 = b.p[2] / b.variance;
    x = {x[0] + k0 * b.innovation, x[1] + k1 * b.innovation, x[2] + k2 * b.innovation};
    p = {b.p[0] - k0 * b.p[0], b.p[1] - k0 * b.p[1], b.p[2] - k0 * b.p[2],
         b.p[3] - k1 * b.p[1], b.p[4] - k1 * b.p[2], b.p[5] - k2 * b.p[2]};
  }

  /// The adjoint recursion: take(k, r, N, u, D) with r, N such that the smoothed state is
  /// x + P r and its covariance P − P N P, and u/D the left-out residual.
  template <class Take>
  void backward(const Take& take) const {
    Three r{};
    Sym n{};
    for (std::size_t k = y_.size(); k-- > 0;) {
      if (k + 1 < y_.size()) {  // r ← Fᵀ r, N ← Fᵀ N F
        const double h = dt_[k + 1], g = 0.5 * h * h;
        r = {r[0], r[1] + h * r[0], r[2] + h * r[1] + g * r[0]};
        const double b01 = n[1] + h * n[0], b02 = n[2] + h * n[1] + g * n[0];
        const double c11 = n[3] + h * n[1], c12 = n[4] + h * n[3] + g * n[1];
        const double c02 = b02, c22 = n[5] + h * n[4] + g * n[2];
        n = {n[0], b01, c02, c11 + h * b01, c12 + h * b02, c22 + h * c12 + g * c02};
      }
      const Before& b = before_[k];
      const Three gain{b.p[0] / b.variance, b.p[1] / b.variance, b.p[2] / b.variance};
      const Three ng{n[0] * gain[0] + n[1] * gain[1] + n[2] * gain[2],
                     n[1] * gain[0] + n[3] * gain[1] + n[4] * gain[2],
                     n[2] * gain[0] + n[4] * gain[1] + n[5] * gain[2]};
      const double gng = gain[0] * ng[0] + gain[1] * ng[1] + gain[2] * ng[2];
      const double u =
          b.innovation / b.variance - (gain[0] * r[0] + gain[1] * r[1] + gain[2] * r[2]);
      const double d = 1.0 / b.variance + gng;
      // r ← Hᵀe/S + (I − K H)ᵀ r = r + Hᵀ u, N ← HᵀH/S + (I − K H)ᵀ N (I − K H)
      r[0] += u;
      n = {n[0] - 2.0 * ng[0] + d, n[1] - ng[1], n[2] - ng[2], n[3], n[4], n[5]};
      take(k, r, n, u, d);
    }
  }

  std::span<const double> dt_, y_, r_;
  std::map<std::size_t, Jump> jumps_;
  Sym first_{};
  std::vector<Before> before_;
};

/// Mean over ± `reach` samples, fewer at the ends.
void average(std::span<double> y, std::size_t reach, std::vector<double>& sums) {
  const std::size_t n = y.size();
  sums.resize(n + 1);
  sums[0] = 0.0;
  for (std::size_t k = 0; k < n; ++k) sums[k + 1] = sums[k] + y[k];
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t from = k < reach ? 0 : k - reach, end = std::min(n, k + reach + 1);
    y[k] = (sums[end] - sums[from]) / double(end - from);
  }
}

constexpr const auto& kSmoothing = kSettings.smoothing;

/// The bank of cut-offs tried on one stretch of signal.
class Bank {
 public:
  Bank(Filter& filter, std::span<const double> variance, double spacing_s)
      : variance_(variance), size_(variance.size()), spacing_s_(spacing_s) {
    const std::size_t size = size_;
    const double usual = std::min(kSmoothing.highest_cutoff_Hz, 0.2 / spacing_s),
                 highest = kSmoothing.highest_cutoff_of_rate / spacing_s;
    std::vector<double> q(size), sums;
    for (double f = std::min(kSmoothing.lowest_cutoff_Hz, usual); f <= highest;
         f *= kSmoothing.cutoff_ratio) {
      if (f > usual * 1.001 && !still_improving()) break;
      std::ranges::fill(q, intensity(f));
      filter.forward(q);
      std::vector<double> score(size);
      filter.leave_out(score);
      std::vector<double> longer = score;
      average(score, shorter(), sums);
      average(longer, std::max(shorter(), std::size_t(kSmoothing.reach_periods / (f * spacing_s))),
              sums);
      cutoff_Hz_.push_back(f);
      short_.push_back(std::move(score));
      long_.push_back(std::move(longer));
    }
  }

  /// log q at each sample: the cut-off that is best for the whole, and more where that is not
  /// enough.
  std::vector<double> log_intensity() const {
    const std::size_t usual = best_for_all();
    std::vector<std::size_t> chosen(size_);
    for (std::size_t k = 0; k < size_; ++k) {
      std::size_t j = usual;
      while (j + 1 < cutoff_Hz_.size() && too_smooth(j, k)) ++j;
      chosen[k] = j;
    }
    std::vector<double> log_q(size_), sums;
    const auto widened = widen(chosen);
    for (std::size_t k = 0; k < size_; ++k) log_q[k] = std::log(intensity(cutoff_Hz_[widened[k]]));
    average(log_q, shorter() / 2, sums);
    return log_q;
  }

 private:
  double intensity(double cutoff_Hz) const {
    return std::pow(2.0 * std::numbers::pi * cutoff_Hz * spacing_s_, 6);
  }
  std::size_t shorter() const {
    return std::size_t(std::max(kSmoothing.reach_s / spacing_s_, kSmoothing.reach_samples));
  }
  std::size_t longer(std::size_t j) const {
    return std::max(shorter(),
                    std::size_t(kSmoothing.reach_periods / (cutoff_Hz_[j] * spacing_s_)));
  }

  std::size_t best_for_all() const {
    std::size_t best = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < cutoff_Hz_.size(); ++j) {
      double sum = 0.0;
      for (std::size_t k = 0; k < size_; ++k)
        sum += std::min(long_[j][k], kSmoothing.greatest_misfit) / variance_[k];
      if (sum < least) least = sum, best = j;
    }
    return best;
  }

  /// Is the motion faster than the highest cut-off so far? Then each higher one predicts the samples left out much better,
  /// which it does not where they are only noisier than was thought.
  bool still_improving() const {
    if (long_.size() < 2) return false;
    const double now = middle_of(long_.back()), before = middle_of(long_[long_.size() - 2]);
    return now > kSmoothing.greatest_misfit && now < kSmoothing.faster_motion_fall * before;
  }

  static double middle_of(std::vector<double> values) {
    const auto at = values.begin() + std::ptrdiff_t(values.size() / 2);
    std::ranges::nth_element(values, at);
    return *at;
  }

  bool too_smooth(std::size_t j, std::size_t k) const {
    const auto over = [](double mean, std::size_t reach) {
      return mean > 1.0 + kSmoothing.significant_errors * std::sqrt(2.0 / double(2 * reach + 1));
    };
    return over(short_[j][k], shorter()) || over(long_[j][k], longer(j));
  }

  /// Each choice holds for the stretch that it was judged by.
  std::vector<std::size_t> widen(const std::vector<std::size_t>& chosen) const {
    std::vector<std::size_t> out = chosen;
    const std::size_t reach = shorter();
    std::size_t left = 0, high = 0;
    for (std::size_t k = 0; k < size_; ++k) {  // from the left, then from the right
      if (chosen[k] >= high) high = chosen[k], left = reach;
      out[k] = std::max(out[k], high);
      if (left > 0 && --left == 0) high = chosen[k];
    }
    left = high = 0;
    for (std::size_t k = size_; k-- > 0;) {
      if (chosen[k] >= high) high = chosen[k], left = reach;
      out[k] = std::max(out[k], high);
      if (left > 0 && --left == 0) high = chosen[k];
    }
    return out;
  }

  std::span<const double> variance_;
  std::size_t size_;
  double spacing_s_;
  std::vector<double> cutoff_Hz_;
  std::vector<std::vector<double>> short_, long_;  // [cut-off][sample], mean squares left out
};

/// One stretch, into `out` from sample `from` on, without its first `skip` samples.
void smooth_stretch(std::span<const double> t_s, std::span<const double> y, double sd,
                    std::span<const double> variance, const std::vector<Break>& breaks,
                    std::size_t skip, std::size_t from, Smoothed& out) {
  const std::size_t n = y.size();
  const double spacing_s = (t_s.back() - t_s.front()) / double(n - 1);
  std::vector<double> dt(n, 1.0), scaled(n), q(n);
  for (std::size_t k = 1; k < n; ++k) dt[k] = (t_s[k] - t_s[k - 1]) / spacing_s;
  for (std::size_t k = 0; k < n; ++k) scaled[k] = (y[k] - y[0]) / sd;
  const double rate = kSmoothing.jump_rate_m_s * spacing_s / sd,
               acceleration = kSmoothing.jump_acceleration_m_s2 * spacing_s * spacing_s / sd;
  std::map<std::size_t, Jump> jumps;
  for (const Break& one : breaks)
    if (one.sample > from && one.sample < from + n)
      jumps[one.sample - from] = {one.share, rate * rate, acceleration * acceleration};
  Filter filter(dt, scaled, variance, std::move(jumps));
  q = Bank(filter, variance, spacing_s).log_intensity();
  for (double& v : q) v = std::exp(v);
  filter.forward(q);
  filter.smooth([&](std::size_t k, const Three& x, const Three& var) {
    if (k < skip) return;
    const std::size_t at = from + k;
    const double per = 1.0 / spacing_s;
    out.value[at] = y[0] + sd * x[0];
    out.rate[at] = sd * per * x[1];
    out.acceleration[at] = sd * per * per * x[2];
    out.value_sd[at] = sd * std::sqrt(var[0]);
    out.rate_sd[at] = sd * per * std::sqrt(var[1]);
    out.acceleration_sd[at] = sd * per * per * std::sqrt(var[2]);
  });
}

}  // namespace

namespace {

/// Standard deviation of white noise by differences of an order, which pass 2 · 1·3 … of its variance: the sum of the
/// squares of the binomial coefficients. 0 where the signal is too short.
double noise_by_differences(std::span<const double> y, int order, NoiseQuantile of) {
  constexpr std::size_t kWindow = 16;
  if (y.size() < std::size_t(order) + 5) return 0.0;
  std::vector<double> d(y.begin(), y.end());
  double passed = 1.0;
  for (int k = 1; k <= order; ++k) {
    for (std::size_t i = 0; i + std::size_t(k) < y.size(); ++i) d[i] = d[i + 1] - d[i];
    passed *= double(4 * k - 2) / double(k);
  }
  d.resize(y.size() - std::size_t(order));
  std::vector<double> squares;
  const std::size_t window = std::min(kWindow, d.size());
  for (std::size_t at = 0; at + window <= d.size(); at += window) {
    double sum = 0.0;
    for (std::size_t k = at; k < at + window; ++k) sum += d[k] * d[k];
    squares.push_back(sum / double(window) / passed);
  }
  const auto low = squares.begin() + std::ptrdiff_t(of.share * double(squares.size()));
  std::ranges::nth_element(squares, low);
  return std::sqrt(*low / of.of_mean);
}

}  // namespace

double noise_sd(std::span<const double> y, NoiseQuantile of) {
  return noise_by_differences(y, 3, of);
}

double noise_sd_on_fast_motion(std::span<const double> y) {
  // The quantile's share of the mean falls with the order, as neighbouring differences are less independent.
  constexpr std::array<std::pair<int, double>, 3> kHigher{{{5, 0.6333}, {7, 0.6062}, {9, 0.5825}}};
  double sd = noise_sd(y);
  for (const auto& [order, of_mean] : kHigher) {
    const double now = noise_by_differences(y, order, {kNoiseQuantile.share, of_mean});
    if (!(now > 0.0) || now > kSmoothing.fast_motion_fall * sd) break;
    sd = now;
  }
  return sd;
}

std::vector<double> rounding_variance(std::span<const double> y) {
  std::vector<double> out(y.size(), 1.0);
  for (std::size_t from = 0, end = 0; from < y.size(); from = end) {
    while (end < y.size() && y[end] == y[from]) ++end;
    std::fill(out.begin() + std::ptrdiff_t(from), out.begin() + std::ptrdiff_t(end),
              std::max(1.0, double(end - from) - 1.0));
  }
  return out;
}

Smoothed smooth(std::span<const double> t_s, std::span<const double> y, double noise_sd,
                const std::vector<Break>& breaks) {
  const std::vector<double> variance = rounding_variance(y);
  core::require(t_s.size() == y.size() && y.size() >= 4 && noise_sd > 0.0,
                "a smoother needs four samples and their noise");
  const std::size_t n = y.size();
  double most = 0.0;
  for (std::size_t k = 1; k < y.size(); ++k) most = std::max(most, std::abs(y[k] - y[k - 1]));
  noise_sd = std::max(noise_sd, kSmoothing.least_noise * most);
  Smoothed out;
  out.noise_sd = noise_sd;
  for (auto* all : {&out.value, &out.rate, &out.acceleration, &out.value_sd, &out.rate_sd,
                    &out.acceleration_sd})
    all->resize(n);
  for (std::size_t from = 0; from < n;) {
    // The overlap is smoothed by both stretches; the middle of it is where one takes over.
    const std::size_t end = n - from <= kSmoothing.stretch_samples + kSmoothing.overlap_samples
                                ? n
                                : from + kSmoothing.stretch_samples;
    smooth_stretch(t_s.subspan(from, end - from), y.subspan(from, end - from), noise_sd,
                   std::span(variance).subspan(from, end - from), breaks,
                   from == 0 ? 0 : kSmoothing.overlap_samples / 2, from, out);
    if (end == n) break;
    from = end - kSmoothing.overlap_samples;
  }
  return out;
}

}  // namespace lab
}  // namespace tractus
