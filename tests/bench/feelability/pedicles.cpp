#include "bench/feelability/pedicles.hpp"

#include <checkout.hpp>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "volume/io/read_volume.hpp"

namespace tractus {
namespace bench {

cases::CarvingPlan Pedicle::plan(volume::Preparation preparation) const {
  cases::CarvingPlan out;
  out.entry_m = entry_mm * 1e-3;
  out.target_m = target_mm * 1e-3;
  out.preparation = preparation;
  return out;
}

std::vector<Pedicle> pedicles() {
  const std::string l3 = "tptbox_L3/sub-ct_label-22_ct.nii.gz",
                    thorax = "totalseg_thorax_cta/ct_cropped.nii.gz",
                    pelvis = "totalseg_lumbar_pelvis/example_ct.nii.gz";
  return {{"L3 left", l3, {46, 200, -61}, {38.5, 158, -61}},
          {"L3 right", l3, {2.5, 200, -61.5}, {10, 158, -61.5}},
          {"T12 left, thorax CT", thorax, {14.4, -75, 568.7}, {2.9, -113.9, 568.7}},
          {"T12 right, thorax CT", thorax, {-23.2, -73.8, 568}, {-10.6, -113.9, 568}},
          {"T12 left, pelvis CT", pelvis, {20.9, -79.3, 418.3}, {9.9, -121.2, 418.3}},
          {"T12 right, pelvis CT", pelvis, {-15.4, -77, 418.3}, {-4.3, -121.2, 418.3}},
          {"L1 left, pelvis CT", pelvis, {24.2, -88.3, 385.3}, {12.9, -132.4, 385.3}},
          {"L1 right, pelvis CT", pelvis, {-16.3, -83, 385.3}, {-2.8, -132.4, 385.3}},
          {"L2 left, pelvis CT", pelvis, {22.3, -96, 352}, {10.5, -142.2, 352}},
          {"L2 right, pelvis CT", pelvis, {-13.5, -98.9, 351}, {-2.8, -142.2, 351}},
          {"L3 left, pelvis CT", pelvis, {28, -112, 319}, {14.5, -153, 319}},
          {"L3 right, pelvis CT", pelvis, {-20.7, -108.8, 317.5}, {-5.1, -153.3, 317.5}}};
}

const volume::Volume& ct_of(const Pedicle& pedicle) {
  static std::map<std::string, volume::Volume> read;
  const auto known = read.find(pedicle.ct);
  if (known != read.end()) return known->second;
  auto in = volume_io::read_volume(std::filesystem::path(checkout::kSource) / "tests/data/ct" /
                                   pedicle.ct);
  if (!in) {
    std::fprintf(stderr, "%s\n", in.error().what.c_str());
    std::exit(2);
  }
  return read[pedicle.ct] = std::move(in->volume);
}

}  // namespace bench
}  // namespace tractus
