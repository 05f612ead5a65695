#include "statistics/agreement/icc.hpp"

#include <cmath>
#include <tuple>
#include <utility>

#include "core/try.hpp"
#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

/// Of ICC(2,1), then of ICC(2,k): Satterthwaite's df for the mixed error, McGraw & Wong 1996.
std::pair<Interval, Interval> agreement_intervals(const Icc& o, double n, double k) {
  const double a = k * o.icc2 / (n * (1.0 - o.icc2));
  const double b = 1.0 + k * o.icc2 * (n - 1.0) / (n * (1.0 - o.icc2));
  const double mixed = a * o.ms_columns + b * o.ms_error;
  const double df = mixed * mixed /
                    (std::pow(a * o.ms_columns, 2.0) / (k - 1.0) +
                     std::pow(b * o.ms_error, 2.0) / ((n - 1.0) * (k - 1.0)));
  const double down = f_quantile_upper(0.025, n - 1.0, df);
  const double up = f_quantile_upper(0.025, df, n - 1.0);
  const double error = k * o.ms_columns + (k * n - k - n) * o.ms_error;
  const double of_mean = o.ms_columns - o.ms_error;
  const double low = n * (o.ms_rows - down * o.ms_error), high = n * (up * o.ms_rows - o.ms_error);
  return {{low / (down * error + n * o.ms_rows), high / (error + n * up * o.ms_rows)},
          {low / (down * of_mean + n * o.ms_rows), high / (of_mean + n * up * o.ms_rows)}};
}

/// Of (F − 1)/(F + k − 1) where F has df1, df2.
Interval ratio_interval(double f, double df1, double df2, double k) {
  const double low = f / f_quantile_upper(0.025, df1, df2);
  const double high = f * f_quantile_upper(0.025, df2, df1);
  return {(low - 1.0) / (low + k - 1.0), (high - 1.0) / (high + k - 1.0)};
}

}  // namespace

core::Result<Icc> icc(const Matrix& values) {
  if (values.rows() < 2 || values.cols() < 2 || !values.allFinite())
    return core::Error{core::Errc::bad_input,
                       "reliability needs two subjects, two repetitions, and every value"};
  TRY(check_range(values.reshaped(), "the response"));
  const double n = static_cast<double>(values.rows()), k = static_cast<double>(values.cols());
  const Matrix y = values.array() - values.mean();
  const Vector rows = y.rowwise().mean(), columns = y.colwise().mean();
  Icc o;
  o.ms_rows = k * rows.squaredNorm() / (n - 1.0);
  o.ms_columns = n * columns.squaredNorm() / (k - 1.0);
  const Matrix within = y.colwise() - rows;
  o.ms_within = within.squaredNorm() / (n * (k - 1.0));
  o.ms_error = (within.rowwise() - columns.transpose()).squaredNorm() / ((n - 1.0) * (k - 1.0));
  if (!(o.ms_error > 1e-28 * (o.ms_rows + o.ms_columns)))
    return core::Error{core::Errc::bad_input,
                       "the repetitions agree exactly: no error to estimate"};
  o.icc1 = (o.ms_rows - o.ms_within) / (o.ms_rows + (k - 1.0) * o.ms_within);
  o.icc2 = (o.ms_rows - o.ms_error) /
           (o.ms_rows + (k - 1.0) * o.ms_error + k * (o.ms_columns - o.ms_error) / n);
  o.icc3 = (o.ms_rows - o.ms_error) / (o.ms_rows + (k - 1.0) * o.ms_error);
  o.icc1k = (o.ms_rows - o.ms_within) / o.ms_rows;
  o.icc2k = (o.ms_rows - o.ms_error) / (o.ms_rows + (o.ms_columns - o.ms_error) / n);
  o.icc3k = (o.ms_rows - o.ms_error) / o.ms_rows;
  o.f1 = o.ms_rows / o.ms_within;
  o.f23 = o.ms_rows / o.ms_error;
  const double df1 = n - 1.0, within_df = n * (k - 1.0), error_df = (n - 1.0) * (k - 1.0);
  o.p1 = f_upper(o.f1, df1, within_df);
  o.p23 = f_upper(o.f23, df1, error_df);
  o.icc1_95 = ratio_interval(o.f1, df1, within_df, k);
  o.icc3_95 = ratio_interval(o.f23, df1, error_df, k);
  std::tie(o.icc2_95, o.icc2k_95) = agreement_intervals(o, n, k);
  o.sem_agreement = std::sqrt(o.ms_within);
  o.sem_consistency = std::sqrt(o.ms_error);
  o.mdc95_consistency = normal_quantile(0.975) * std::sqrt(2.0) * o.sem_consistency;
  return o;
}

}  // namespace statistics
}  // namespace tractus
