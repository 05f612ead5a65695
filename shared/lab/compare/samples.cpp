#include "lab/compare/samples.hpp"

#include <algorithm>
#include <cmath>

namespace tractus::lab {

std::size_t Samples::feature(const std::string& name) const {
  return std::size_t(std::ranges::find(features, name, &Feature::name) - features.begin());
}

double Samples::judged_floor() const {
  double squares = 0.0;
  for (const std::size_t c : judged) squares += channels[c].noise_floor * channels[c].noise_floor;
  return std::sqrt(squares);
}

double Samples::squared(const TrialSamples& trial, std::size_t sample) const {
  double out = 0.0;
  for (const std::size_t c : judged) {
    const double r = trial.residual(c, sample);
    out += r * r;
  }
  return out;
}

}  // namespace tractus::lab
