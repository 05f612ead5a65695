#include "statistics/agreement/confusion.hpp"

#include <cmath>

#include "statistics/distributions/distributions.hpp"

namespace tractus {
namespace statistics {
namespace {

/// 0/0 is 0 here.
double ratio(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

/// Agreement with weights 1 − (|i − j|/(k − 1))^power.
double weighted_kappa(const Matrix& p, const Vector& rows, const Vector& columns, double power) {
  double observed = 0.0, expected = 0.0;
  const double k = static_cast<double>(p.rows());
  for (Eigen::Index i = 0; i < p.rows(); ++i)
    for (Eigen::Index j = 0; j < p.cols(); ++j) {
      const double w = 1.0 - std::pow(std::abs(static_cast<double>(i - j)) / (k - 1.0), power);
      observed += w * p(i, j);
      expected += w * rows[i] * columns[j];
    }
  return (observed - expected) / (1.0 - expected);
}

void add_kappa(const Matrix& p, const Vector& rows, const Vector& columns, Confusion& out) {
  const double n = out.total, pe = out.expected_agreement;
  const double kappa = out.kappa = (out.accuracy - pe) / (1.0 - pe), rest = 1.0 - kappa;
  double on = 0.0, off = 0.0, null = 0.0;
  for (Eigen::Index i = 0; i < p.rows(); ++i) {
    on += p(i, i) * std::pow(1.0 - (rows[i] + columns[i]) * rest, 2.0);
    null += rows[i] * columns[i] * (rows[i] + columns[i]);
    for (Eigen::Index j = 0; j < p.cols(); ++j)
      if (i != j) off += p(i, j) * std::pow(columns[i] + rows[j], 2.0);
  }
  const double spread = on + rest * rest * off - std::pow(kappa - pe * rest, 2.0);
  out.kappa_se = std::sqrt(std::max(0.0, spread) / n) / (1.0 - pe);
  out.kappa_se_null = std::sqrt(std::max(0.0, pe + pe * pe - null) / n) / (1.0 - pe);
  const double reach = normal_quantile(0.975) * out.kappa_se;
  out.kappa_95 = {kappa - reach, kappa + reach};
  out.kappa_linear = weighted_kappa(p, rows, columns, 1.0);
  out.kappa_quadratic = weighted_kappa(p, rows, columns, 2.0);
}

void add_classes(const Matrix& counts, Confusion& out) {
  const Eigen::Index k = counts.rows();
  const Vector truth = counts.rowwise().sum(), said = counts.colwise().sum();
  out.precision = out.recall = out.specificity = out.f1 = Vector::Zero(k);
  for (Eigen::Index i = 0; i < k; ++i) {
    out.precision[i] = ratio(counts(i, i), said[i]);
    out.recall[i] = ratio(counts(i, i), truth[i]);
    out.specificity[i] = ratio(out.total - truth[i] - said[i] + counts(i, i), out.total - truth[i]);
    out.f1[i] = ratio(2.0 * counts(i, i), truth[i] + said[i]);
  }
  out.macro_precision = out.precision.mean();
  out.balanced_accuracy = out.recall.mean();
  out.macro_f1 = out.f1.mean();
  out.weighted_f1 = out.f1.dot(truth) / out.total;
  const double s2 = out.total * out.total;
  out.mcc = ratio(counts.trace() * out.total - said.dot(truth),
                  std::sqrt((s2 - said.squaredNorm()) * (s2 - truth.squaredNorm())));
}

void add_association(const Matrix& p, const Vector& rows, const Vector& columns, Confusion& out) {
  for (Eigen::Index i = 0; i < p.rows(); ++i)
    for (Eigen::Index j = 0; j < p.cols(); ++j) {
      if (p(i, j) > 0.0)
        out.mutual_information_bits += p(i, j) * std::log2(p(i, j) / (rows[i] * columns[j]));
      if (i < j && p(i, j) + p(j, i) > 0.0)
        out.bowker += out.total * std::pow(p(i, j) - p(j, i), 2.0) / (p(i, j) + p(j, i));
    }
}

}  // namespace

core::Result<Confusion> confusion(const Matrix& counts) {
  core::require(counts.rows() == counts.cols() && counts.rows() > 1,
                "a confusion matrix is square, of two classes or more");
  const auto wrong = [](const char* what) { return core::Error{core::Errc::bad_input, what}; };
  if (!counts.allFinite() || counts.minCoeff() < 0.0 ||
      (counts.array().floor() != counts.array()).any())
    return wrong("a confusion matrix holds whole numbers, none below 0");
  Confusion out;
  out.total = counts.sum();
  if (out.total == 0.0) return wrong("the confusion matrix is empty");
  const Matrix p = counts / out.total;
  const Vector rows = p.rowwise().sum(), columns = p.colwise().sum();
  out.accuracy = counts.trace() / out.total;
  out.expected_agreement = rows.dot(columns);
  if (!(out.expected_agreement < 1.0))
    return wrong("one class alone occurs: agreement beyond chance is undefined");
  out.accuracy_95 = clopper_pearson({counts.trace(), out.total});
  out.no_information_rate = rows.maxCoeff();
  out.p_above_no_information = binomial_upper(counts.trace(), out.total, out.no_information_rate);
  add_kappa(p, rows, columns, out);
  add_classes(counts, out);
  add_association(p, rows, columns, out);
  return out;
}

}  // namespace statistics
}  // namespace tractus
