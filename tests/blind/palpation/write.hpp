#pragma once
/// The set as files: volume, model and measurements for the lab, the truth elsewhere.
#include "palpation/generate.hpp"

namespace blind {

/// Writes `folder`/volume.nrrd, model.json and measurements/. False when a file cannot be written.
bool write_set(const PalpationSet& set, const std::filesystem::path& folder);
bool write_truth(const PalpationSet& set, const std::filesystem::path& file);

}  // namespace blind
