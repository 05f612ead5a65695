/// Invitations into cohorts: a leader of a cohort invites a person, who accepts or declines.
#pragma once

#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct Invitation {
  std::string cohort_id;
  std::string account_name;  ///< as typed; such an account need not exist
  std::int64_t made_utc_us = 0;
  std::string made_by = {};
  std::string cohort_name = {};  ///< filled on reading
};

/// Largest number of open invitations in one cohort.
inline constexpr std::size_t kMostInvitations = 500;

/// Changes nothing if the invitation exists. Errors: conflict if kMostInvitations are open.
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
