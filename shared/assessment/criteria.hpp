/// What passing is, and whether somebody has passed: the only definition, used by every page and
/// export.
///
///     metric       at least `times` of the last `last` values of a metric keep a bound
///     recognition  the low end of the Wilson interval of the share right, of the last `last`
///                  answers (0: of all), is at least `share`
///     lc_cusum     competence can be said with these failure rates (trainee.hpp)
///
/// Somebody passes at the first trial after which all requirements are met at once, and has passed
/// from then on; `now` says what holds after the last trial. Looking after every trial makes a pass
/// by luck likelier than a single look: only lc_cusum accounts for that.
#pragma once

#include <map>
#include <span>

#include "assessment/trainee.hpp"
#include "core/named.hpp"
#include "statistics/summary/cutoff.hpp"

namespace tractus::assessment {

enum class RequirementKind { metric, recognition, lc_cusum };
constexpr auto words(RequirementKind) {
  using enum RequirementKind;
  return std::to_array<core::Word<RequirementKind>>(
      {{metric, "metric"}, {recognition, "recognition"}, {lc_cusum, "lc_cusum"}});
}
enum class Side { at_most, at_least };
constexpr auto words(Side) {
  return std::to_array<core::Word<Side>>(
      {{Side::at_most, "at_most"}, {Side::at_least, "at_least"}});
}

struct Requirement {
  RequirementKind kind = RequirementKind::lc_cusum;
  std::string metric = {};  ///< id; for kind metric
  Side side = Side::at_most;
  double bound = 0.0;     ///< in the metric's unit
  std::size_t times = 1;  ///< values that keep the bound
  std::size_t last = 0;   ///< of the last so many; 0: of all
  double share = 0.8;     ///< right answers, for recognition
  double level = 0.95;    ///< of the interval, for recognition
  statistics::Rates rates = {};
  std::string basis = {};  ///< where the bound comes from, in words
};

struct Criteria {
  std::vector<Requirement> requirements;

  /// {"format": "tractus-criteria/1", "requirements": […]}, one to twelve. Errors: bad_input with
  /// the field.
  static core::Result<Criteria> from_json(const core::Json& json, const std::string& where);
  core::Json to_json() const;
  /// LC-CUSUM with the usual rates, which holds where a programme has not said otherwise.
  static Criteria usual();
};

/// What a judgement needs of a trial.
struct JudgedTrial {
  std::string id;
  std::optional<bool> right = {};  ///< none: no answer, or no truth
  std::map<std::string, double> metrics = {};
};

struct RequirementVerdict {
  bool met = false;
  std::string required,
      found;  ///< "Operation time at most 45 s in 3 of the last 5 trials", "2 of 5"
};

struct Verdict {
  std::size_t passed_at = 0;             ///< trial, from 1; 0: not passed
  std::size_t trials = 0;                ///< in all
  std::vector<RequirementVerdict> then;  ///< at that trial; empty if not passed
  std::vector<RequirementVerdict> now;   ///< after the last trial
  bool passed() const { return passed_at > 0; }
  bool holds_now() const;
};

/// @param trials  in the order of time.
Verdict judge(const Criteria& criteria, std::span<const JudgedTrial> trials);

/// The verdict with its sentences: {"passed", "passed_at", "holds_now", "trials", "requirements"}.
core::Json verdict_json(const Verdict& of);

/// "Operation time at most 45 s in 3 of the last 5 trials".
std::string text_of(const Requirement& requirement);

/// Which of the versions holds for somebody: the newest that was there when they began, so that
/// nothing changes under their feet; the first, if they began before there was any; the newest, if
/// they have not begun.
/// @param made_utc_us  of each version, ascending, not empty.
std::size_t version_for(std::span<const std::int64_t> made_utc_us,
                        std::optional<std::int64_t> began_utc_us);

}  // namespace tractus::assessment
