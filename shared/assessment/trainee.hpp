/// One trainee: the curve, whether competence can be said, strengths, what to do next.
///
///     success at each trial → LC-CUSUM (competence) → from its signal on CUSUM (relapse)
///     a relapse ends where that sum is back at 0: since then nothing speaks for deterioration
///     scenario: Beta(½ + failures, ½ + successes); next is the one whose failure rate may be
///     highest
///               (its 90 % point), the least recently done of equals
///
/// Competence is said only when the trials are enough to say it of anybody (certification.hpp):
/// with the usual rates, 10 % and 25 %, twelve trials are not.
#pragma once

#include "assessment/certification.hpp"
#include "assessment/table.hpp"
#include "core/json.hpp"
#include "plot/figure.hpp"

namespace tractus::assessment {

/// Which column is what.
struct TraineeColumns {
  std::string trainee = "participant", order = "order", scenario = "scenario", right = "correct";
  std::vector<std::string> scores;  ///< numbers whose learning is followed: "operation_time_s"
  std::vector<std::string> all() const;
};

/// One trial of one trainee.
struct Attempt {
  double order = 0.0;
  bool right = false;
  std::size_t scenario = 0;    ///< index into Cohort::scenarios
  std::vector<double> scores;  ///< one per column; NaN where the cell is empty
};

struct Cohort {
  std::vector<std::string> trainees, scenarios, scores;
  std::vector<std::vector<Attempt>> attempts;  ///< per trainee, in order
  /// [score][scenario], over all: a score is followed as a share of it, since scenarios differ and
  /// come in random order. NaN where there is none.
  std::vector<std::vector<double>> means;
};

/// Errors: bad_input naming FILE:LINE of a cell that is no answer, no number, or an order that
/// comes twice for one trainee.
core::Result<Cohort> cohort_of(const Table& table, const TraineeColumns& columns);

/// From the alarm of the CUSUM to its return to 0.
struct Relapse {
  std::size_t at = 0, recovered_at = 0;  ///< trial, from 1; 0: not recovered
};

/// The relapses in sums of a CUSUM that follow trial `before`; `threshold` > 0 raises the alarm.
std::vector<Relapse> relapses_in(const std::vector<double>& sums, double threshold,
                                 std::size_t before);

struct Standing {
  enum class State { learning, competent, relapsed };
  State state = State::learning;
  std::size_t signalled_at = 0;            ///< trial, from 1; 0: not
  std::vector<Relapse> relapses;           ///< in order of time; all but the last are over
  std::vector<double> sums, relapse_sums;  ///< LC-CUSUM per trial; CUSUM from the signal on
};

/// @param threshold  h of the LC-CUSUM; `relapse`, of the CUSUM after it.
Standing standing(const std::vector<Attempt>& attempts, const statistics::Rates& rates,
                  double threshold, double relapse);

/// What a trainee did of one scenario.
struct Tally {
  double trials = 0.0, right = 0.0;
  std::size_t last = 0;  ///< trial, from 1; 0: never done
};
/// How high the failure rate may be: the 90 % point of Beta(½ + failures, ½ + successes).
double may_fail(const Tally& of);
/// The next best scenario: the one whose failure rate may be highest, of equals the least recently
/// done. @param of  not empty.
std::size_t next_of(const std::vector<Tally>& of);

struct TraineeRules {
  statistics::Rates rates;
  std::optional<double> threshold;  ///< of the LC-CUSUM; the certification's own if absent
  double relapse = 1.25;
};

/// Whether competence may be said, and why or why not.
struct Competence {
  bool certified = false;
  std::string why;
};
/// @param threshold  the h that `of` was made with.
Competence competence(const Standing& of, std::size_t trials, double threshold,
                      const Certification& rule);

/// `report` ("tractus-trainee/1"): trainee, trials, right, share, state, certified, why, scenarios,
/// scores, next. `figures`: the sums; each score with its curve.
struct TraineeReport {
  core::Json report;
  std::vector<plot::Figure> figures;
};

TraineeReport trainee_report(const Cohort& cohort, std::size_t trainee,
                             const Certification& certification, const TraineeRules& rules);

/// The page of one trainee, which prints; `simulated` says so on it.
std::string trainee_page(const TraineeReport& of, bool simulated);

const char* name_of(Standing::State state);

}  // namespace tractus::assessment
