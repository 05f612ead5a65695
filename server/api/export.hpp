/// Trials for research: tidy tables, one row each thing, and signals as arrays; by pseudonym alone,
/// and of those alone who agreed to as much (db/store/consent.hpp).
///
/// No name, address, account or time of day is in any of it. People and trials are named by a keyed
/// hash (BLAKE2b), the same in every export; the key lies in a file of its own, and nobody without
/// it can say whose they are, not even with the database.
#pragma once

#include "db/store/consent.hpp"
#include "server/api/backend.hpp"

namespace api {

/// Names in exports.
class Pseudonyms {
 public:
  explicit Pseudonyms(const Secrets::Key& key) : key_(key) {}
  /// Errors: unavailable where the server has no key.
  static core::Result<Pseudonyms> of(const Backend& backend);
  std::string trial(const std::string& id) const;  ///< "T" and 16 hexadecimal characters
  /// "P" and 16 hexadecimal characters. @param id  as store::ConsentBook::person_of says
  std::string person(const std::string& id) const;

 private:
  std::string hashed(char first, const std::string& text) const;
  Secrets::Key key_;
};

/// A trial that may be had, with its person by pseudonym (in `trial.participant`).
struct ExportedTrial {
  store::CohortTrial trial;
  store::Tier tier = store::Tier::none;  ///< the most that may be had of it
};
/// The trials of a study (empty: all) of which `least` may be had, oldest first. Errors: not_found,
/// too_large, unavailable (no key of pseudonyms).
core::Result<std::vector<ExportedTrial>> trials_to_export(Backend& backend,
                                                          const std::string& study,
                                                          store::Tier least);

// As CSV (RFC 4180): UTF-8, one header row, CR LF, NA empty, a point in numbers whatever the
// locale. A text that a spreadsheet would take for a formula begins with an apostrophe.

/// One row per person, study and rig: how many trials, answers, right answers.
std::string summary_csv(const std::vector<ExportedTrial>& trials);
/// One row per trial: who, which place in which study, what of it counts.
std::string trials_csv(const std::vector<ExportedTrial>& trials, const Pseudonyms& names);
/// One row per trial and score.
std::string scores_csv(const std::vector<ExportedTrial>& trials, const Pseudonyms& names);
/// One row per column of the tables above and of the arrays below: table, column, type, unit, what
/// it is.
std::string dictionary_csv();

/// Who is who: pseudonym, kind (account, participant, operator), name. For administrators alone.
core::Result<std::string> key_csv(Backend& backend);

/// The rate up to which samples are of the tier `reduced`.
inline constexpr double kReduced_Hz = 100.0;

}  // namespace api
