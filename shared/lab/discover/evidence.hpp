/// How well a model that is linear in its parameters predicts each trial from the others.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "lab/settings.hpp"

namespace tractus::lab {

inline constexpr const auto& kDiscovery = kSettings.discovery;

/// Of one trial's whitened residual r and its derivatives Z by the parameters.
struct TrialGram {
  Eigen::MatrixXd a;  ///< ZᵀZ
  Eigen::VectorXd b;  ///< Zᵀr
  double rr = 0.0;    ///< rᵀr
  double rows = 0.0;
};

/// What is believed of the parameters beforehand: a normal with this precision about `mean`,
/// counted from where the residual was taken.
struct LinearPrior {
  Eigen::MatrixXd precision;
  Eigen::VectorXd mean;
};

struct Evidence {
  Eigen::VectorXd log_score;  ///< by trial, nats
  double total = 0.0;
  double mean_square = 0.0;  ///< of the residual on held-out trials
  Eigen::VectorXd change;    ///< of the parameters, by all trials
};

/// Log predictive density of each trial given the others, for a residual r + Z δ with normal errors:
/// their variance is what the other trials leave, and `correlation` neighbouring residuals count as
/// one observation. O(p³) a trial.
Evidence leave_one_out(const std::vector<TrialGram>& trials, const LinearPrior& prior,
                       double correlation);

/// Residuals that one independent observation is worth, 1 + 2 Σ ρ_k up to the first ρ_k < 0, over
/// stretches of neighbours [Sokal1997]; at least 1.
double correlation_of(const std::vector<Eigen::VectorXd>& residuals);

/// Probabilities of hypotheses from their scores by trial: the mean over Dirichlet weights of the
/// trials of exp(score)/Σ exp(score), "pseudo-BMA+" [Yao2018].
/// @param prior  logarithm of each one's prior odds.
std::vector<double> stacked_probabilities(const std::vector<Eigen::VectorXd>& scores,
                                          const std::vector<double>& prior);
/// In which share of those draws each one's score is the highest.
std::vector<double> share_of_best(const std::vector<Eigen::VectorXd>& scores,
                                  const std::vector<double>& prior);

}  // namespace tractus::lab
