/// What a person, or a station, is to the server.
#pragma once

#include "core/named.hpp"

namespace tractus::store {

/// An account has any of them but station.
enum class Role { admin, director, faculty, researcher, technician, trainee, station };
constexpr auto words(Role) {
  using enum Role;
  return std::to_array<core::Word<Role>>({{admin, "admin"},
                                          {director, "director"},
                                          {faculty, "faculty"},
                                          {researcher, "researcher"},
                                          {technician, "technician"},
                                          {trainee, "trainee"},
                                          {station, "station"}});
}
using core::name;
inline constexpr auto kRoles = core::values<Role>();

}  // namespace tractus::store
