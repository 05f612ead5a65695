/// Ratings of trials by people: versions of rubrics, the trials that are to be rated, and what the
/// raters said. Rubrics and ratings are only ever added.
///
/// Nobody sees another's rating of a trial before as many have rated it as were asked for: the
/// request is then complete. If the request is blind, the trainee's name is hidden until then.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "db/store/store.hpp"

namespace tractus::store {

struct RubricVersion {
  std::string id;
  std::int64_t version = 0;
  std::string title;
  std::string definition;  ///< JSON, tractus-rubric/1
  std::string reason;
  std::int64_t made_utc_us = 0;
  std::string made_by;
};

/// Adds the next version; `version` is not taken. Returns it.
core::Result<std::int64_t> add_rubric(Writing& tx, const RubricVersion& of);
/// By id, oldest version first. @param id  of one rubric; empty: all.
core::Result<std::vector<RubricVersion>> rubric_versions(Reading& tx, const std::string& id = "");

/// A trial that is to be rated by a version of a rubric.
struct RatingRequest {
  std::string trial_id, rubric_id;
  std::int64_t version = 0;
  bool blind = false;
  std::int64_t raters = 2;
  std::int64_t made_utc_us = 0;
  std::string made_by;
  std::int64_t submitted = 0;  ///< people who have rated; counted on reading
  bool complete() const { return submitted >= raters; }
};

/// Errors: conflict if the trial is to be rated by this rubric already.
core::Result<void> add_rating_request(Writing& tx, const RatingRequest& of);
/// Newest first. @param trial_id  of one trial; empty: all.
core::Result<std::vector<RatingRequest>> rating_requests(Reading& tx, const std::string& trial_id);
/// Errors: not_found; conflict if somebody has rated.
core::Result<void> remove_rating_request(Writing& tx, const std::string& trial_id,
                                         const std::string& rubric_id);

struct Rating {
  std::string trial_id, rubric_id, rater_id = {};
  std::int64_t number = 0;       ///< of the rater's for this trial, from 1: the last one holds
  std::vector<int> scores = {};  ///< in the order of the rubric's items
  std::string comment = {};
  std::string reason = {};   ///< why the rating before was superseded; empty for the first
  bool independent = false;  ///< the rater could not see another's rating of the trial
  std::int64_t made_utc_us = 0;
  std::string rater = {};  ///< name of the account; filled on reading
  int total() const;       ///< sum of the scores
};

/// Adds the rater's next rating; `number` and `independent` are not taken. Errors: not_found (the
/// trial is not to be rated by this rubric); conflict (as many as asked for have rated, and the
/// caller is none of them; or the caller has rated and gives no reason).
core::Result<void> add_rating(Writing& tx, const Rating& rating);
/// By rubric, rater's name and number. @param trial_id  of one trial; empty: all.
core::Result<std::vector<Rating>> ratings_of(Reading& tx, const std::string& trial_id);

/// Mean over the raters of the sums of the ratings that hold, of every complete request: by trial,
/// then by "rating.RUBRIC_vVERSION".
core::Result<std::map<std::string, std::map<std::string, double>>> rating_scores(Reading& tx);
inline constexpr std::string_view kRatingScore = "rating.";

/// Trials whose trainee's name is hidden from those who rate.
core::Result<std::set<std::string>> trials_with_hidden_name(Reading& tx);
/// SQL, true of a row `t` of `trials` whose trainee's name is hidden from those who rate.
std::string name_hidden_sql();

}  // namespace tractus::store
