/// Every term of the grammar on every trial, and how well each predicts held-out trials on top of a
/// fitted model.
#pragma once

#include <Eigen/Core>
#include <string>
#include <string_view>
#include <vector>

#include "lab/discover/evidence.hpp"
#include "lab/discover/grammar.hpp"
#include "lab/identify/formula_terms.hpp"
#include "lab/identify/least_squares.hpp"

namespace tractus::lab {

/// A part of a formula over a trial, by the program that fit and live loop run.
/// @param numbers  named in the text, with their values.
std::vector<double> evaluated(std::string_view text, std::span<const FactorNumber> numbers,
                              const FormulaSignals& signals);

/// A term on top of a model.
struct ScreenedTerm {
  std::size_t term = 0;  ///< of FormulaScreen::terms
  Evidence evidence;
  double amplitude = 0.0;
};

class FormulaScreen {
 public:
  /// @param base  the model on top of which terms are tried; with a jacobian of its point.
  FormulaScreen(const Residual& residual, const Solution& base);

  const std::vector<Factor>& factors() const { return factors_; }
  const std::vector<Term>& terms() const { return terms_; }
  std::size_t families() const { return families_; }
  const std::vector<FormulaSignals>& signals() const { return signals_; }

  /// The best choice of numbers of every family on top of `at`, best first, without those that the
  /// parameters of `at` imitate.
  std::vector<ScreenedTerm> ranked(const Residual& residual, const Solution& at,
                                   double correlation) const;

  /// A solution's own score by trial, by the derivatives that it has.
  Evidence evidence_of(const Residual& residual, const Solution& at, double correlation) const;
  /// With more columns, each the change of the residual by trial, [trial](row, column), and what is
  /// believed of their coefficients.
  Evidence evidence_with(const Residual& residual, const Solution& at, double correlation,
                         const std::vector<Eigen::MatrixXd>& columns,
                         const Eigen::MatrixXd& precision) const;
  /// The residuals of a trial that are judged here.
  Eigen::MatrixXd rows_of(const Eigen::Ref<const Eigen::MatrixXd>& all, int trial) const;
  std::vector<Eigen::VectorXd> residuals_of(const Residual& residual, const Solution& at) const;
  /// The change of the judged residuals of a trial where `added` adds to the law's force.
  Eigen::VectorXd response(std::span<const double> added, int trial) const;

 private:
  void evaluate(int trial);

  const FormulaTerms& rig_;
  Structure structure_;
  std::vector<Factor> factors_;
  std::vector<Term> terms_;
  std::size_t families_ = 0;
  std::vector<FormulaSignals> signals_;            // by trial
  std::vector<Eigen::Index> sizes_;                // by trial: residuals
  std::vector<std::vector<Eigen::Index>> judged_;  // by trial: rows
  std::vector<Eigen::MatrixXf> columns_;           // by trial: (row, term)
};

}  // namespace tractus::lab
