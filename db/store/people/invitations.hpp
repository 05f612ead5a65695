/// Invitations into cohorts: whom those who lead one would like to have in it. The person decides.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct Invitation {
  std::string cohort_id;
  std::string account_name;  ///< as it was typed: there need not be an account of this name
  std::int64_t made_utc_us = 0;
  std::string made_by = {};
  std::string cohort_name = {};  ///< filled on reading
};

/// At most so many wait in one cohort.
inline constexpr std::size_t kMostInvitations = 500;

/// Changes nothing where there is one already. Errors: conflict when kMostInvitations wait.
core::Result<void> invite(Writing& tx, const Invitation& invitation);
/// By name.
core::Result<std::vector<Invitation>> invitations_into(Reading& tx, const std::string& cohort_id);
/// Oldest first.
core::Result<std::vector<Invitation>> invitations_for(Reading& tx, const std::string& account_name);
core::Result<void> remove_invitation(Writing& tx, const std::string& cohort_id,
                                     const std::string& account_name);
core::Result<bool> is_invited(Reading& tx, const std::string& account_id,
                              const std::string& cohort_id);

}  // namespace tractus::store
