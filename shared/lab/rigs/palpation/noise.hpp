/// How much more noise a palpation has than its quickest changes tell.
#pragma once

#include <vector>

namespace tractus::lab {

/// Squares of one sample, N²: of what a model leaves of the force, and of the noise that is stated there.
struct NoiseSample {
  double error, sensor, motion;
  bool judged;
};

/// The value below which a share (0 … 1) of one or more values lie.
double value_at_share(std::vector<double> values, double share);

/// Root mean square that noise leaves of the judged samples, N; 0 if there are none. Sensor and motion say too little of noise
/// whose neighbours are alike: how much more there is of either is estimated from what the model leaves, by medians, so that
/// what happens now and then does not count: of the sensor's where the motion's errors do nothing, of the motion's where they
/// do most.
double judged_noise(const std::vector<NoiseSample>& samples);

}  // namespace tractus::lab
