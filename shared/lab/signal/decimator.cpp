#include "lab/signal/decimator.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kDecimation = kSettings.decimation;

double blackman(double share) {  // share −1 … 1 of the half width
  const double a = std::numbers::pi * share;
  return 0.42 + 0.5 * std::cos(a) + 0.08 * std::cos(2.0 * a);
}

}  // namespace

Decimator::Decimator(double spacing_s, double rate_Hz) {
  const double factor = 1.0 / (spacing_s * rate_Hz);
  if (factor < kDecimation.least_factor) {
    taps_ = {1.0};
    return;
  }
  stride_ = std::size_t(std::lround(factor));
  const auto half = std::size_t(std::ceil(kDecimation.half_periods * double(stride_)));
  double sum = 0.0;
  for (std::size_t k = 0; k <= 2 * half; ++k) {
    const double at = double(k) - double(half);
    const double phase = 2.0 * std::numbers::pi * kDecimation.cutoff / double(stride_) * at;
    taps_.push_back((at == 0.0 ? 1.0 : std::sin(phase) / phase) * blackman(at / double(half + 1)));
    sum += taps_.back();
  }
  noise_gain_ = 0.0;
  for (double& tap : taps_) {
    tap /= sum;
    noise_gain_ += tap * tap;
  }
}

std::size_t Decimator::size(std::size_t samples) const {
  if (!chosen_.empty()) return chosen_.size();
  return samples < taps_.size() ? 0 : 1 + (samples - taps_.size()) / stride_;
}

void Decimator::apply(std::span<const double> in, std::span<double> out) const {
  core::require(out.size() == size(in.size()), "a decimator's output has its own size");
  for (std::size_t j = 0; j < out.size(); ++j) {
    const double* at = in.data() + first(j);
    double sum = 0.0;
    for (std::size_t k = 0; k < taps_.size(); ++k) sum += taps_[k] * at[k];
    out[j] = sum;
  }
}

Decimator Decimator::of_every(std::size_t by) const {
  core::require(by > 0 && stride_ % by == 0, "a filter's stride is a multiple of the step");
  Decimator out = *this;
  out.stride_ = stride_ / by;
  out.taps_.clear();
  double sum = 0.0;
  for (std::size_t k = half() % by; k < taps_.size(); k += by)
    out.taps_.push_back(taps_[k]), sum += taps_[k];
  out.noise_gain_ = 0.0;
  for (double& tap : out.taps_) tap /= sum, out.noise_gain_ += tap * tap;
  return out;
}

void Decimator::apply_sizes(std::span<const std::size_t> samples, std::span<const double> values,
                            std::span<double> out) const {
  std::ranges::fill(out, 0.0);
  std::size_t begin = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t k = samples[i], width = taps_.size();
    while (begin < out.size() && first(begin) + width <= k) ++begin;
    for (std::size_t j = begin; j < out.size() && first(j) <= k; ++j)
      out[j] += std::abs(taps_[k - first(j)]) * values[i];
  }
}

double Decimator::third_difference_gain(std::size_t apart) const {
  const auto covariance = [&](std::size_t lag) {
    const std::size_t samples = lag * apart * stride_;
    double sum = 0.0;
    for (std::size_t k = samples; k < taps_.size(); ++k) sum += taps_[k] * taps_[k - samples];
    return sum;
  };
  // Of (1, −3, 3, −1): 20 at lag 0, −15, 6 and −1 at 1 to 3.
  return covariance(0) + (-15.0 * covariance(1) + 6.0 * covariance(2) - covariance(3)) / 10.0;
}

}  // namespace lab
}  // namespace tractus
