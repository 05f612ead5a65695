#include "lab/identify/law_dependence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"
#include "lab/signal/drift.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kLaws = kSettings.laws;

using Products = Eigen::MatrixXd;

/// The trials' products, and which terms belong to which law.
class Trials {
 public:
  Trials(const std::vector<Products>& products, const ForceLaws& laws) : products_(products) {
    sum_ = Products::Zero(products_.front().rows(), products_.front().cols());
    for (const Products& p : products_) sum_ += p;
    Eigen::Index first = 0;
    for (const ForceLaws::Law& law : laws.laws) {
      terms_.emplace_back();
      for (std::size_t k = 0; k < law.terms.size(); ++k) terms_.back().push_back(first++);
    }
  }

  double squares() const { return sum_(error(), error()); }
  /// What laws leave of the squares, each trial by the numbers of the others.
  double left(const std::vector<std::size_t>& laws) const {
    std::vector<Eigen::Index> terms;
    for (const std::size_t law : laws)
      terms.insert(terms.end(), terms_[law].begin(), terms_[law].end());
    const Eigen::VectorXd size =
        sum_(terms, terms).diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt();
    double out = 0.0;
    for (const Products& own : products_) {
      const Products others = sum_ - own;
      Eigen::MatrixXd a = others(terms, terms);
      a = size.cwiseInverse().asDiagonal() * a * size.cwiseInverse().asDiagonal();
      a.diagonal().array() += kLaws.ridge;
      const Eigen::VectorXd b = others(terms, error()).cwiseQuotient(size);
      const Eigen::VectorXd x = a.llt().solve(b).cwiseQuotient(size);
      out +=
          own(error(), error()) - 2.0 * x.dot(own(terms, error())) + x.dot(own(terms, terms) * x);
    }
    return out;
  }

 private:
  Eigen::Index error() const { return sum_.rows() - 1; }

  const std::vector<Products>& products_;
  Products sum_;
  std::vector<std::vector<Eigen::Index>> terms_;  // of each law
};

/// Of weighted rows, three for each judged sample.
void remove_trends(const Residuals& r, const std::vector<Eigen::Index>& judged,
                   const ForceLaws& laws, Eigen::MatrixXd& rows) {
  std::vector<double> t_s, sd_N;
  for (const Eigen::Index k : judged) {
    t_s.push_back(r.t_s[std::size_t(k)]);
    sd_N.push_back(laws.error_sd_N[std::size_t(k)]);
  }
  const Drift drift(t_s, sd_N);
  for (Eigen::Index column = 0; column < rows.cols(); ++column)
    for (int c = 0; c < 3; ++c) {
      auto of_component = rows.col(column)(Eigen::seqN(c, Eigen::Index(judged.size()), 3));
      Eigen::VectorXd left = of_component;
      drift.remove(left);
      of_component = left;
    }
}

}  // namespace

Eigen::MatrixXd law_products(const Residuals& r, const ForceLaws& laws, bool without_trends) {
  std::vector<Eigen::Index> judged;
  for (std::size_t k = 0; k < r.t_s.size(); ++k)
    if (r.judgement[k] == Judgement::judged) judged.push_back(Eigen::Index(k));
  if (without_trends && judged.size() <= Drift::kOrders) judged.clear();  // a trend is all of them
  std::size_t terms = 0;
  for (const ForceLaws::Law& law : laws.laws) terms += law.terms.size();
  Eigen::MatrixXd rows(3 * Eigen::Index(judged.size()), Eigen::Index(terms) + 1);
  for (std::size_t j = 0; j < judged.size(); ++j) {
    const Eigen::Index k = judged[j], at = 3 * Eigen::Index(j);
    const double weight = 1.0 / laws.error_sd_N[std::size_t(k)];
    Eigen::Index column = 0;
    for (const ForceLaws::Law& law : laws.laws)
      for (const Eigen::Matrix3Xd& term : law.terms)
        rows.block<3, 1>(at, column++) = weight * term.col(k);
    for (int c = 0; c < 3; ++c)
      rows(at + c, column) = weight * r.channels[std::size_t(c) + 1][std::size_t(k)];
  }
  if (without_trends && !judged.empty()) remove_trends(r, judged, laws, rows);
  return rows.transpose() * rows;
}

LawDependence law_dependence(const std::vector<Eigen::MatrixXd>& products, const ForceLaws& laws) {
  const Trials trials(products, laws);
  LawDependence out;
  std::vector<std::size_t> chosen{0};
  const double before = trials.left(chosen);
  double left = before;
  while (out.laws.size() < kLaws.most_laws) {
    std::size_t best = 0;
    double least = left - kLaws.least_more * trials.squares();
    for (std::size_t law = 1; law < laws.laws.size(); ++law) {
      if (std::ranges::find(chosen, law) != chosen.end()) continue;
      std::vector<std::size_t> with = chosen;
      with.push_back(law);
      if (const double after = trials.left(with); after < least) least = after, best = law;
    }
    if (best == 0) break;
    chosen.push_back(best);
    out.laws.push_back(laws.laws[best].name);
    left = least;
  }
  if (!out.laws.empty()) out.share = std::clamp((before - left) / trials.squares(), 0.0, 1.0);
  return out;
}

LawDependence law_dependence(const Residual& residual, const Solution& at) {
  const Problem& problem = residual.problem();
  if (problem.trials() < kSettings.validation.fewest_trials) return {};
  const bool without_trends = std::ranges::any_of(problem.candidates(), [&](const Candidate& c) {
    return c.facts.free_per_trial && contains(at.structure, c.facts.id);
  });
  std::vector<ForceLaws> laws(std::size_t(problem.trials()));
  std::vector<Eigen::MatrixXd> products(laws.size());
  parallel(problem.trials(), residual.threads(), [&](int k) {
    ForceLaws& of_trial = laws[std::size_t(k)] = problem.force_laws(k);
    if (of_trial.laws.empty()) return;
    products[std::size_t(k)] =
        law_products(problem.full_rate(at.structure, at.values, k), of_trial, without_trends);
    for (ForceLaws::Law& law : of_trial.laws)
      for (Eigen::Matrix3Xd& term : law.terms) term.resize(3, 0);  // they are large
  });
  return laws.front().laws.empty() ? LawDependence{} : law_dependence(products, laws.front());
}

}  // namespace lab
}  // namespace tractus
