/// What research may have of whose trials.
#pragma once

#include <array>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "db/store/cohort/cohort.hpp"

namespace tractus::store {

/// Each holds those before it. Motion alone tells people apart, so samples need a word of their
/// own.
enum class Tier {
  none,
  summary,  ///< counts and shares of a person's trials together
  metrics,  ///< a row per trial and its scores
  reduced,  ///< samples, at most 100 a second
  full,     ///< every sample
};
inline constexpr std::array kTiers{Tier::none, Tier::summary, Tier::metrics, Tier::reduced,
                                   Tier::full};
std::string_view name(Tier tier);
std::optional<Tier> tier_named(std::string_view name);

struct Consent {
  std::string account_id;   ///< empty: of a participant who is nobody's account
  std::string study_id;     ///< empty: everywhere
  std::string participant;  ///< where there is no account
  Tier tier = Tier::none;
  std::string basis;  ///< "own word", or where the form lies
  std::int64_t noted_utc_us = 0;
  std::string noted_by;
};

/// Puts it in the place of what was said before. What an account says of everywhere replaces all
/// that it said of single studies.
core::Result<void> set_consent(Writing& tx, const Consent& consent);
core::Result<std::vector<Consent>> consents_of(Reading& tx, const std::string& account_id);
core::Result<std::vector<Consent>> all_consents(Reading& tx);

/// Whose a trial is and what may be had of it, at one moment.
class ConsentBook {
 public:
  static core::Result<ConsentBook> read(Reading& tx);

  /// "account:ID", "participant:STUDY/NAME", "operator:NAME": one person across studies where an
  /// account says so.
  std::string person_of(const CohortTrial& trial) const;
  /// Of a simulated trial: full, nobody's data are in it. Of a study's participant without account:
  /// what was noted, else metrics, which taking part in the study says; samples need a word of
  /// their own. Of an assignment: what the account said of it, else of everywhere, else none. Of a
  /// trial in no study: none.
  Tier tier_of(const CohortTrial& trial) const;
  Tier tier_of(const std::string& account_id, const std::string& study) const;

 private:
  using Key = std::array<std::string, 3>;  ///< account, study, participant
  std::map<Key, Tier> said_;
  std::set<std::string> assignments_;                                    ///< studies that are one
  std::map<std::pair<std::string, std::string>, std::string> accounts_;  ///< of study, participant
};

/// Keys of pseudonyms, by fingerprint: the newest; empty when there was none yet.
core::Result<std::string> pseudonym_key_known(Reading& tx);
core::Result<void> note_pseudonym_key(Writing& tx, const std::string& fingerprint,
                                      std::int64_t now_utc_us);

}  // namespace tractus::store
