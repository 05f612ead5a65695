/// A case bundle's way into the server.
#pragma once

#include "server/app/data_folder.hpp"

namespace tractus::app {

/// Verifies the bundle (signature, every part), copies its files among the objects, then notes the
/// case and its parts in one transaction. Publishing it again changes nothing. Returns its id.
/// Errors: those of cases::open_case; bad_input when the truth is missing, without which no trial
/// can be judged.
core::Result<std::string> publish(DataFolder& data, const std::filesystem::path& bundle);

}  // namespace tractus::app
