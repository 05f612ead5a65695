/// Pedicles of the real CTs in tests/data, both sides, lumbar and thoracic.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cases/making.hpp"

namespace tractus::bench {

struct Pedicle {
  std::string name;  ///< "L3 left"
  std::string ct;    ///< below tests/data/ct
  math::Vec3 entry_mm, target_mm;

  cases::CarvingPlan plan(volume::Preparation preparation) const;
};

/// Entry and target lie on the axis of the pedicle in the segmentations beside the CTs, except for
/// L3, where they are those of tests/carve.
std::vector<Pedicle> pedicles();
/// A CT of tests/data, read once. Ends the program when it cannot be read.
const volume::Volume& ct_of(const Pedicle& pedicle);

}  // namespace tractus::bench
