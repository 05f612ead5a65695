#include "lab/discover/formula_screen.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "core/require.hpp"
#include "lab/identify/parallel.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr std::size_t kDepth = 0, kSpeed = 1, kTurning = 4;  // of the probing states

double quantile_of(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + std::ptrdiff_t(share * double(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

SignalScales scales_of(const std::vector<FormulaSignals>& trials) {
  SignalScales out;
  std::vector<double> speeds, turnings, works;
  out.least_depth_m = 1e9, out.most_depth_m = -1e9;
  for (const FormulaSignals& trial : trials) {
    const auto& x = trial.states[kDepth];
    const auto [least, most] = std::ranges::minmax(x);
    out.least_depth_m = std::min(out.least_depth_m, least);
    out.most_depth_m = std::max(out.most_depth_m, most);
    double length_s = 0.0;
    for (const auto& step : trial.steps) length_s += step.dt_s;
    out.longest_s = std::max(out.longest_s, length_s);
    for (const double v : trial.states[kSpeed])
      if (v != 0.0) speeds.push_back(std::abs(v));
    for (const double w : trial.states[kTurning]) turnings.push_back(std::abs(w));
    works.push_back(evaluated("work(base_N, x_m)", {}, trial).back());
  }
  out.slow_m_s = std::max(1e-6, quantile_of(speeds, 0.1));
  out.fast_m_s = std::max(2.0 * out.slow_m_s, quantile_of(speeds, 0.9));
  out.work_J = quantile_of(works, 0.5);
  out.turning_rad_s = quantile_of(turnings, 0.5);
  if (out.turning_rad_s < 1e-3) out.turning_rad_s = 0.0;
  return out;
}

/// Derivatives by the parameters that a first-order step may move: not the places of borders, in
/// which the loss is rough.
std::vector<Eigen::Index> smooth_columns(const Solution& at) {
  std::vector<Eigen::Index> out;
  for (std::size_t k = 0; k < at.parameters.size(); ++k)
    if (!(at.parameters[k].rough > 0.0)) out.push_back(Eigen::Index(k));
  return out;
}

TrialGram gram_of(const Eigen::MatrixXd& z, const Eigen::VectorXd& r) {
  return {z.transpose() * z, z.transpose() * r, r.squaredNorm(), double(r.size())};
}

/// What is believed of the parameters of a solution.
LinearPrior prior_of_solution(const Solution& at, const std::vector<Eigen::Index>& which,
                              const std::vector<TrialGram>& trials) {
  const auto p = Eigen::Index(which.size());
  LinearPrior out{Eigen::MatrixXd::Zero(p, p), Eigen::VectorXd::Zero(p)};
  double rows = 0.0;
  for (const TrialGram& t : trials) rows += t.rows;
  for (Eigen::Index i = 0; i < p; ++i) {
    const auto k = std::size_t(which[std::size_t(i)]);
    const Parameter& parameter = at.parameters[k];
    double information = 0.0;
    for (const TrialGram& t : trials) information += t.a(i, i);
    out.precision(i, i) = kDiscovery.vague * information / rows;
    if (!std::isfinite(parameter.prior_sd)) continue;
    out.precision(i, i) += 1.0 / (parameter.prior_sd * parameter.prior_sd);
    out.mean(i) = coordinate(parameter, parameter.start) - coordinate(parameter, at.values[k]);
  }
  return out;
}

LinearPrior prior_with(const LinearPrior& a, const Eigen::MatrixXd& precision) {
  const Eigen::Index n = a.mean.size(), more = precision.rows();
  LinearPrior out{Eigen::MatrixXd::Zero(n + more, n + more), Eigen::VectorXd::Zero(n + more)};
  out.precision.topLeftCorner(n, n) = a.precision;
  out.precision.bottomRightCorner(more, more) = precision;
  out.mean.head(n) = a.mean;
  return out;
}

}  // namespace

std::vector<double> evaluated(std::string_view text, std::span<const FactorNumber> numbers,
                              const FormulaSignals& signals) {
  Factor factor{FactorPart::whole, std::string(text), {}, {numbers.begin(), numbers.end()}, ""};
  const auto quantities = quantities_of(factor);
  const auto facts = effects::check_formula(text, quantities, std::nullopt);
  core::require(bool(facts), "a factor of the grammar is a formula");
  auto program = effects::FormulaProgram::make(factor.text, quantities, facts->memories);
  core::require(bool(program), "a checked formula can be evaluated");
  const auto in = program->inputs();
  const std::size_t states = quantities.size() - numbers.size();
  for (std::size_t k = 0; k < numbers.size(); ++k) in[states + k] = numbers[k].value;
  effects::FormulaMemory memory;
  std::vector<double> out(signals.steps.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (std::size_t s = 0; s < states; ++s)
      in[s] = signals.states[s].empty() ? 0.0 : signals.states[s][i];
    out[i] = program->value(signals.steps[i], memory);
  }
  return out;
}

FormulaScreen::FormulaScreen(const Residual& residual, const Solution& base)
    : rig_(*residual.problem().formula_terms()), structure_(base.structure) {
  const auto trials = std::size_t(residual.trials());
  signals_.resize(trials);
  judged_.resize(trials);
  sizes_.resize(trials);
  columns_.resize(trials);
  parallel(residual.trials(), residual.threads(), [&](int k) {
    signals_[std::size_t(k)] = rig_.signals(base.structure, base.values, k);
    const auto moving = rig_.moving(k);
    sizes_[std::size_t(k)] = Eigen::Index(moving.size());
    for (std::size_t row = 0; row < moving.size(); ++row)
      if (moving[row]) judged_[std::size_t(k)].push_back(Eigen::Index(row));
  });
  factors_ = factors_of(scales_of(signals_));
  terms_ = terms_of(factors_);
  std::set<std::string_view> names;
  for (const Term& term : terms_) names.insert(term.family);
  families_ = names.size();
  parallel(residual.trials(), residual.threads(), [&](int k) { evaluate(k); });
}

void FormulaScreen::evaluate(int trial) {
  const FormulaSignals& signals = signals_[std::size_t(trial)];
  std::vector<std::vector<double>> values;
  for (const Factor& factor : factors_)
    values.push_back(evaluated(factor.text, factor.numbers, signals));
  Eigen::MatrixXf& columns = columns_[std::size_t(trial)];
  columns.resize(Eigen::Index(judged_[std::size_t(trial)].size()), Eigen::Index(terms_.size()));
  std::vector<double> product(signals.steps.size());
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    product = values[terms_[k].factors.front()];
    for (std::size_t f = 1; f < terms_[k].factors.size(); ++f) {
      const auto& more = values[terms_[k].factors[f]];
      for (std::size_t i = 0; i < product.size(); ++i) product[i] *= more[i];
    }
    columns.col(Eigen::Index(k)) = response(product, trial).cast<float>();
  }
}

Eigen::VectorXd FormulaScreen::response(std::span<const double> added, int trial) const {
  Eigen::VectorXd all(sizes_[std::size_t(trial)]);
  rig_.response(structure_, trial, added, all);
  return all(judged_[std::size_t(trial)]);
}

Eigen::MatrixXd FormulaScreen::rows_of(const Eigen::Ref<const Eigen::MatrixXd>& all,
                                       int trial) const {
  return all(judged_[std::size_t(trial)], Eigen::all);
}

std::vector<Eigen::VectorXd> FormulaScreen::residuals_of(const Residual& residual,
                                                         const Solution& at) const {
  std::vector<Eigen::VectorXd> out;
  for (int k = 0; k < residual.trials(); ++k)
    out.push_back(rows_of(
        at.residual.segment(residual.offset(k), residual.offset(k + 1) - residual.offset(k)), k));
  return out;
}

Evidence FormulaScreen::evidence_of(const Residual& residual, const Solution& at,
                                    double correlation) const {
  return evidence_with(residual, at, correlation, {}, Eigen::MatrixXd(0, 0));
}

Evidence FormulaScreen::evidence_with(const Residual& residual, const Solution& at,
                                      double correlation,
                                      const std::vector<Eigen::MatrixXd>& columns,
                                      const Eigen::MatrixXd& precision) const {
  const auto which = smooth_columns(at);
  const auto p = Eigen::Index(which.size());
  const auto r = residuals_of(residual, at);
  std::vector<TrialGram> trials(r.size());
  parallel(residual.trials(), residual.threads(), [&](int k) {
    const auto t = std::size_t(k);
    const Eigen::MatrixXd mine = at.jacobian.middleRows(
        residual.offset(k), residual.offset(k + 1) - residual.offset(k))(Eigen::all, which);
    Eigen::MatrixXd z(r[t].size(), p + precision.rows());
    z.leftCols(p) = rows_of(mine, k);
    if (precision.rows() > 0) z.rightCols(precision.rows()) = columns[t];
    trials[t] = gram_of(z, r[t]);
  });
  return leave_one_out(trials, prior_with(prior_of_solution(at, which, trials), precision),
                       correlation);
}

std::vector<ScreenedTerm> FormulaScreen::ranked(const Residual& residual, const Solution& at,
                                                double correlation) const {
  const auto which = smooth_columns(at);
  const auto p = Eigen::Index(which.size());
  const auto r = residuals_of(residual, at);
  const std::size_t trials = r.size();
  std::vector<TrialGram> own(trials);
  std::vector<Eigen::MatrixXd> with_own(trials);  // (parameter, term)
  std::vector<Eigen::VectorXd> with_rest(trials), squares(trials);
  parallel(residual.trials(), residual.threads(), [&](int k) {
    const auto t = std::size_t(k);
    const Eigen::MatrixXd mine = at.jacobian.middleRows(
        residual.offset(k), residual.offset(k + 1) - residual.offset(k))(Eigen::all, which);
    const Eigen::MatrixXd z = rows_of(mine, k);
    own[t] = gram_of(z, r[t]);
    const Eigen::MatrixXd c = columns_[t].cast<double>();
    with_own[t] = z.transpose() * c;
    with_rest[t] = c.transpose() * r[t];
    squares[t] = c.colwise().squaredNorm();
  });
  const LinearPrior prior = prior_of_solution(at, which, own);
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(p, p),
                  cross = Eigen::MatrixXd::Zero(p, squares[0].size());
  Eigen::VectorXd size = Eigen::VectorXd::Zero(squares[0].size());
  double rest = 0.0;
  for (std::size_t t = 0; t < trials; ++t)
    all += own[t].a, cross += with_own[t], size += squares[t], rest += own[t].rr;
  for (Eigen::Index k = 0; k < p; ++k) all(k, k) += 1e-9 * std::max(all(k, k), 1e-30);
  const Eigen::MatrixXd imitated = Eigen::LDLT<Eigen::MatrixXd>(all).solve(cross);
  std::vector<ScreenedTerm> out(terms_.size());
  std::vector<char> kept(terms_.size(), 0);
  parallel(int(terms_.size()), residual.threads(), [&](int item) {
    const auto c = Eigen::Index(item);
    const double share = 1.0 - cross.col(c).dot(imitated.col(c)) / std::max(size(c), 1e-300);
    if (!(size(c) > 0.0) || !(share > kDiscovery.least_own_share)) return;
    std::vector<TrialGram> grams(trials);
    for (std::size_t t = 0; t < trials; ++t) {
      TrialGram& g = grams[t];
      g = {Eigen::MatrixXd(p + 1, p + 1), Eigen::VectorXd(p + 1), own[t].rr, own[t].rows};
      g.a.topLeftCorner(p, p) = own[t].a;
      g.a.col(p).head(p) = with_own[t].col(c);
      g.a.row(p).head(p) = with_own[t].col(c).transpose();
      g.a(p, p) = squares[t](c);
      g.b.head(p) = own[t].b;
      g.b(p) = with_rest[t](c);
    }
    const double believed = kDiscovery.most_amplitude * kDiscovery.most_amplitude;
    const Eigen::MatrixXd precision =
        Eigen::MatrixXd::Constant(1, 1, size(c) / (believed * std::max(rest, 1e-300)));
    ScreenedTerm& found = out[std::size_t(item)];
    found.term = std::size_t(item);
    found.evidence = leave_one_out(grams, prior_with(prior, precision), correlation);
    found.amplitude = found.evidence.change(p);
    kept[std::size_t(item)] = 1;
  });
  std::map<std::string_view, const ScreenedTerm*> best;
  for (std::size_t k = 0; k < out.size(); ++k) {
    if (!kept[k]) continue;
    const ScreenedTerm*& known = best[terms_[k].family];
    if (!known || out[k].evidence.total > known->evidence.total) known = &out[k];
  }
  std::vector<ScreenedTerm> list;
  for (const auto& [family, found] : best) list.push_back(*found);
  std::ranges::stable_sort(list, std::greater<>(),
                           [](const ScreenedTerm& s) { return s.evidence.total; });
  return list;
}

}  // namespace lab
}  // namespace tractus
