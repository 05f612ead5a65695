/// Nonlinear least squares over a problem's residuals: Levenberg–Marquardt on finite differences,
/// robust, within bounds, with what is believed beforehand.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lab/identify/problem.hpp"

namespace tractus::lab {

/// Residuals of all trials one under another, evaluated by a few threads.
class Residual {
 public:
  Residual(const Problem& problem, int threads);
  Eigen::Index size() const { return offsets_.back(); }
  Eigen::Index offset(int trial) const { return offsets_[std::size_t(trial)]; }
  int trials() const { return int(offsets_.size()) - 1; }
  Eigen::VectorXd operator()(const Structure& structure, std::span<const double> values) const;
  /// Several points at once, as columns.
  Eigen::MatrixXd operator()(const Structure& structure,
                             const std::vector<std::vector<double>>& points) const;
  /// The same near `values`, for differences (see ResidualModel::residuals_near).
  Eigen::MatrixXd near(const Structure& structure, std::span<const double> values,
                       const std::vector<std::vector<double>>& points) const;
  const Problem& problem() const { return problem_; }
  int threads() const { return threads_; }

 private:
  const Problem& problem_;
  int threads_;
  std::vector<Eigen::Index> offsets_;
};

/// A point of a search: values with all that was computed there.
struct Solution {
  Structure structure;
  std::vector<Parameter> parameters;
  std::vector<double> values;
  Eigen::VectorXd residual;  ///< whitened
  Eigen::MatrixXd jacobian;  ///< [residual][parameter], by the searched coordinate; may be of a
                             ///< point near by
  double loss = 0.0;         ///< sum of Huber's ρ over the residuals, plus `prior`
  double prior = 0.0;        ///< sum of ((u − u0)/sd)² over parameters believed beforehand
  double scale = 1.0;        ///< robust scale of the residuals, at least 1
  bool converged = false;

  double judged = 0.0;  ///< residuals that are not exactly 0: of those the structure says
                        ///< nothing (dry friction at rest)

  mutable Eigen::VectorXd held_out_squares;    ///< see held_out_squares(); empty until asked for
  mutable std::optional<bool> told_from_zero;  ///< see told_from_zero(); empty until asked for

  /// Mean of ρ over what is judged: about 1 when all is explained.
  double mean_square() const { return (loss - prior) / std::max(1.0, judged); }
};

struct SearchOptions {
  int max_iterations = 25;
  double tolerance = 1e-4;      ///< ends when an iteration lowers the loss by less than this share
  bool fresh_jacobian = false;  ///< differentiate all columns anew at every point
};

/// Value in the coordinate that is searched: its logarithm where the parameter says so.
double coordinate(const Parameter& parameter, double value);
double value_at(const Parameter& parameter, double coordinate);

/// From `start` (one value per parameter; its jacobian's columns are taken over for parameters of
/// the same pointers in `warm`, if given) to a minimum near by.
Solution search(const Residual& residual, const Structure& structure, std::vector<double> start,
                const Solution* warm = nullptr, const SearchOptions& options = {});

/// Moves the rough parameters one by one, by ever smaller steps, as long as that lowers the loss;
/// then searches on. The solution keeps a jacobian of near by.
Solution polish(const Residual& residual, Solution at, const SearchOptions& options = {});

/// Recomputes all columns of the jacobian at the solution.
void differentiate(const Residual& residual, Solution& solution);

/// w(r) = min(1, c·scale/|r|), c = LeastSquaresSettings::huber [Huber1964], by which the normal
/// equations are weighted anew at each point [Holland1977].
Eigen::VectorXd robust_weights(const Eigen::VectorXd& residual, double scale);
/// From a high quantile of |r|, at least 1.
double robust_scale(const Eigen::VectorXd& residual);
/// Sum over a stretch of ρ(r) = r² up to c·scale, c·scale (2|r| − c·scale) beyond [Huber1964].
double robust_loss(const Eigen::Ref<const Eigen::VectorXd>& residual, double scale);

/// Normal equations of a stretch of the residual with its weights.
struct Gram {
  Eigen::MatrixXd a;
  Eigen::VectorXd b;
};
Gram gram(const Solution& solution, const Eigen::VectorXd& weights, Eigen::Index from,
          Eigen::Index count);
/// Adds what is believed beforehand.
void add_prior(const Solution& solution, Gram& gram);
/// (A)⁻¹ b through scaled eigenvectors: directions that the equations do not know stay zero.
Eigen::VectorXd solve(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

}  // namespace tractus::lab
