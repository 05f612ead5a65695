/// How thick the cortex is that a CT blurred: a model of the profile across it, fitted to the scan.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace tractus::volume {

/// CT values along a line that leaves the bone, at equal steps.
struct CortexProfile {
  double from_m = 0.0;  ///< of the first value, relative to where the face is thought to be
  double step_m = 0.0;
  std::vector<double> values;  ///< from within the bone outwards
};

/// What is the same for every profile of a scan.
struct CortexScan {
  double density = 0.0;  ///< CT value of compact bone, y₁
  double sigma_m = 0.0;  ///< of the scanner's point spread along a profile, σ
};

struct CortexFit {
  double outer_m = 0.0;                ///< x₀, in the profile's own measure
  double thickness_m = 0.0;            ///< x₀ − x₁
  double inside = 0.0, outside = 0.0;  ///< y₂, y₀
  double rms = 0.0;                    ///< of what the model leaves of the values
};

/// Fits the model of [Treece2010]: three plateaus, blurred by a Gaussian,
///
///     y(x) = y₂ + (y₁ − y₂) Φ((x − x₁)/σ) + (y₀ − y₁) Φ((x − x₀)/σ)
///
/// where the value of compact bone y₁ is held fixed, since thickness and density of a cortex
/// thinner than σ cannot be told apart. y₀ and y₂ are solved for at each x₀ and x₁; these two are
/// looked for from the best of a grid of starts. Absent where a profile has too few values, or where
/// the best cortex is none or thicker than the profile can show.
std::optional<CortexFit> fit_cortex(const CortexProfile& profile, const CortexScan& scan);

/// The density is that of the densest cortex in the scan: the value that one of fifty profiles
/// reaches, at least 1000 HU, under which blur has taken part of all of it (own; [Treece2012] has a
/// fit). σ is the one with which the model leaves least of all profiles, from 0.2 to 1.6 mm.
/// Absent where no profile can be fitted.
std::optional<CortexScan> cortex_scan_of(std::span<const CortexProfile> profiles);

}  // namespace tractus::volume
