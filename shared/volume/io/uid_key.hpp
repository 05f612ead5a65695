/// The secret by which unique identifiers are replaced.
#pragma once

#include <array>
#include <cstddef>

namespace tractus::volume_io {

/// The same key gives the same replacement for the same identifier, and nobody without it can tell
/// which it was.
using UidKey = std::array<std::byte, 32>;

}  // namespace tractus::volume_io
