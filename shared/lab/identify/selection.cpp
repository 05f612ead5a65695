#include "lab/identify/selection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lab/identify/drift_on_motion.hpp"
#include "lab/identify/fit_report.hpp"
#include "lab/identify/free_air.hpp"
#include "lab/identify/structure_posterior.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

constexpr const auto& kSelection = kSettings.selection;

double numbers_beyond(const Residual& residual, const Solution& larger, const Solution& smaller) {
  const Problem& problem = residual.problem();
  return double(larger.values.size()) - double(smaller.values.size()) +
         problem.free_per_trial(larger.structure) - problem.free_per_trial(smaller.structure);
}

/// Mean squares of two structures over what both judge.
std::pair<double, double> mean_squares(const Solution& a, const Solution& b) {
  double of_a = 0.0, of_b = 0.0, count = 0.0;
  for (Eigen::Index k = 0; k < a.residual.size(); ++k) {
    if (a.residual(k) == 0.0 || b.residual(k) == 0.0) continue;
    of_a += robust_loss(a.residual.segment(k, 1), a.scale);
    of_b += robust_loss(b.residual.segment(k, 1), b.scale);
    count += 1.0;
  }
  return {of_a / std::max(1.0, count), of_b / std::max(1.0, count)};
}

bool is_free_per_trial(const Problem& problem, const std::string& id) {
  return std::ranges::any_of(problem.candidates(), [&](const Candidate& candidate) {
    return candidate.facts.free_per_trial && candidate.facts.id == id;
  });
}

}  // namespace

/// n/2 ln S + Δprior/2 + price·k, in nats: as Schwarz's criterion [Schwarz1978], with n the
/// independent observations, S the mean square, k the numbers beyond the base, and a fixed price of
/// a number where his is ½ ln n.
double cost(const Residual& residual, const Solution& s, const Solution& base) {
  return 0.5 * residual.problem().selection_thresholds().observations_per_trial *
             double(residual.trials()) *
             std::log(std::max(kSelection.least_mean_square, s.mean_square())) +
         0.5 * (s.prior - base.prior) + kSelection.price_nats * numbers_beyond(residual, s, base);
}

std::string name(const Structure& structure) {
  return fmt::format("{}", fmt::join(structure.effects, " + "));
}

double excess(double mean_square) { return std::max(mean_square - 1.0, 1e-3); }

Selection::Selection(const Residual& residual, const DiagnoseOptions& options,
                     const core::Progress& progress)
    : residual_(residual), options_(options), progress_(progress) {}

bool Selection::go_on(double share) {
  if (progress_ && !progress_(share)) stopped_ = true;
  return !stopped_;
}

Solution& Selection::fitted(const Solution& from, const std::string& effect, int tries) {
  const std::string key = name(plus(from.structure, effect));
  const auto known = tried_.find(key);
  Solution found = extend(residual_, from, linear_screen(residual_, from, effect), effect, tries);
  if (known != tried_.end() && known->second.mean_square() <= found.mean_square())
    return known->second;
  refined_.erase(key);
  return tried_[key] = std::move(found);
}

bool Selection::clearly_better(const Solution& larger, const Solution& smaller) const {
  const SelectionThresholds& thresholds = residual_.problem().selection_thresholds();
  const auto [after, before] = mean_squares(larger, smaller);
  const double numbers = std::max(1.0, numbers_beyond(residual_, larger, smaller));
  const double gained = double(residual_.size()) * (before - after) / std::max(1.0, after) +
                        smaller.prior - larger.prior;
  return gained > kSelection.clear_loss * numbers &&
         before - after > thresholds.least_gain_share * before &&
         before - after > thresholds.least_gain_of_excess * excess(base().mean_square());
}

bool Selection::admissible(const Solution& at) const {
  if (!refused_.empty() && contains(at.structure, refused_)) return false;
  for (const std::string& id : unseen_in_air_)
    if (contains(at.structure, id)) return false;
  for (const Candidate& candidate : residual_.problem().candidates()) {
    if (candidate.facts.admissible == nullptr || !contains(at.structure, candidate.facts.id))
      continue;
    std::vector<double> own;
    for (std::size_t k = 0; k < at.parameters.size(); ++k)
      if (at.parameters[k].pointer.starts_with(candidate.facts.id + "/"))
        own.push_back(at.values[k]);
    if (!candidate.facts.admissible(own)) return false;
  }
  return true;
}

