/// Released trials: trials as research may use them. This is the only way from trials to research:
/// exports, the cohort table, analyses, their frozen data and downloads take a ReleasedTrials,
/// which only the filter can make. The filter requires that the person consented to the tier
/// (consent.hpp), replaces names by pseudonyms, and leaves out blinded trials (blinding.hpp).
#pragma once

#include "db/store/people/consent.hpp"
#include "db/store/people/pseudonyms.hpp"

namespace tractus::store {

/// A released trial contains no name, address, account or time of day.
class ReleasedTrial {
 public:
  std::string id;           ///< pseudonym of the trial
  std::string participant;  ///< pseudonym of the person, or of the simulated hand
  std::string study;        ///< id of the study or assignment; empty: none
  std::string level, case_title;
  std::string cohort;  ///< name of the cohort of a trainee; empty: none
  std::string date;    ///< day of the trial in UTC, "2026-07-02"
  double year = 0.0;   ///< the same day in years, 2026.4986
  trial::Rig rig;
  std::int64_t number = 0;  ///< of its place in the participant's order, from 1
  std::optional<double> experience_years;
  double days = 0.0;  ///< days since the participant's first trial on this server
  double duration_s = 0.0;
  std::uint64_t samples = 0;
  bool simulated = false, complete = false;
  std::optional<StudyTrialState> place;  ///< of a trial of a study
  bool assessed = false;
  std::optional<bool> correct;
  std::map<std::string, double> metrics;  ///< by id; those without a value are absent
  Tier tier = Tier::none;                 ///< consent tier of the trial

  /// SHA-256 of the object with the trial's file. Errors: forbidden if the wanted tier is above the
  /// consent tier.
  core::Result<std::string> file(Tier samples) const;

 private:
  friend class ReleasedTrials;
  ReleasedTrial(CohortTrial trial, Tier tier, const std::string& person, const Pseudonyms& names);
  std::string sha256_;
  std::int64_t started_utc_us_ = 0;
};

class ReleasedTrials {
 public:
  struct Wish {
    std::string study = {};  ///< id of a study or assignment; empty: all trials
    Tier least = Tier::metrics;
    std::int64_t most = 1'000'000;  ///< largest number of trials on the server
  };
  /// Oldest first. Errors: not_found for an unknown study; too_large; unavailable without a key.
  static core::Result<ReleasedTrials> read(Reading& tx, const std::optional<PseudonymKey>& key,
                                           const Wish& wish);
  const std::vector<ReleasedTrial>& all() const { return trials_; }
  /// The trials whose consent tier is at least `tier`.
  ReleasedTrials at_least(Tier tier) const;
  std::size_t without_consent() const { return without_consent_; }  ///< left out
  std::size_t blind() const { return blind_; }                      ///< left out

  /// No trials.
  ReleasedTrials() = default;

 private:
  void take(std::vector<CohortTrial> trials, const ConsentBook& book, const Pseudonyms& names,
            Tier least);
  void count_days();
  std::vector<ReleasedTrial> trials_;
  std::size_t without_consent_ = 0, blind_ = 0;
};

/// The key of the pseudonyms: maps each pseudonym to the result of ConsentBook::person_of. Only for
/// administrators. Errors: unavailable without a key.
core::Result<std::map<std::string, std::string>> who_is_who(Reading& tx,
                                                            const std::optional<PseudonymKey>& key);

/// Number of scored trials on the server that count, released or not. Errors: not_found for an
/// unknown study.
core::Result<std::int64_t> scored_trials(Reading& tx, const std::string& study);

}  // namespace tractus::store
