/// Trials as research may have them. This is the one way from trials to research: exports, the
/// cohort's table, analyses, their frozen data and downloads take a ReleasedTrials, and only
/// reading it through the filter makes one. The filter: who did the trial agreed to as much
/// (consent.hpp), everybody is named by pseudonym, and a participant of a study is through
/// (blinding.hpp).
#pragma once

#include "db/store/people/consent.hpp"
#include "db/store/people/pseudonyms.hpp"

namespace tractus::store {

/// No name, address, account or time of day is in it.
class ReleasedTrial {
 public:
  std::string id;           ///< pseudonym of the trial
  std::string participant;  ///< pseudonym of the person, or of the machine
  std::string study;        ///< or assignment; empty: of none
  std::string level, case_title, rig;
  std::int64_t number = 0;  ///< of its place in the participant's order, from 1
  std::optional<double> experience_years;
  double days = 0.0;  ///< since the participant's first trial here
  double duration_s = 0.0;
  std::uint64_t samples = 0;
  bool simulated = false, complete = false;
  std::string place;  ///< "counts", "invalid", "surplus"
  bool assessed = false;
  std::optional<bool> correct;
  std::map<std::string, double> metrics;  ///< by id; those without a value are absent
  Tier tier = Tier::none;                 ///< the most that may be had of it

  /// SHA-256 of the object that is its file. Errors: forbidden when the tier of the samples that
  /// are asked for is above what was agreed to.
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
    std::string study = {};  ///< or an assignment; empty: all trials
    Tier least = Tier::metrics;
    std::int64_t most = 1'000'000;  ///< trials on the server; more are too many
  };
  /// Oldest first. Errors: not_found for a study that there is not; too_large; unavailable without
  /// a key.
  static core::Result<ReleasedTrials> read(Reading& tx, const std::optional<PseudonymKey>& key,
                                           const Wish& wish);
  const std::vector<ReleasedTrial>& all() const { return trials_; }
  /// Those of which at least this much may be had.
  ReleasedTrials at_least(Tier tier) const;
  std::size_t without_consent() const { return without_consent_; }  ///< left out
  std::size_t blind() const { return blind_; }                      ///< left out

  /// None.
  ReleasedTrials() = default;

 private:
  void take(std::vector<CohortTrial> trials, const ConsentBook& book, const Pseudonyms& names,
            Tier least);
  void count_days();
  std::vector<ReleasedTrial> trials_;
  std::size_t without_consent_ = 0, blind_ = 0;
};

/// Who is who: by pseudonym, what ConsentBook::person_of says. For administrators alone. Errors:
/// unavailable without a key.
core::Result<std::map<std::string, std::string>> who_is_who(Reading& tx,
                                                            const std::optional<PseudonymKey>& key);

/// How many scored trials that count the server holds, released or not. Errors: not_found for a
/// study that there is not.
core::Result<std::int64_t> scored_trials(Reading& tx, const std::string& study);

}  // namespace tractus::store