double Selection::least_fall(const Structure& larger, const Structure& smaller) const {
  const bool free =
      std::ranges::any_of(residual_.problem().candidates(), [&](const Candidate& candidate) {
        return candidate.facts.free_per_trial && contains(larger, candidate.facts.id) &&
               !contains(smaller, candidate.facts.id);
      });
  return free ? kSelection.least_fall_of_free : kSelection.least_fall;
}

std::vector<const Solution*> Selection::best_of(std::size_t effects, std::size_t most) const {
  std::vector<const Solution*> out;
  for (const auto& [key, solution] : tried_)
    if (solution.structure.effects.size() == effects && admissible(solution))
      out.push_back(&solution);
  std::ranges::stable_sort(out, {}, [&](const Solution* s) { return cost(residual_, *s, base()); });
  if (out.size() > most) out.resize(most);
  return out;
}

/// The best of a size by cost, and those that come nearest to the floor: the price of what is free in each trial must not
/// keep what explains most from being grown.
std::vector<const Solution*> Selection::to_grow(std::size_t effects) const {
  auto out = best_of(effects, kSelection.grown);
  auto all = best_of(effects, tried_.size());
  std::ranges::stable_sort(all, {}, [](const Solution* s) { return s->mean_square(); });
  if (all.size() > kSelection.grown_by_square) all.resize(kSelection.grown_by_square);
  for (const Solution* s : all)
    if (std::ranges::find(out, s) == out.end()) out.push_back(s);
  return out;
}

void Selection::keep_better(const std::string& key, Solution found) {
  const auto known = tried_.find(key);
  if (known != tried_.end() && known->second.mean_square() <= found.mean_square()) return;
  tried_[key] = std::move(found);
  refined_.erase(key);
}

void Selection::singles() {
  const auto& candidates = residual_.problem().candidates();
  double done = 0.0;
  for (const Candidate& candidate : candidates) {
    if (!go_on(0.1 + 0.4 * done++ / double(candidates.size()))) return;
    const std::string& id = candidate.facts.id;
    if (!candidate.possible) continue;
    if (!options_.only.empty() && std::ranges::find(options_.only, id) == options_.only.end())
      continue;
    LinearScreen seen = linear_screen(residual_, base(), id);
    if (seen.excited) tried_[id] = extend(residual_, base(), seen, id, kSelection.tries);
    // A base fitted without a delay that is there has its borders elsewhere, and no way leads back from it.
    if (candidate.facts.is_delay && seen.excited) keep_better(id, fit_base(residual_, {{id}}));
    screens_[id] = std::move(seen);
  }
}

void Selection::refine(std::size_t effects) {
  for (const Solution* s : best_of(effects, kSelection.refined)) {
    const std::string key = name(s->structure);
    if (!refined_.insert(key).second) continue;
    Solution& at = tried_[key];
    at = polish(residual_, search(residual_, at.structure, at.values, nullptr,
                                  {.max_iterations = 8, .tolerance = 1e-5}));
  }
}

/// A pair was fitted from the shapes that suited its effects alone: the best of a size is begun
/// anew from all shapes of each of its effects, if it is not at the floor.
void Selection::reshape(std::size_t effects) {
  const auto best = best_of(effects, 1);
  if (best.empty() || effects < 2 || best.front()->mean_square() < kSelection.reshape_above) return;
  const Structure structure = best.front()->structure;
  for (const std::string& id : structure.effects) {
    const auto part = tried_.find(name(minus(structure, id)));
    if (part == tried_.end()) continue;
    Solution from = part->second;
    from = polish(residual_, search(residual_, from.structure, from.values, nullptr,
                                    {.max_iterations = 8, .tolerance = 1e-4}));
    differentiate(residual_, from);
    fitted(from, id, kSelection.reshape_tries);
  }
}

