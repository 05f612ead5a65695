/// What the certified problems' doubles themselves say, in 100-digit arithmetic: no program that
/// reads them as doubles can be nearer to the certificate than this, but by luck.
#pragma once

#include <string>
#include <vector>

namespace tractus::bench {

/// Least-squares coefficients by the normal equations. @param rows  [observation][column]
std::vector<double> exact_coefficients(const std::vector<std::vector<double>>& rows,
                                       const std::vector<double>& y);
/// F of a one-way analysis of variance.
double exact_f(const std::vector<std::string>& labels, const std::vector<double>& values);

struct ExactSummary {
  double mean = 0.0, deviation = 0.0, autocorrelation = 0.0;
};
ExactSummary exact_summary(const std::vector<double>& values);

}  // namespace tractus::bench
