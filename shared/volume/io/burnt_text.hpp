/// Is something written into the pixels?
#pragma once

#include <string>
#include <vector>

#include "volume/volume.hpp"

namespace tractus::volume_io {

/// Looks for lines of text in the upper and the lower third of slices, where scanners and viewers
/// burn them in: four or more pieces of like height on one line, close together, each as large as a
/// letter and as thin as its strokes, standing out against what is round them. At most 32 slices,
/// spread evenly, are looked at. Empty when nothing was found; what is found is a suspicion for a
/// person, and what is not found may still be there (slanted or vertical writing, other planes).
std::vector<std::string> text_suspicions(const volume::Volume& volume);

}  // namespace tractus::volume_io
