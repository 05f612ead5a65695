#include "volume/cortex.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace tractus {
namespace volume {
namespace {

/// A slab of compact bone between marrow (80 HU) and soft tissue (40 HU), as a scanner sees it: drawn
/// at 10 µm, blurred by a Gaussian that is summed up, read every half a millimetre. Not the error
/// function of the model.
CortexProfile slab(double thickness_m, double outer_m, double sigma_m, double noise_HU,
                   unsigned seed, double density = 1200.0) {
  constexpr double kFine_m = 1e-5;
  const auto drawn = [&](double x) {
    return x > outer_m ? 40.0 : x > outer_m - thickness_m ? density : 80.0;
  };
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0.0, noise_HU);
  CortexProfile out{.from_m = -0.005, .step_m = 0.0005, .values = {}};
  for (int n = 0; n < 16; ++n) {
    double sum = 0.0, weights = 0.0;
    for (double off = -4.0 * sigma_m; off <= 4.0 * sigma_m; off += kFine_m) {
      const double weight = std::exp(-0.5 * off * off / (sigma_m * sigma_m));
      sum += weight * drawn(out.from_m + n * out.step_m + off), weights += weight;
    }
    out.values.push_back(sum / weights + noise(random));
  }
  return out;
}

TEST(FitCortex, MeasuresACortexThinnerThanTheScannersBlur) {
  for (const double thickness_mm : {0.3, 0.5, 0.8, 1.2, 2.0, 3.0})
    for (const double outer_mm : {-0.6, 0.0, 0.4}) {
      const auto fit = fit_cortex(slab(thickness_mm * 1e-3, outer_mm * 1e-3, 6e-4, 0.0, 1),
                                  {.density = 1200.0, .sigma_m = 6e-4});
      ASSERT_TRUE(fit) << thickness_mm << " mm at " << outer_mm;
      EXPECT_NEAR(fit->thickness_m * 1e3, thickness_mm, 0.03);
      EXPECT_NEAR(fit->outer_m * 1e3, outer_mm, 0.03);
      EXPECT_NEAR(fit->inside, 80.0, 10.0);
      EXPECT_NEAR(fit->outside, 40.0, 10.0);
    }
}

/// [Treece2010] reports −0.01 ± 0.58 mm on femurs; a drawn slab with a scan's noise is easier.
TEST(FitCortex, IsUnbiasedUnderAScansNoise) {
  for (const double thickness_mm : {0.4, 0.8, 1.5}) {
    double sum = 0.0, square = 0.0;
    constexpr int kProfiles = 60;
    for (unsigned seed = 1; seed <= kProfiles; ++seed) {
      const auto fit = fit_cortex(slab(thickness_mm * 1e-3, 2e-4, 6e-4, 25.0, seed),
                                  {.density = 1200.0, .sigma_m = 6e-4});
      ASSERT_TRUE(fit);
      const double off = fit->thickness_m * 1e3 - thickness_mm;
      sum += off, square += off * off;
    }
    EXPECT_NEAR(sum / kProfiles, 0.0, 0.05) << thickness_mm;
    EXPECT_LT(std::sqrt(square / kProfiles), 0.2) << thickness_mm;
  }
}

TEST(FitCortex, SaysNothingOfAProfileWithoutACortex) {
  CortexProfile plain{.from_m = -0.005, .step_m = 0.0005, .values = std::vector(16, 60.0)};
  EXPECT_FALSE(fit_cortex(plain, {.density = 1200.0, .sigma_m = 6e-4}));
  plain.values.resize(4);
  EXPECT_FALSE(fit_cortex(plain, {.density = 1200.0, .sigma_m = 6e-4}));
}

TEST(CortexScan, FindsTheBlurAndTheDensityOfWhatWasDrawn) {
  for (const double sigma_mm : {0.45, 0.8}) {
    std::vector<CortexProfile> profiles;
    for (unsigned seed = 1; seed <= 60; ++seed)
      profiles.push_back(
          slab(3e-4 + 6e-5 * seed, -3e-4 + 1e-5 * seed, sigma_mm * 1e-3, 20.0, seed, 1400.0));
    const auto scan = cortex_scan_of(profiles);
    ASSERT_TRUE(scan);
    EXPECT_NEAR(scan->sigma_m * 1e3, sigma_mm, 0.01);
    EXPECT_NEAR(scan->density, 1400.0, 70.0);
  }
  EXPECT_FALSE(cortex_scan_of({}));
}

}  // namespace
}  // namespace volume
}  // namespace tractus
