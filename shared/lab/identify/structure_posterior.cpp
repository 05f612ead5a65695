#include "lab/identify/structure_posterior.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>

#include "lab/identify/fit_report.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kPosterior = kSettings.posterior;

std::vector<std::string> only_in(const Structure& a, const Structure& b) {
  std::vector<std::string> out;
  for (const auto& id : a.effects)
    if (!contains(b, id)) out.push_back(id);
  return out;
}

/// ln of what is left of each fold: the mean of both measures' logarithms, the first alone where nothing is judged.
Eigen::ArrayXd log_left(const Eigen::VectorXd& losses, const Eigen::VectorXd& squares) {
  const Eigen::ArrayXd weighted = losses.array().max(1e-300).log();
  const Eigen::ArrayXd plain = squares.array().max(1e-300).log();
  return squares.array().isFinite().select(0.5 * (weighted + plain), weighted);
}

/// ln of how many structures of that size there are.
double log_structures(std::size_t candidates, std::size_t size) {
  return std::lgamma(double(candidates) + 1.0) - std::lgamma(double(size) + 1.0) -
         std::lgamma(double(candidates - std::min(size, candidates)) + 1.0);
}

}  // namespace

StructurePosterior::StructurePosterior(const Residual& residual, const Selection& selection,
                                       const Solution& chosen)
    : chosen_(chosen.structure) {
  for (const Candidate& candidate : residual.problem().candidates())
    parents_[candidate.facts.id] = candidate.facts.parents;
  double scale = 1e300;
  for (const auto& [key, s] : selection.tried()) scale = std::min(scale, s.scale);
  for (const auto& [key, s] : selection.tried()) {
    if (s.jacobian.rows() != residual.size()) continue;
    if (!(s.structure == chosen_) && !selection.admissible(s)) continue;
    entries_.push_back({s.structure, 0.0, s.mean_square(), 0.0, held_out_losses(residual, s, scale),
                        held_out_squares(residual, s)});
  }
  weigh(residual);
  for (Entry& entry : entries_) entry.weight = entry.probability;
  leave_out_immaterial(residual, selection);
  std::ranges::stable_sort(entries_, std::greater<>(), &Entry::probability);
}

/// Is one structure the other without an effect, or with an effect's simpler limit in its place?
bool StructurePosterior::simpler(const Structure& one, const Structure& other) const {
  const auto lost = only_in(other, one), gained = only_in(one, other);
  if (lost.size() != 1 || gained.size() > 1) return false;
  if (gained.empty()) return true;
  const auto parents = parents_.find(lost.front());
  return parents != parents_.end() &&
         std::ranges::find(parents->second, gained.front()) != parents->second.end();
}

/// A structure that does not lower the unweighted held-out error of the primary channel below that of a simpler one by a
/// material share is none, nor is one with an effect that the trials do not tell from none.
void StructurePosterior::leave_out_immaterial(const Residual& residual,
                                              const Selection& selection) {
  const auto error = [&](Entry& entry) {
    if (!entry.held_out_rmse)
      entry.held_out_rmse = held_out_rmse(residual, selection.tried().at(name(entry.structure)));
    return *entry.held_out_rmse;
  };
  const auto immaterial = [&](Entry& whole) {
    if (whole.structure == chosen_ || whole.probability < kPosterior.least_asked) return false;
    if (!told_from_zero(residual, selection.tried().at(name(whole.structure)))) return true;
    return std::ranges::any_of(entries_, [&](Entry& part) {
      return (part.structure.effects.size() < whole.structure.effects.size() ||
              simpler(part.structure, whole.structure)) &&
             error(whole) >
                 (1.0 - selection.least_fall(whole.structure, part.structure)) * error(part);
    });
  };
  for (;;) {
    std::vector<Entry> material;
    std::vector<Entry> left_out;
    for (Entry& entry : entries_) (immaterial(entry) ? left_out : material).push_back(entry);
    if (material.size() == entries_.size()) return;
    std::ranges::move(left_out, std::back_inserter(immaterial_));
    entries_ = std::move(material);
    weigh(residual);
  }
}

