/// A case bundle's way among what the server hands out.
#pragma once

#include <filesystem>
#include <functional>

#include "db/store/store.hpp"
#include "db/store/volumes/objects.hpp"

namespace tractus::jobs {

/// Verifies the bundle (signature, every part), copies its files among the objects, then notes the
/// case and its parts in one transaction; `also` runs in the same one. Publishing it again changes
/// nothing. Returns its id. Errors: those of cases::open_case; bad_input when the truth is missing,
/// without which no trial can be judged.
core::Result<std::string> publish_bundle(
    store::Store& store, const store::Objects& objects, const std::filesystem::path& bundle,
    const std::function<core::Result<void>(store::Writing&, const std::string& id)>& also = {});

}  // namespace tractus::jobs
