/// Trials for research: tidy tables, one row each thing, and signals as arrays; by pseudonym alone.
///
/// No name, address, account or time of day is in any of it. People and trials are named by a keyed
/// hash (BLAKE2b, the key beside the database): the same in every export, and nobody without the
/// key can say whose. Those of a study keep the pseudonym that the study gave them.
#pragma once

#include "db/store/cohort.hpp"
#include "server/api/backend.hpp"

namespace api {

/// Names in exports.
class Pseudonyms {
 public:
  explicit Pseudonyms(const Secrets& secrets);
  std::string trial(const std::string& id) const;   ///< "T" and 16 hexadecimal characters
  std::string person(const std::string& id) const;  ///< "P" and 16 hexadecimal characters

 private:
  std::string hashed(char first, const std::string& text) const;
  Secrets::Key key_;
};

/// The trials of a study (empty: all), oldest first. Errors: not_found, too_large.
core::Result<std::vector<store::CohortTrial>> trials_to_export(Backend& backend,
                                                               const std::string& study);

// As CSV (RFC 4180): UTF-8, one header row, CR LF, NA empty, a point in numbers whatever the
// locale. A text that a spreadsheet would take for a formula begins with an apostrophe.

/// One row per trial: who, which place in which study, what of it counts.
std::string trials_csv(const std::vector<store::CohortTrial>& trials, const Pseudonyms& names);
/// One row per trial and score.
std::string scores_csv(const std::vector<store::CohortTrial>& trials, const Pseudonyms& names);
/// One row per column of the tables above and of the arrays below: table, column, type, unit, what
/// it is.
std::string dictionary_csv();

/// The samples of a trial file as one array of doubles, a row per sample: NumPy's .npy, version 1.0
/// (little-endian float64, row after row), which R reads as well. Columns by dictionary_csv.
/// @param rate_Hz  of the rows; 0: every sample
/// Errors: those of reading the file; too_large (over 512 MiB).
core::Result<std::string> samples_npy(const std::filesystem::path& trial_file, double rate_Hz);

}  // namespace api
