/// Every trial with who did it, where it stands in a study and its scores: what a cohort's table is
/// made of.
#pragma once

#include <map>

#include "db/store/studies.hpp"
#include "db/store/trials.hpp"

namespace store {

struct CohortTrial {
  TrialSummary summary;
  bool complete = false;
  std::string rig;  ///< "palpation", "probing"
  // Of a trial of a study; without one `study` is empty:
  std::string study, participant, level;
  std::string person;       ///< the account's name, where it was an assignment; never for research
  std::int64_t number = 0;  ///< of its place in the participant's order, from 1
  std::optional<double> experience_years = {};
  std::string place = {};                 ///< "counts", "invalid", "surplus"
  std::map<std::string, double> metrics;  ///< by id; those without a value are absent
};

/// Oldest first. @param study_id  of this study alone; empty: all trials.
/// Errors: too_large for more than `limit` trials.
core::Result<std::vector<CohortTrial>> cohort_trials(Reading& tx, const std::string& study_id,
                                                     std::int64_t limit);

}  // namespace store
