/// What a CT's values mean: the peaks of known tissues, and what makes bone hard to find.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "volume/envelope.hpp"
#include "volume/transfer_function.hpp"
#include "volume/volume_file.hpp"

namespace tractus::volume {

/// CT values, HU where the scan is calibrated; absent where none was found.
struct Calibration {
  std::optional<double> air = {}, fat = {}, soft_tissue = {};  ///< peaks of the histogram
  /// Of the bone about a tract: the median of what lies 3 mm and more inside its envelope, and of
  /// the greatest value within 2 mm of the outer face on each ray.
  std::optional<double> cancellous = {}, cortical = {};
  std::optional<double> cortex_m = {};     ///< the median of its thickness (Envelope::depth)
  std::vector<std::string> warnings = {};  ///< one line each; empty when nothing stands against it
};

/// The greatest bin of each tissue's range: air −1100 … −850, fat −160 … −40, soft tissue −10 … 120
/// HU. It warns of metal (over 0.05 ml above 2500 HU), of a contrast agent (a peak of its own
/// between 150 and 700 HU, where bone alone falls steadily), of slices over 2 mm, and of peaks that
/// lie where they do in no calibrated scan.
Calibration calibrate(const Histogram& histogram, const Geometry& geometry);

/// A transfer function for a scan whose values are off: its points moved along the line through the
/// two of air (−1000 HU), fat (−100) and soft tissue (50) that lie farthest apart and that the scan
/// shows. Errors: out_of_range where it shows fewer than two, or where the line is no scan's.
core::Result<TransferFunction> calibrated(const TransferFunction& transfer,
                                          const Calibration& calibration);

/// Adds what the bone about a tract measures; warns of cortex under 500 HU, as a soft kernel or
/// thick slices leave it.
void calibrate_bone(const Volume& ct, const Envelope& envelope, const Tract& tract,
                    Calibration& out);

}  // namespace tractus::volume
