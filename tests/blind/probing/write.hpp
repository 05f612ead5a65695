#pragma once
/// The set as files: the model and the measurements for the lab, the truth elsewhere.
#include <filesystem>

#include "probing/generate.hpp"

namespace blind {

/// Writes `folder`/model.json and `folder`/measurements/. False when a file cannot be written.
bool write_set(const GeneratedSet& set, const std::filesystem::path& folder);
bool write_truth(const GeneratedSet& set, const std::filesystem::path& file);

}  // namespace blind
