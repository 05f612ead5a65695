/// Volumes are read in a process of their own: what a damaged or hostile file does to a library
/// happens there, within limits, and not to the server.
#pragma once

#include "server/api/backend.hpp"
#include "server/app/command.hpp"

namespace tractus::app {

/// jobs::import_volume by `tractus-server import-volume`, this very program. The child has 16 GiB of
/// address space, 15 minutes of processor time, and the key through a pipe. Errors: its own;
/// bad_input when it ended without a word.
core::Result<core::Json> import_volume_in_subprocess(const std::filesystem::path& upload,
                                                     const std::filesystem::path& folder,
                                                     const std::array<std::byte, 32>& key,
                                                     const std::string& series_uid);

/// The child's side: the key as 64 hexadecimal characters on standard input, the answer as JSON on
/// standard output.
Run import_volume_command(CLI::App& command);

}  // namespace tractus::app
