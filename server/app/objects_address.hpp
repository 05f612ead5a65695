/// Where the objects of a data folder are kept.
#pragma once

#include <filesystem>
#include <string>

#include "db/store/volumes/objects.hpp"

namespace tractus::app {

/// In a folder whose objects are kept in an S3 bucket: the bucket's address, without credentials.
inline constexpr const char* kObjectsFile = "objects.address";

/// The objects of a folder: kept in it, or where its file says. Does not ask whether an object store
/// is there. Errors: bad_input (the address, or no credentials), io.
core::Result<store::Objects> open_objects(const std::filesystem::path& folder);

/// Notes in a new folder where its objects are kept, after an object was put there and removed
/// again. An empty address changes nothing. Errors: bad_input (the address, or no credentials),
/// conflict (the folder's objects are kept elsewhere), unavailable.
core::Result<void> keep_objects_at(const std::filesystem::path& folder, const std::string& address);

}  // namespace tractus::app