void StructurePosterior::weigh(const Residual& residual) {
  for (Entry& entry : entries_) entry.probability = 0.0;
  const Problem& problem = residual.problem();
  const Eigen::Index folds = entries_.front().losses.size();
  const double per_fold =
      problem.selection_thresholds().observations_per_trial * residual.trials() / double(folds);
  Eigen::MatrixXd scores(folds, Eigen::Index(entries_.size()));
  for (std::size_t m = 0; m < entries_.size(); ++m) {
    const Structure& structure = entries_[m].structure;
    const double of_all = log_structures(problem.candidates().size(), structure.effects.size());
    scores.col(Eigen::Index(m)) =
        -0.5 * per_fold * log_left(entries_[m].losses, entries_[m].squares) -
        of_all / double(folds);
  }
  std::mt19937_64 random(1);  // the same answer each time
  std::exponential_distribution<double> share(1.0);
  for (int draw = 0; draw < kPosterior.bootstraps; ++draw) {
    Eigen::VectorXd weight(folds);
    for (double& w : weight) w = share(random);
    const Eigen::VectorXd total = scores.transpose() * (weight * double(folds) / weight.sum());
    const Eigen::VectorXd likely = (total.array() - total.maxCoeff()).exp();
    for (std::size_t m = 0; m < entries_.size(); ++m)
      entries_[m].probability +=
          likely(Eigen::Index(m)) / likely.sum() / double(kPosterior.bootstraps);
  }
  for (Entry& entry : entries_)
    entry.probability = (1.0 - kPosterior.unforeseen) * entry.probability +
                        kPosterior.unforeseen / double(entries_.size());
}

double StructurePosterior::of_structure(const Structure& structure) const {
  for (const Entry& e : entries_)
    if (e.structure == structure) return e.probability;
  return 0.0;
}

double StructurePosterior::of_effect(const std::string& id) const {
  double sum = 0.0;
  for (const Entry& e : entries_)
    if (contains(e.structure, id)) sum += e.probability;
  return sum;
}

std::vector<Hypothesis> StructurePosterior::hypotheses(const Selection& selection) const {
  std::vector<Hypothesis> out;
  const auto add = [&](const Entry& e, double probability) {
    if (e.weight >= kPosterior.least_left || e.structure == chosen_)
      out.push_back(
          {e.structure, probability, e.weight, selection.tried().at(name(e.structure)).values});
  };
  for (const Entry& e : entries_) add(e, e.probability);
  for (const Entry& e : immaterial_) add(e, 0.0);
  std::ranges::stable_sort(out, [&](const Hypothesis& a, const Hypothesis& b) {
    const bool chosen_a = a.structure == chosen_, chosen_b = b.structure == chosen_;
    return chosen_a != chosen_b ? chosen_a : a.weight > b.weight;
  });
  if (out.size() > kPosterior.most_left) out.resize(kPosterior.most_left);
  return out;
}

std::vector<std::pair<std::string, std::string>> StructurePosterior::confounded() const {
  std::vector<std::pair<std::string, std::string>> out;
  double chosen = 1.0;
  for (const Entry& e : entries_)
    if (e.structure == chosen_) chosen = e.mean_square;
  for (const Entry& e : entries_) {
    if (e.structure.effects.size() != chosen_.effects.size()) continue;
    const auto ours = only_in(chosen_, e.structure), theirs = only_in(e.structure, chosen_);
    if (ours.size() == 1 && theirs.size() == 1 &&
        (e.mean_square < 1.15 * chosen ||
         excess(e.mean_square) < kPosterior.as_good * excess(chosen)))
      out.emplace_back(theirs[0], ours[0]);
  }
  return out;
}

std::optional<DiscriminatingExperiment> StructurePosterior::discriminating_experiment(
    const ParameterSpace& space) const {
  const double now = of_structure(chosen_);
  if (now > kPosterior.settled) return {};
  for (const Entry& e : entries_) {
    if (e.structure == chosen_) continue;
    const auto ours = only_in(chosen_, e.structure), theirs = only_in(e.structure, chosen_);
    const std::string a = ours.empty() ? "" : ours[0], b = theirs.empty() ? "" : theirs[0];
    DiscriminatingExperiment out;
    out.between = {a.empty() ? "nothing" : a, b.empty() ? "nothing" : b};
    out.recording = experiment_for(space, a.empty() ? b : a, a.empty() ? "" : b);
    return out;
  }
  return {};
}

}  // namespace lab
}  // namespace tractus
