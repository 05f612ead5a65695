/// Low-pass filtering and thinning that measured and predicted force both pass, so that neither
/// side has what the other lacks.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace tractus::lab {

/// A zero-phase low-pass (sinc under a Blackman window, unit gain at rest) evaluated at every
/// `stride`-th sample alone. Only whole windows count: nothing is made up at the ends.
class Decimator {
 public:
  /// @param spacing_s  mean time between samples. @param rate_Hz  wanted after thinning; the
  /// cut-off is at 0.35 of it. A recording no faster than 1.5 times that is left as it is.
  Decimator(double spacing_s, double rate_Hz);

  std::size_t stride() const { return stride_; }
  std::size_t half() const { return taps_.size() / 2; }  ///< samples before and after the middle
  /// Outputs for so many samples.
  std::size_t size(std::size_t samples) const;
  /// Only these outputs from now on, in rising order.
  void choose(std::vector<std::size_t> outputs) { chosen_ = std::move(outputs); }
  /// The sample in the middle of an output's window.
  std::size_t middle(std::size_t output) const { return half() + first(output); }
  void apply(std::span<const double> in, std::span<double> out) const;
  /// The same filter with the same outputs for every `by`-th sample, from half() % by on. @param by  divides stride().
  Decimator of_every(std::size_t by) const;

  /// Sum of |tap| · value over the samples that are given (in rising order), all others 0.
  void apply_sizes(std::span<const std::size_t> samples, std::span<const double> values,
                   std::span<double> out) const;

  /// Variance of the output for white noise of variance 1.
  double noise_gain() const { return noise_gain_; }
  /// Variance of the third difference of every `apart`-th output for the same, over 20: what noise_sd would take for
  /// the outputs' own variance.
  double third_difference_gain(std::size_t apart = 1) const;
  double largest_tap() const { return taps_[half()]; }

 private:
  std::size_t first(std::size_t output) const {
    return stride_ * (chosen_.empty() ? output : chosen_[output]);
  }

  std::size_t stride_ = 1;
  std::vector<double> taps_;
  std::vector<std::size_t> chosen_;  // empty: all
  double noise_gain_ = 1.0;
};

}  // namespace tractus::lab
