/// The part of a volume's field that an FMU of a palpation model carries.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "core/result.hpp"
#include "fmu/palpation.hpp"
#include "models/model.hpp"

namespace tractus::commands {

struct FieldOptions {
  std::filesystem::path measurements;  ///< recordings that reach the part; empty for none
  std::vector<math::Vec3> box_m;       ///< two corners in V that hold the part; empty for none
  double margin_m = 0.005;             ///< about what the recordings reach
};

/// Makes the field of the model's volume, else of that which the measurements name, and takes of it the
/// voxels about the box, or about all contact points of the recordings replayed. The recordings are then replayed on the
/// part alone.
/// Errors: of reading and of the field; bad_input where neither box nor recordings are given, or they are
/// outside the volume; too_large over fmu::kMostCarriedVoxels; out_of_range where a
/// recording leaves the part.
core::Result<fmu::CarriedField> carried_field(const models::PalpationModel& model,
                                              const std::filesystem::path& model_path,
                                              const FieldOptions& options);

}  // namespace tractus::commands
