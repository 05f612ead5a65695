/// How a person, and who may try again later, tell that an object store is away.
#pragma once

#include <string>

#include "core/result.hpp"

namespace tractus::store {

/// An error of an object store, in whose words it begins.
inline core::Error store_away(const std::string& what) {
  return {core::Errc::unavailable, "object store: " + what};
}

inline bool is_store_away(const core::Error& error) {
  return error.code == core::Errc::unavailable && error.what.starts_with("object store: ");
}

}  // namespace tractus::store
