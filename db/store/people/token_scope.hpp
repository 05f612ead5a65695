/// Scopes of personal API tokens; server/api/people/token_scopes.cpp states their routes.
#pragma once

#include "core/named.hpp"

namespace tractus::store {

enum class TokenScope {
  trials_read,
  trials_write,
  cohort_read,
  analyses_run,
  lab_read,
  lab_run,
  cases_read,
  cases_write,
  volumes_read,
  volumes_write,
  studies_read,
  studies_write,
  teaching_read,
  stations_read,
  operations_read,
};
constexpr auto words(TokenScope) {
  using enum TokenScope;
  return std::to_array<core::Word<TokenScope>>({{trials_read, "trials:read"},
                                                {trials_write, "trials:write"},
                                                {cohort_read, "cohort:read"},
                                                {analyses_run, "analyses:run"},
                                                {lab_read, "lab:read"},
                                                {lab_run, "lab:run"},
                                                {cases_read, "cases:read"},
                                                {cases_write, "cases:write"},
                                                {volumes_read, "volumes:read"},
                                                {volumes_write, "volumes:write"},
                                                {studies_read, "studies:read"},
                                                {studies_write, "studies:write"},
                                                {teaching_read, "teaching:read"},
                                                {stations_read, "stations:read"},
                                                {operations_read, "operations:read"}});
}
using core::name;

}  // namespace tractus::store
