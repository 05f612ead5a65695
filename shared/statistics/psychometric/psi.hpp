/// A threshold of perception from two-interval forced choices, by the ψ method [Kontsevich1999]:
/// each level is the one from whose answer most is expected to be learnt.
///
///     P(x | α, β) = λ/2 + (1 − λ) Φ(z (x/α)^β),   z = Φ⁻¹(0.75)
///
/// the share of right answers at a difference x between two intervals: half where there is none,
/// three quarters at the threshold α (the just noticeable difference), β how steeply it rises (1
/// for an ideal observer with noise of one size), λ = 0.02 answers given at random. Prior: uniform
/// over a grid, logarithmic in α and β. After each answer by Bayes' rule; the next level is that of
/// the least expected entropy of the posterior [Kontsevich1999, steps 1 to 6].
#pragma once

#include <cstddef>
#include <vector>

#include "statistics/distributions/proportions.hpp"

namespace tractus::statistics {

/// Share of right answers, 0.5 … 1.
double share_right(double level, double threshold, double slope);

struct Threshold {
  double median = 0.0;   ///< of the posterior
  Interval interval_95;  ///< credible, 2.5 % to either side
  double slope = 0.0;    ///< β, median
};

class Psi {
 public:
  static constexpr double kLapse = 0.02;

  /// Levels and thresholds from `least` to `greatest`, both above 0, least < greatest.
  Psi(double least, double greatest);
  /// Where to ask next.
  double level() const;
  void answered(double level, bool right);
  Threshold threshold() const;
  int answers() const noexcept { return answers_; }

 private:
  std::vector<double> levels_, thresholds_, slopes_;
  std::vector<double> right_;        ///< [level][threshold][slope]: P
  std::vector<double> information_;  ///< likewise: P ln P + (1 − P) ln(1 − P)
  std::vector<double> posterior_;    ///< [threshold][slope]
  int answers_ = 0;
};

}  // namespace tractus::statistics
