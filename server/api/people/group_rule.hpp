/// The rule from an identity provider's groups to roles and cohorts, as an administrator writes it.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "db/store/people/role.hpp"

namespace tractus::api {

/// One line of the rule: whoever is in the group.
struct GroupLine {
  std::string group;
  store::Role role = store::Role::trainee;
  std::vector<std::string> cohorts = {};  ///< ids; of trainees and faculty alone
  std::string level = {};                 ///< of training; empty: left as it is
};

/// What somebody gets.
struct GroupGrant {
  store::Role role = store::Role::trainee;
  std::set<std::string> cohorts;
  std::string level;
};

/// "tractus-groups/1": {"format", "lines": [{"group", "role", "cohorts"?, "level"?}],
/// "absent_days"?}. The first line that fits gives role and level; each line of that role that fits
/// adds its cohorts. Whom no line fits gets nothing. No line gives the role admin.
struct GroupRule {
  std::vector<GroupLine> lines;
  /// A person whom the provider has not vouched for in so many days counts as having left; none:
  /// only who signs in without a fitting group does.
  std::optional<long> absent_days = {};

  /// Errors: bad_input naming `where` and the field.
  static core::Result<GroupRule> from_json(const core::Json& json, const std::string& where);
  core::Json to_json() const;
  /// Nothing: no line fits.
  std::optional<GroupGrant> grant(const std::vector<std::string>& groups) const;
  /// Every cohort that a line names.
  std::set<std::string> cohorts() const;
};

}  // namespace tractus::api
