/// Every trial with its person, its place in a study and its scores. Research uses these rows only
/// through released.hpp; faculty sees the rows of the people whom they may see.
#pragma once

#include <array>
#include <map>

#include "db/store/studies/study_slots.hpp"
#include "db/store/trials/trials.hpp"
#include "trial/trial.hpp"

namespace tractus::store {

struct CohortTrial {
  TrialSummary summary;
  bool complete = false;
  trial::Rig rig = trial::Rig::palpation;
  // For a trial of a study; for other trials `study` is empty:
  std::string study, participant, level;
  std::string cohort;       ///< name; of the assignment, else the first that the person joined
  std::string person;       ///< name of the account, for an assignment; never for research
  std::int64_t number = 0;  ///< place in the participant's order, counted from 1
  std::optional<double> experience_years = {};
  std::optional<StudyTrialState> place = {};  ///< of a trial of a study
  /// By id, those without a value absent; and the ratings by people (rating_scores).
  std::map<std::string, double> metrics;
  std::string sha256;  ///< SHA-256 of the object with the trial's file
  bool blind = false;  ///< a blinded trial, which nobody may see yet (blinding.hpp)
};

/// The unfiltered rows, only for the functions that filter them.
class CohortRows {
  friend class ReleasedTrials;
  friend core::Result<std::map<std::string, std::string>> who_is_who(
      Reading& tx, const std::optional<std::array<std::byte, 32>>& key);
  friend core::Result<std::vector<CohortTrial>> trials_for_teaching(Reading& tx,
                                                                    const std::string& study_id,
                                                                    const TrialFilter& whose,
                                                                    std::int64_t limit);
  /// Oldest first. @param study_id  only trials of this study or assignment; empty: all trials.
  /// Errors: too_large for more than `limit` trials.
  static core::Result<std::vector<CohortTrial>> read(Reading& tx, const std::string& study_id,
                                                     std::int64_t limit);
};

/// The trials that `whose` selects, without blinded trials, for teaching: with names and
/// independent of research consent, oldest first. Errors: too_large for more than `limit` trials.
core::Result<std::vector<CohortTrial>> trials_for_teaching(Reading& tx, const std::string& study_id,
                                                           const TrialFilter& whose,
                                                           std::int64_t limit);

}  // namespace tractus::store
