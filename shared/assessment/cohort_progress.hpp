/// A cohort's recognition by running trial number, and who is behind it.
///
/// The unit is the trainee: a bin's curve is the mean of the trainees' shares of correct answers,
/// with its 95 % interval by Student's t over trainees. A trainee is behind where the last ten
/// answers are correct less often than those of the others at the same trial numbers, by Fisher's
/// exact test (two-sided p ≤ 0.05). One of forty trainees who are not behind is called so by chance.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace tractus::assessment {

/// Of one trainee, in order of time: was the answer correct?
using Answers = std::vector<bool>;

/// Trials `from` to `to` of each trainee who did all of them, counted from 1.
struct ProgressBin {
  std::size_t from = 0, to = 0, trainees = 0;
  double share = 0.0;            ///< mean of the trainees' shares
  double low = 0.0, high = 0.0;  ///< of the mean; NaN with a single trainee
};
/// Bins of five trials, as far as any trainee came.
std::vector<ProgressBin> progress_bins(const std::vector<Answers>& trainees);

/// The last ten answers of a trainee beside those of the others at the same trial numbers.
struct Pace {
  std::size_t trials = 0, right = 0;  ///< of the last ten
  std::optional<double> others = {};  ///< share of correct answers of the others; none did as many
  double p = 1.0;
  bool behind = false;
};
Pace pace_of(const std::vector<Answers>& trainees, std::size_t trainee);

}  // namespace tractus::assessment
