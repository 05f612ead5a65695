#include "lab/signal/spectrum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <numbers>
#include <unsupported/Eigen/FFT>

namespace tractus::lab {

Welch::Welch(double rate_Hz, std::size_t samples)
    : rate_Hz_(rate_Hz), length_(std::clamp<std::size_t>(std::bit_ceil(samples / 8), 64, 8192)) {
  window_.resize(length_);
  for (std::size_t k = 0; k < length_; ++k) {
    window_[k] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * double(k) / double(length_));
    window_power_ += window_[k] * window_[k];
  }
  power_.assign(length_ / 2 + 1, 0.0);
}

void Welch::add(std::span<const double> series) {
  if (series.size() < 2) return;
  if (series.size() < length_) return add_stretch(series);
  for (std::size_t from = 0; from + length_ <= series.size(); from += length_ / 2)
    add_stretch(series.subspan(from, length_));
}

void Welch::add_stretch(std::span<const double> stretch) {
  double mean = 0.0;
  for (const double value : stretch) mean += value;
  mean /= double(stretch.size());
  std::vector<double> windowed(length_, 0.0);
  for (std::size_t k = 0; k < stretch.size(); ++k) windowed[k] = window_[k] * (stretch[k] - mean);
  std::vector<std::complex<double>> transformed;
  Eigen::FFT<double> fft;
  fft.fwd(transformed, windowed);
  for (std::size_t k = 0; k < power_.size(); ++k) {
    const bool alone = k == 0 || k == length_ / 2;  // the others stand for ± f
    power_[k] += (alone ? 1.0 : 2.0) * std::norm(transformed[k]) / (rate_Hz_ * window_power_);
  }
  ++stretches_;
}

Bands Welch::bands() const {
  Bands out;
  if (stretches_ == 0) return out;
  const double step_Hz = rate_Hz_ / double(length_), third = std::exp2(1.0 / 3.0);
  std::size_t k = 1;
  for (double top = step_Hz * std::sqrt(third); k < power_.size(); top *= third) {
    double sum = 0.0, frequencies = 0.0;
    std::size_t lines = 0;
    for (; k < power_.size() && double(k) * step_Hz <= top; ++k, ++lines) {
      sum += power_[k];
      frequencies += double(k) * step_Hz;
    }
    if (lines == 0) continue;
    out.frequency_Hz.push_back(frequencies / double(lines));
    out.density.push_back(sum / double(lines) / double(stretches_));
  }
  return out;
}

}  // namespace tractus::lab
