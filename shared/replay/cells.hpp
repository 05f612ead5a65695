/// Numbers in tables: empty where there is none.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "core/json.hpp"

namespace tractus::replay {

inline std::string cell(double value) {
  return std::isfinite(value) ? fmt::format("{}", value) : "";
}
inline core::Json number(double value) {
  return std::isfinite(value) ? core::Json(value) : core::Json();
}

}  // namespace tractus::replay
