/// Every trial with who did it, where it stands in a study and its scores. Research gets these rows
/// through released.hpp alone; those who teach, of the people whom they may see.
#pragma once

#include <array>
#include <map>

#include "db/store/studies/studies.hpp"
#include "db/store/trials/trials.hpp"

namespace tractus::store {

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
  std::string sha256;                     ///< of the object that is its file
  bool blind = false;                     ///< nobody may see it yet (blinding.hpp)
};

/// The rows with nothing left out, for those who filter them.
class CohortRows {
  friend class ReleasedTrials;
  friend core::Result<std::map<std::string, std::string>> who_is_who(
      Reading& tx, const std::optional<std::array<std::byte, 32>>& key);
  friend core::Result<std::vector<CohortTrial>> trials_for_teaching(Reading& tx,
                                                                    const std::string& study_id,
                                                                    const TrialFilter& whose,
                                                                    std::int64_t limit);
  /// Oldest first. @param study_id  of this study or assignment alone; empty: all trials.
  /// Errors: too_large for more than `limit` trials.
  static core::Result<std::vector<CohortTrial>> read(Reading& tx, const std::string& study_id,
                                                     std::int64_t limit);
};

/// For those who teach, with names and without asking for consent, oldest first: the trials that
/// `whose` says, but for those that are blind. Errors: too_large for more than `limit` trials.
core::Result<std::vector<CohortTrial>> trials_for_teaching(Reading& tx, const std::string& study_id,
                                                           const TrialFilter& whose,
                                                           std::int64_t limit);

}  // namespace tractus::store
