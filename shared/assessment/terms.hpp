/// Tests of a model's terms, whatever fitted it.
#pragma once

#include <functional>

#include "assessment/report.hpp"
#include "statistics/regression/wald.hpp"

namespace tractus::assessment {

/// What a fit gives for tests: one entry per column of the design.
struct Fitted {
  statistics::Vector coefficients;
  statistics::Matrix covariance;
  statistics::Vector df;  ///< of each coefficient's t; 0: normal
  std::string statistic;  ///< "t" or "z"
  /// Are these coefficients all 0? Nothing: by the covariance, on the smallest of their df.
  std::function<statistics::JointTest(const std::vector<Eigen::Index>& columns)> joint = {};
};

/// Adds "tests": for each term that no other term of the formula contains (marginality), t or z of
/// its one coefficient with a 95 % interval, or a joint F (χ² where df is 0) of several. A model of
/// the intercept alone gets a test of that. With more than one column to a term, adds the table
/// "terms" too.
void add_term_tests(const Formula& formula, const ModelMatrix& model, const Fitted& fit,
                    core::Json& out);

}  // namespace tractus::assessment
