/// Reading by libraries that end the process on what they did not expect, kept from ending ours.
#pragma once

#include <filesystem>
#include <functional>

#include "volume/io/read_volume.hpp"

namespace tractus::volume_io {

/// Runs `read` in a child process and hands over what it returns; a child that ends otherwise (an
/// assertion in a codec, out of memory) is an Error bad_input naming `path`. The child prints
/// nothing and dumps no core. Progress is passed on; a caller that says stop ends the child. Debian
/// builds GDCM with its assertions on: a damaged file can abort it.
core::Result<Imported> isolated(
    const std::filesystem::path& path,
    const std::function<core::Result<Imported>(const core::Progress&)>& read,
    const core::Progress& progress);

}  // namespace tractus::volume_io
