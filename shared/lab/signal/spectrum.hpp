/// At which frequencies a signal lives.
#pragma once

#include <span>
#include <vector>

namespace tractus::lab {

/// One-sided power densities by bands of a third of an octave.
struct Bands {
  std::vector<double> frequency_Hz;  ///< centres, rising
  std::vector<double> density;       ///< unit² per Hz, mean over the band
};

/// Averages Hann-windowed, half overlapping stretches [Welch1967, eq. 1–8], the mean of each taken
/// off, into one spectrum per series; all series must be sampled alike.
class Welch {
 public:
  /// @param rate_Hz  samples per second, > 0.
  /// @param samples  of the longest series; the stretches are an eighth of it, 64 to 8192.
  Welch(double rate_Hz, std::size_t samples);
  /// Takes a series in; one shorter than a stretch is padded with zeros.
  void add(std::span<const double> series);
  /// Empty until something was added.
  Bands bands() const;

 private:
  void add_stretch(std::span<const double> stretch);
  double rate_Hz_;
  std::size_t length_;
  std::vector<double> window_, power_;
  double window_power_ = 0.0;
  std::size_t stretches_ = 0;
};

}  // namespace tractus::lab