/// Adds effects to the best structures of each size until the best is at the floor. One that is at the floor by numbers that
/// are free in each trial is grown all the same, for these take up what another effect does slowly.
void Selection::grow() {
  refine(1);
  const SelectionThresholds& thresholds = residual_.problem().selection_thresholds();
  const auto first = best_of(1, 1);
  if (base().mean_square() < thresholds.stop_if_given_below && !first.empty() &&
      !clearly_better(*first.front(), base()))
    return;
  for (int size = 1; size < options_.max_effects; ++size) {
    const auto best = to_grow(std::size_t(size));
    if (best.empty() || (best.front()->mean_square() < thresholds.stop_below &&
                         residual_.problem().free_per_trial(best.front()->structure) == 0))
      return;
    std::vector<std::pair<const Solution*, std::string>> todo;
    for (const Solution* from : best) {
      std::vector<std::pair<double, std::string>> gains;
      Solution at = *from;
      differentiate(residual_, at);
      tried_[name(at.structure)] = at;
      for (const auto& [id, seen] : screens_) {
        if (!seen.excited || contains(at.structure, id)) continue;
        if (!go_on(0.5 + 0.15 * size)) return;
        const LinearScreen now = linear_screen(residual_, at, id);
        gains.emplace_back(now.starts.front().gain, id);
      }
      std::ranges::sort(gains, std::greater<>());
      if (gains.size() > kSelection.tried_on_each) gains.resize(kSelection.tried_on_each);
      for (const auto& [gain, id] : gains)
        if (gain > kSelection.clear_loss) todo.emplace_back(&tried_[name(at.structure)], id);
    }
    for (const auto& [from, id] : todo) {
      if (!go_on(0.6 + 0.15 * size)) return;
      fitted(*from, id, 1);
    }
    refine(std::size_t(size + 1));
    reshape(std::size_t(size + 1));
    const auto larger = best_of(std::size_t(size + 1), 1);
    if (larger.empty() || !clearly_better(*larger.front(), *best_of(std::size_t(size), 1).front()))
      return;
  }
}

/// A part of a structure fitted from where the whole of it stands, which may be a better place than
/// where its own search ended.
void Selection::part(const Solution& at, const Structure& less) {
  Solution found = search(residual_, less, carried(residual_.problem().parameters(less), at), &at);
  differentiate(residual_, found);
  keep_better(name(less), std::move(found));
}

/// Fits what is simpler than a structure: without each effect, and with each effect's simpler limit in its place.
void Selection::simplify(const Structure& whole) {
  for (const std::string& id : whole.effects) {
    const Structure less = minus(whole, id);
    part(Solution(tried_.at(name(whole))), less);
    for (const Candidate& candidate : residual_.problem().candidates()) {
      if (candidate.facts.id != id) continue;
      for (const std::string& parent : candidate.facts.parents)
        if (!contains(whole, parent) && screens_.contains(parent) && screens_.at(parent).excited)
          fitted(Solution(tried_.at(name(less))), parent, kSelection.tries);
    }
  }
}

/// The most probable structure, what is simpler than it fitted too.
void Selection::choose() {
  std::set<std::string> simplified;
  do {
    chosen_ = name(StructurePosterior(residual_, *this, base()).most_probable());
    simplify(Structure(chosen().structure));
  } while (simplified.insert(chosen_).second && go_on(0.9));
}

/// A trend that is free in every trial can stand in for any slow law. Where it follows the motion it is no sensor's, and
/// the choice is made anew without it.
void Selection::refuse_trends() {
  for (const Candidate& candidate : residual_.problem().candidates()) {
    const std::string& id = candidate.facts.id;
    if (!candidate.facts.free_per_trial || !contains(chosen().structure, id)) continue;
    if (drift_r2_on_motion(residual_, chosen(), id) <
        residual_.problem().selection_thresholds().drift_r2_on_motion)
      continue;
    part(Solution(chosen()), minus(chosen().structure, id));
    refused_ = id;
    choose();
  }
}

/// Noise of a pose in contact looks like a small mass at the tip, and bone that is softer one way like a sensor that drifts.
/// A mass and a drift act in free air, too: what is not seen there is neither, and the choice is made anew without it.
void Selection::require_free_air() {
  if (residual_.problem().in_free_air(0).empty()) return;
  for (bool dropped = true; dropped;) {
    dropped = false;
    for (const std::string& id : Structure(chosen().structure).effects) {
      const Structure less = minus(chosen().structure, id);
      part(Solution(chosen()), less);
      const auto shown = share_in_free_air(
          residual_, chosen(), tried_.at(name(less)),
          is_free_per_trial(residual_.problem(), id) ? 0.0 : kSettings.free_air.least_share);
      if (!shown || *shown >= kSettings.free_air.least_shown) continue;
      unseen_in_air_.insert(id);
      choose();
      dropped = true;
      break;
    }
  }
}

