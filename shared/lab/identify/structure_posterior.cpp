#include "lab/identify/structure_posterior.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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

}  // namespace

bool at_floor(const Problem& problem, double mean_square, double before) {
  const SelectionThresholds& thresholds = problem.selection_thresholds();
  return mean_square < thresholds.at_floor ||
         excess(mean_square) < thresholds.least_excess_share * excess(before);
}

bool explains(double mean_square, double before) {
  return excess(mean_square) < kPosterior.most_left * excess(before);
}

StructurePosterior::StructurePosterior(const Residual& residual, const Selection& selection,
                                       const Solution& chosen)
    : chosen_(chosen.structure) {
  const double base = selection.base().mean_square();
  std::vector<double> scores;
  const double of_chosen = -cost(residual, chosen, selection.base());
  for (const auto& [key, s] : selection.tried()) {
    if (!selection.admissible(s)) continue;
    entries_.push_back({s.structure, 0.0, s.mean_square()});
    scores.push_back(-cost(residual, s, selection.base()));
  }
  const double best = *std::ranges::max_element(scores);
  // Its rivals were refused for reasons of their own.
  for (std::size_t k = 0; k < scores.size(); ++k)
    if (entries_[k].structure == chosen_)
      scores[k] = std::max(of_chosen, best + kPosterior.refused_log_odds);
  const std::size_t count = std::min(chosen_.effects.size(), kPosterior.imitated.size() - 1);
  outside_ = at_floor(residual.problem(), chosen.mean_square(), base) || selection.immaterial()
                 ? kPosterior.imitated[count]
             : chosen_.effects.empty() ? kPosterior.outside
                                       : kPosterior.stand_in;
  // P(structure) ∝ exp(−cost), structures equally likely beforehand [Kass1995].
  double sum = 0.0;
  for (const double s : scores) sum += std::exp(s - best);
  for (std::size_t k = 0; k < scores.size(); ++k)
    entries_[k].probability = (1.0 - outside_) * std::exp(scores[k] - best) / sum;
  std::ranges::stable_sort(entries_, std::greater<>(), &Entry::probability);
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
    out.expected_gain = std::clamp(kPosterior.settled - now, 0.0, 1.0);
    return out;
  }
  return {};
}

}  // namespace lab
}  // namespace tractus
