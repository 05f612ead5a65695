#include "lab/identify/user_effect_checks.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "effects/catalogues.hpp"
#include "effects/formula.hpp"
#include "lab/identify/least_squares.hpp"
#include "lab/identify/verdict_text.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using Values = std::vector<double>;

constexpr const auto& kChecks = kSettings.user_effects;

Values starts_of(const std::vector<Parameter>& parameters) {
  Values out;
  for (const Parameter& p : parameters) out.push_back(p.start);
  return out;
}

/// The trial in which the formula is no number somewhere, and how often.
Result<void> finite(const Problem& problem, const Structure& with, const Values& values,
                    const std::string& which) {
  for (int k = 0; k < problem.trials(); ++k) {
    const auto before = effects::FormulaProgram::times_not_finite();
    const Residuals residuals = problem.full_rate(with, values, k);
    const auto times = effects::FormulaProgram::times_not_finite() - before;
    if (times > 0)
      return Error{Errc::bad_input,
                   fmt::format("formula: not a finite number at {} moments of trial {} {}; it must "
                               "be one wherever the recordings go",
                               times, problem.trial_id(k), which)};
  }
  return {};
}

Result<void> neutral(const Problem& problem, const Structure& with, const Values& off) {
  const std::size_t base = problem.parameters({}).size();
  for (int k = 0; k < problem.trials(); ++k) {
    Eigen::VectorXd without(problem.residual_size(k)), added(problem.residual_size(k));
    problem.residuals({}, std::span(off).first(base), k, without);
    problem.residuals(with, off, k, added);
    const double change = (added - without).cwiseAbs().maxCoeff();
    if (!(change <= kChecks.neutral * (1.0 + without.cwiseAbs().maxCoeff())))
      return Error{Errc::bad_input,
                   "formula: it does not vanish where its parameters are off; write it as a "
                   "parameter times the rest"};
  }
  return {};
}

/// The effect's response at one start, without what the base can imitate; and how much was its own.
struct Response {
  Eigen::VectorXd direction;  // of length 1; empty if it does nothing
  double independent_share = 0.0;
};

class Imitation {
 public:
  Imitation(const Problem& problem, std::span<const double> base, int threads)
      : residual_(problem, threads), base_(base.begin(), base.end()), at_(residual_({}, base_)) {
    const auto parameters = problem.parameters({});
    std::vector<Values> points;
    for (std::size_t k = 0; k < parameters.size(); ++k) {
      Values moved = base_;
      const Parameter& p = parameters[k];
      const double u = coordinate(p, moved[k]);
      const double up = std::clamp(value_at(p, u + p.step), p.low, p.high);
      moved[k] = up != moved[k] ? up : std::clamp(value_at(p, u - p.step), p.low, p.high);
      if (moved[k] != base_[k]) points.push_back(std::move(moved));
    }
    if (points.empty()) return;
    Eigen::MatrixXd columns = residual_({}, points);
    columns.colwise() -= at_;
    for (Eigen::Index c = 0; c < columns.cols(); ++c)
      if (const double size = columns.col(c).norm(); size > 0.0) columns.col(c) /= size;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(columns);
    base_directions_ = qr.householderQ() * Eigen::MatrixXd::Identity(columns.rows(), qr.rank());
  }

  std::vector<Response> responses(const std::string& effect) const {
    std::vector<Response> out;
    const Structure with{{effect}};
    for (const Values& start : residual_.problem().starts(effect, at_)) {
      Values values = base_;
      values.insert(values.end(), start.begin(), start.end());
      if (values.size() != residual_.problem().parameters(with).size()) continue;
      Eigen::VectorXd moved = residual_(with, values) - at_;
      const double whole = moved.norm();
      if (base_directions_.cols() > 0)
        moved -= base_directions_ * (base_directions_.transpose() * moved);
      const double own = moved.norm();
      if (own > 0.0 && whole > 0.0) out.push_back({moved / own, own / whole});
    }
    return out;
  }

 private:
  Residual residual_;
  Values base_;
  Eigen::VectorXd at_;
  Eigen::MatrixXd base_directions_;  // orthonormal
};

/// Of the shape of `mine` that the other imitates worst.
double likeness(const std::vector<Response>& mine, const std::vector<Response>& other) {
  double least = mine.empty() ? 0.0 : 1.0;
  for (const Response& one : mine) {
    double most = 0.0;
    for (const Response& imitation : other)
      most = std::max(most, std::abs(one.direction.dot(imitation.direction)));
    least = std::min(least, most);
  }
  return least;
}

}  // namespace

Result<void> check_own_effect(const Problem& problem, const std::string& id) {
  const auto& all = problem.candidates();
  const auto it = std::ranges::find_if(all, [&](const auto& c) { return c.facts.id == id; });
  if (it == all.end() || !it->possible) return {};  // the ranking says why
  const Structure with{{id}};
  const auto parameters = problem.parameters(with);
  const std::size_t base = problem.parameters({}).size();
  if (std::ranges::none_of(parameters.begin() + std::ptrdiff_t(base), parameters.end(),
                           [](const Parameter& p) { return !p.shape; }))
    return Error{Errc::bad_input,
                 "formula: no parameter is a factor of all of it, so it can never be off; write it "
                 "as a parameter times the rest"};
  const Values start = starts_of(parameters);
  TRY(finite(problem, with, start, "at its initial numbers"));
  Values off = start;
  for (std::size_t k = base; k < parameters.size(); ++k) {
    const Parameter& p = parameters[k];
    if (!p.shape) off[k] = p.off;
    for (const double bound : {p.low, p.high}) {
      Values values = start;
      values[k] = bound;
      if (auto fine =
              finite(problem, with, values, fmt::format("with {} = {:.4g}", p.pointer, bound));
          !fine)
        return fine;
    }
  }
  return neutral(problem, with, off);
}

std::vector<std::string> likenesses(const Problem& problem, const std::vector<std::string>& own,
                                    std::span<const double> base, int threads) {
  const Imitation imitation(problem, base, threads);
  std::vector<std::pair<std::string, std::vector<Response>>> all;
  for (const Candidate& candidate : problem.candidates())
    if (candidate.possible && !candidate.facts.free_per_trial)
      all.emplace_back(candidate.facts.id, imitation.responses(candidate.facts.id));
  std::vector<std::string> out;
  for (const std::string& id : own) {
    const auto mine = std::ranges::find(all, id, &decltype(all)::value_type::first);
    if (mine == all.end()) continue;
    double independent_share = 0.0;
    for (const Response& response : mine->second)
      independent_share = std::max(independent_share, response.independent_share);
    if (independent_share < kChecks.least_own)
      out.push_back(
          fmt::format("{}: in these recordings the model's own numbers imitate all but "
                      "{:.2g} % of what it does",
                      id, 100.0 * independent_share));
    for (const auto& [other, responses] : all) {
      if (other == id) continue;
      if (const double alike = likeness(mine->second, responses); alike > kChecks.alike)
        out.push_back(
            fmt::format("{} and {} do nearly the same in these recordings ({:.3f} alike "
                        "once the model's own numbers are fitted): they can be told "
                        "apart only as a set",
                        id, effects::label_of(other), alike));
    }
  }
  const std::size_t beside = problem.candidates().size() - own.size();
  out.push_back(fmt::format("{} effect{} of your own {} ranked beside the catalogue's {}",
                            own.size(), own.size() == 1 ? "" : "s",
                            own.size() == 1 ? "was" : "were", beside));
  return out;
}

}  // namespace lab
}  // namespace tractus
