/// Consent of people to the use of their trials in research.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "db/store/cohort/cohort.hpp"

namespace tractus::store {

/// Consent tiers; each tier includes the tiers before it. Samples need an explicit consent, because
/// people can be recognised by their motion alone.
enum class Tier {
  none,
  summary,  ///< counts and shares of a person's trials together
  metrics,  ///< one row per trial and its scores
  reduced,  ///< samples, at most 100 a second
  full,     ///< every sample
};
constexpr auto words(Tier) {
  using enum Tier;
  return std::to_array<core::Word<Tier>>({{none, "none"},
                                          {summary, "summary"},
                                          {metrics, "metrics"},
                                          {reduced, "reduced"},
                                          {full, "full"}});
}
using core::name;
inline constexpr auto kTiers = core::values<Tier>();

struct Consent {
  std::string account_id;   ///< empty for a participant without an account
  std::string study_id;     ///< empty: all studies
  std::string participant;  ///< pseudonym of a participant without an account
  Tier tier = Tier::none;
  std::string basis;  ///< "own word", or the place where the signed form is kept
  std::int64_t noted_utc_us = 0;
  std::string noted_by;
};

/// Replaces the earlier consent. A consent of an account for all studies also replaces its consents
/// for single studies.
core::Result<void> set_consent(Writing& tx, const Consent& consent);
core::Result<std::vector<Consent>> consents_of(Reading& tx, const std::string& account_id);
core::Result<std::vector<Consent>> all_consents(Reading& tx);

/// The person and the consent tier of each trial, at one moment.
class ConsentBook {
 public:
  static core::Result<ConsentBook> read(Reading& tx);

  /// "account:ID", "participant:STUDY/NAME", "operator:NAME": an account identifies one person
  /// across studies.
  std::string person_of(const CohortTrial& trial) const;
  /// For a simulated trial: full, because it contains no person's data. For a study participant
  /// without an account: the recorded consent, else metrics, which participation in the study
  /// implies; samples need an explicit consent. For an assignment: the account's consent for it,
  /// else for all studies, else none. For a trial without a study: none.
  Tier tier_of(const CohortTrial& trial) const;
  Tier tier_of(const std::string& account_id, const std::string& study) const;

 private:
  using Key = std::array<std::string, 3>;  ///< account, study, participant
  std::map<Key, Tier> said_;
  std::set<std::string> assignments_;                                    ///< studies that are one
  std::map<std::pair<std::string, std::string>, std::string> accounts_;  ///< of study, participant
};

/// Fingerprint of the newest key of pseudonyms; empty if there was none yet.
core::Result<std::string> pseudonym_key_known(Reading& tx);
core::Result<void> note_pseudonym_key(Writing& tx, const std::string& fingerprint,
                                      std::int64_t now_utc_us);

}  // namespace tractus::store
