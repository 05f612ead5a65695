/// Where an FMU's resources are, as importers say it.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/result.hpp"

namespace tractus::fmu {

/// The path of a file URI [RFC 8089]; a path is taken as it is. Errors: bad_input.
core::Result<std::filesystem::path> path_of(std::string_view uri);

}  // namespace tractus::fmu
