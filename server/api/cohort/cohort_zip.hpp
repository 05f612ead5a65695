/// A whole cohort in one file, which R and Python can read without additional packages (ADR-0021).
#pragma once

#include "server/api/cohort/export.hpp"
#include "server/api/stored_zip.hpp"

namespace tractus::api {

/// What an export is of.
struct CohortWish {
  std::string study;  ///< id of a study or assignment; empty: all trials
  store::Tier tier = store::Tier::metrics;
  bool operator==(const CohortWish&) const = default;
};

/// A zip of summary.csv, trials.csv, scores.csv, dictionary.csv, cohort.json and, for the tiers
/// `reduced` and `full`, samples/TRIAL.npy: of each trial as much as its consent tier allows, and at
/// most the wished tier. It is made while it is sent, so that neither memory nor disk bounds it.
class CohortArchive : public std::enable_shared_from_this<CohortArchive> {
 public:
  using CalledOff = std::function<bool()>;

  /// The archive of the trials that are released now; the held one if it is the same. For the tier
  /// `reduced` every trial is read once, to count the rows of its array.
  /// Errors: those of released_trials and of reading; unavailable once called off.
  static core::Result<std::shared_ptr<CohortArchive>> make(Backend& backend, CohortWish wish,
                                                           const CalledOff& called_off);

  const CohortWish& wish() const { return wish_; }
  /// Differs whenever a byte of the zip differs.
  const std::string& entity_tag() const { return entity_tag_; }
  std::uint64_t size() const { return zip_->size(); }
  /// Errors: forbidden if a trial was deleted, is another person's, or is no longer released for
  /// what the archive has of it.
  core::Result<void> check_released(Backend& backend) const;
  /// `size` bytes from `first` on. If they reach the zip's directory, trials before `first` whose
  /// checksums are not known are read at once. Errors: those of reading; unavailable once called
  /// off.
  core::Result<StoredZipSource> part(const Backend& backend, std::uint64_t first,
                                     std::uint64_t size, const CalledOff& called_off);

 private:
  struct Table {
    std::string name, content;
  };
  /// The samples of a trial.
  struct Array {
    std::string name;
    std::string sha256;  ///< of the trial's file
    double rate_Hz;      ///< 0: every sample
    trial::Rig rig;
    std::uint64_t rows;  ///< at a rate: 0 until they are counted
  };
  /// A trial that is counted, listed or has an array here.
  struct Needed {
    std::string trial, participant;  ///< pseudonyms
    store::Tier tier;                ///< at which it is here
  };
  CohortArchive(CohortWish wish, const store::ReleasedTrials& counted);
  core::Result<void> add_array(const store::ReleasedTrial& trial);
  core::Result<void> lay_out(Backend& backend, const CalledOff& called_off);
  OpenEntry opener(const Backend& backend);

  CohortWish wish_;
  std::vector<Table> tables_;  ///< the first entries
  std::vector<Array> arrays_;  ///< the entries after them
  std::vector<Needed> needed_;
  std::string entity_tag_;
  std::shared_ptr<StoredZip> zip_;
};

/// The answer to a request for a cohort. With If-Range it is the part that Range names of the
/// archive of that entity tag, as long as it is held and still released; without, it is the whole:
/// nobody joins parts of two cohorts. Once check_released gives an error or `still_allowed` is false
/// the body ends with an error; both are asked every second, or less often where they take more than
/// a tenth of one. Errors: those of CohortArchive.
core::Result<http::Response> cohort_response(Backend& backend, const CohortWish& wish,
                                             const http::Request& request,
                                             std::function<bool()> still_allowed);

}  // namespace tractus::api
