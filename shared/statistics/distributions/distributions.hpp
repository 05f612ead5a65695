/// Probability distributions: tails and quantiles, each to about 1e-13 relative.
///
/// Tails are computed as tails (never as 1 minus the other side), so a p-value of 1e-200 keeps its
/// digits. Arguments outside a distribution's domain give NaN, never a throw; callers check.
/// Boost.Math underneath; the studentized range, which it lacks, is our own quadrature.
#pragma once

namespace tractus::statistics {

/// P(|T| ≥ |t|) for Student's T with `df` degrees of freedom (df > 0, need not be whole).
double student_t_two_sided(double t, double df);
/// P(T ≥ t).
double student_t_upper(double t, double df);
/// t with P(T ≤ t) = p.
double student_t_quantile(double p, double df);
/// P(F ≥ f), df1 and df2 > 0.
double f_upper(double f, double df1, double df2);
/// f with P(F ≥ f) = q.
double f_quantile_upper(double q, double df1, double df2);
/// P(χ² ≥ x).
double chi_squared_upper(double x, double df);
/// x with P(χ² ≥ x) = q.
double chi_squared_quantile_upper(double q, double df);
/// P(Z ≤ z), P(Z ≥ z), the density and the quantile of the standard normal.
double normal_cdf(double z);
double normal_upper(double z);
double normal_density(double z);
double normal_quantile(double p);
/// x with P(X ≤ x) = p for X ~ Beta(a, b).
double beta_quantile(double p, double a, double b);
/// P(F ≥ f) for the noncentral F with noncentrality λ.
double noncentral_f_upper(double f, double df1, double df2, double lambda);
/// P(T ≤ t) for the noncentral t with noncentrality δ.
double noncentral_t_cdf(double t, double df, double delta);
/// P(T ≥ t) for the noncentral t.
double noncentral_t_upper(double t, double df, double delta);
/// P(X ≥ x) for X ~ Binomial(n, p), x whole.
double binomial_upper(double x, double n, double p);
/// P(Q ≥ q) for the range of `groups` standard normals over an independent s with `df` degrees of
/// freedom (Tukey). Absolute error below 1e-10.
double studentized_range_upper(double q, double groups, double df);

}  // namespace tractus::statistics
