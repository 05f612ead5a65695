/// Power of the study's tests, and how many people they need.
///
/// Exact by the noncentral t and F (correlation and proportions by their usual normal forms, as R's
/// pwr). Two-sided throughout. Effect sizes after Cohen 1988: d, r, f, f², h.
#pragma once

#include <functional>

#include "core/result.hpp"

namespace tractus::statistics {

/// δ = d √(n/2) on 2n − 2 df; n per group (need not be whole), n > 1.
double power_two_samples(double d, double n, double alpha = 0.05);
/// δ = d √n on n − 1 df.
double power_paired(double d, double n, double alpha = 0.05);
/// Fisher's z with bias term against the critical r of the t test; n > 3.
double power_correlation(double r, double n, double alpha = 0.05);
/// λ = k n f² on k − 1 and k(n − 1); n per group.
double power_one_way(double f, double groups, double n, double alpha = 0.05);
/// λ = f² (u + v + 1) on u and v.
double power_regression(double f2, double u, double v, double alpha = 0.05);
/// h = 2 asin √p₁ − 2 asin √p₂, two groups of n.
double power_two_proportions(double h, double n, double alpha = 0.05);
double power_one_proportion(double h, double n, double alpha = 0.05);

/// Repeated measures, one group, as in G*Power (Faul et al. 2007):
/// λ = f² n m ε/(1 − ρ) on (m − 1)ε and (n − 1)(m − 1)ε.
struct RepeatedDesign {
  double f = 0.25;
  double levels = 3.0;       ///< m
  double correlation = 0.5;  ///< ρ between levels, < 1
  double epsilon = 1.0;      ///< departure from sphericity
};
double power_repeated(const RepeatedDesign& design, double n, double alpha = 0.05);

/// Smallest n (not whole: round up) with power_of(n) ≥ target, between `low` and a million.
/// Errors: out_of_range when a million is not enough.
core::Result<double> needed_size(const std::function<double(double n)>& power_of, double target,
                                 double low);

}  // namespace tractus::statistics
