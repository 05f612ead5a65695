/// The envelope found in real CTs, held against segmentations that others made
/// (tests/data/SOURCES.md).
#include "volume/envelope.hpp"

#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cmath>
#include <filesystem>

#include "cases/carving.hpp"
#include "volume/io/read_volume.hpp"

namespace tractus {
namespace {

using volume::Vec3;

struct Vertebra {
  const char* name;
  const char* ct;
  const char* mask;
  int label;
  Vec3 entry_mm, target_mm;
  double least_dice;  ///< within 8 mm of the tract, from 10 mm past the entry on
};
void PrintTo(const Vertebra& vertebra, std::ostream* out) { *out << vertebra.name; }

volume::Volume read(const char* name) {
  auto in =
      volume_io::read_volume(std::filesystem::path(checkout::kSource) / "tests/data/ct" / name);
  EXPECT_TRUE(in) << (in ? "" : in.error().what);
  return in->volume;
}

bool in_mask(const volume::Volume& mask, int label, const Vec3& p) {
  const Vec3 at = mask.geometry.index_of(p);
  return mask.geometry.contains(p) &&
         std::lround(mask.value(int(std::lround(at.x())), int(std::lround(at.y())),
                                int(std::lround(at.z())))) == label;
}

class RealVertebrae : public testing::TestWithParam<Vertebra> {};

TEST_P(RealVertebrae, HaveTheEnvelopeOfTheirSegmentation) {
  const auto& vertebra = GetParam();
  const auto ct = read(vertebra.ct), mask = read(vertebra.mask);
  cases::CarvingPlan plan;
  plan.entry_m = vertebra.entry_mm * 1e-3, plan.target_m = vertebra.target_mm * 1e-3;
  const auto placed = cases::place(ct, volume::TransferFunction::bone(), plan);
  ASSERT_TRUE(placed) << placed.error().what;
  const auto& tract = placed->tract;
  const auto envelope = volume::envelope_about(ct, tract);
  ASSERT_TRUE(envelope) << envelope.error().what;
  constexpr double kAbout_m = 0.008, kStep_m = 0.00075;
  constexpr double kPastEntry_m = 0.010;  // before that the segmentation ends at facets of its own
  double both = 0.0, either = 0.0;
  for (double d = kPastEntry_m; d < tract.length_m + kAbout_m; d += kStep_m)
    for (double x = -kAbout_m; x < kAbout_m; x += kStep_m)
      for (double y = -kAbout_m; y < kAbout_m; y += kStep_m) {
        const double over = d - std::clamp(d, 0.0, tract.length_m);
        if (std::hypot(over, std::hypot(x, y)) > kAbout_m) continue;
        const Vec3 p = tract.entry_m + d * tract.axis + x * tract.medial + y * tract.superior;
        const bool found = (*envelope)->share(p) > 0.5;
        const bool segmented = in_mask(mask, vertebra.label, p);
        both += found && segmented;
        either += 0.5 * (found + segmented);
      }
  EXPECT_GT(both / either, vertebra.least_dice);
}

const char* const kL3 = "tptbox_L3/sub-ct_label-22_ct.nii.gz";
const char* const kL3Mask = "tptbox_L3/sub-ct_seg-vert_label-22_msk.nii.gz";
const char* const kThorax = "totalseg_thorax_cta/ct_cropped.nii.gz";
const char* const kThoraxMask = "totalseg_thorax_cta/vertebrae_T12.nii.gz";
const char* const kPelvis = "totalseg_lumbar_pelvis/example_ct.nii.gz";
const char* const kPelvisMask = "totalseg_lumbar_pelvis/totalseg.nii.gz";

// Masks of 1.5 and 3 mm voxels: half a voxel off all round is a Dice of about 0.93 and 0.87.
INSTANTIATE_TEST_SUITE_P(
    BothSides, RealVertebrae,
    testing::Values(
        Vertebra{"L3Left", kL3, kL3Mask, 22, {46, 200, -61}, {38.5, 158, -61}, 0.9},
        Vertebra{"L3Right", kL3, kL3Mask, 22, {2.5, 200, -61.5}, {10, 158, -61.5}, 0.9},
        Vertebra{"T12Left", kThorax, kThoraxMask, 1, {14.4, -75, 568.7}, {2.9, -113.9, 568.7}, 0.9},
        Vertebra{
            "T12Right", kThorax, kThoraxMask, 1, {-23.2, -73.8, 568}, {-10.6, -113.9, 568}, 0.9},
        Vertebra{
            "L1Left", kPelvis, kPelvisMask, 31, {24.2, -88.3, 385.3}, {12.9, -132.4, 385.3}, 0.85},
        Vertebra{
            "L1Right", kPelvis, kPelvisMask, 31, {-16.3, -83, 385.3}, {-2.8, -132.4, 385.3}, 0.85}),
    [](const auto& which) { return which.param.name; });

}  // namespace
}  // namespace tractus
