/// The picture by which a person checks a case: three slices that follow the tract, with its walls'
/// names.
#pragma once

#include <filesystem>

#include "cases/carving.hpp"

namespace tractus::commands {

/// Slices through the tract (along it and across it, at the breach or else where its medial wall is
/// thinnest), with the channel yellow, the walls' directions cyan, the midline green, the breach
/// red. `surroundings` is the drilled CT.
core::Result<void> draw_case(const std::filesystem::path& path, volume::Volume surroundings,
                             const cases::Carved& carved);

}  // namespace tractus::commands