/// Root mean square of the judged samples of trials that a fit did not see, without weights.
double error_on_held_out(const Residual& residual, Solution at) {
  differentiate(residual, at);
  return held_out_rmse(residual, at);
}

/// Weights of a robust fit may hide what an effect makes worse: an effect stays only if the error without weights,
/// on held-out trials, is lower with it.
void Selection::require_lower_error() {
  for (bool dropped = true; dropped && !chosen_.empty();) {
    dropped = false;
    const double with = error_on_held_out(residual_, chosen());
    for (const std::string& id : chosen().structure.effects) {
      const Structure less = minus(chosen().structure, id);
      part(Solution(chosen()), less);
      const double fall = least_fall(chosen().structure, less);
      if (with < (1.0 - fall) * error_on_held_out(residual_, tried_.at(name(less)))) continue;
      chosen_ = name(less);
      dropped = true;
      break;
    }
  }
}

/// How far the places of rest of the base's layers have moved from the model's, root mean square.
/// `count`: of how many.
double moved(const Solution& at, int& count) {
  double sum = 0.0;
  count = 0;
  for (std::size_t k = 0; k < at.values.size(); ++k) {
    const Parameter& p = at.parameters[k];
    if (!p.pointer.starts_with('/') || !p.pointer.ends_with("/equilibrium_m")) continue;
    sum += (at.values[k] - p.start) * (at.values[k] - p.start);
    ++count;
  }
  return count > 0 ? std::sqrt(sum / count) : 0.0;
}

/// What a sensor adds looks, in contact alone, as if every layer were shifted: each by the constant
/// over its stiffness. One constant that brings all of them back to where the model has them is the
/// simpler reading.
void Selection::explain_shifts() {
  for (const Candidate& candidate : residual_.problem().candidates())
    if (candidate.facts.is_bias) explain_shifts_by(candidate.facts.id);
}

void Selection::explain_shifts_by(const std::string& bias) {
  const auto seen = screens_.find(bias);
  if (seen == screens_.end() || !seen->second.excited || contains(chosen().structure, bias)) return;
  int layers = 0;
  const double before_m = moved(chosen(), layers);
  if (layers < 2 || before_m < kSelection.shifted_m) return;
  Solution from = chosen();
  differentiate(residual_, from);
  const Solution& with = fitted(from, bias, 1);
  const double after_m = moved(with, layers);
  if (after_m < (layers == 2 ? kSelection.restored_of_two : kSelection.restored) * before_m &&
      with.mean_square() < kSelection.no_worse * from.mean_square())
    chosen_ = name(with.structure);
}

const Solution& Selection::leading() const {
  const auto price = [&](const auto& entry) { return cost(residual_, entry.second, base()); };
  return std::ranges::min_element(tried_, {}, price)->second;
}

bool Selection::run(const std::function<void()>& after_singles) {
  if (!go_on(0.0)) return false;
  tried_[""] = fit_base(residual_);
  singles();
  if (stopped_) return false;
  if (after_singles) after_singles();
  grow();
  if (stopped_) return false;
  for (const Solution* pair : best_of(2, kSelection.refined))
    for (const std::string& id : pair->structure.effects)
      part(Solution(*pair), minus(pair->structure, id));
  refine(1);
  for (const Solution* single : best_of(1, kSelection.refined))
    if (!told_from_zero(residual_, *single)) part(Solution(*single), {});
  choose();
  refuse_trends();
  require_free_air();
  require_lower_error();
  explain_shifts();
  // In which order they brought most: the best single of them first.
  Structure sum;
  for (std::size_t k = 0; k < chosen().structure.effects.size(); ++k) {
    std::string best;
    for (const std::string& id : chosen().structure.effects) {
      if (contains(sum, id)) continue;
      const std::string key = name(plus(sum, id));
      if (!tried_.contains(key)) {
        const Solution& at = chosen();
        const Structure part = plus(sum, id);
        tried_[key] =
            search(residual_, part, carried(residual_.problem().parameters(part), at), &at);
      }
      if (best.empty() ||
          tried_.at(key).mean_square() < tried_.at(name(plus(sum, best))).mean_square())
        best = id;
    }
    order_.push_back(best);
    sum = plus(sum, best);
  }
  return go_on(0.95);
}

}  // namespace lab
}  // namespace tractus
