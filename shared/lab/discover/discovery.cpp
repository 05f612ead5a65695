#include "lab/discover/discovery.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "core/require.hpp"
#include "lab/discover/formula_effect.hpp"
#include "lab/identify/effect_screen.hpp"
#include "lab/identify/fit_report.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;

/// A structure with formulas, fitted in full.
struct FittedFormula {
  Solution solution;
  std::vector<std::string> ids;  // of its formulas
  std::size_t start = 0;         // which structure it stands on
  Evidence evidence = {};
  Fit fit = {};
};

/// A structure of the catalogue on top of which formulas are tried.
struct SearchStart {
  Solution at;
  const Fit* fit;
};

class FormulaSearch {
 public:
  FormulaSearch(const Problem& problem, const Diagnosis& diagnosis, const DiscoverOptions& options,
                const core::Progress& progress)
      : problem_(problem),
        diagnosis_(diagnosis),
        options_(options),
        progress_(progress),
        residual_(problem, options.threads) {}

  core::Result<Discovery> run();

 private:
  bool go_on(double share) {
    if (progress_ && !progress_(share)) stopped_ = true;
    return !stopped_;
  }
  const Residual& tried() const { return *tried_residual_; }
  void begin(const Fit& fit);
  std::vector<std::string> offered(const std::vector<ScreenedTerm>& ranked, std::size_t most);
  void offer();
  void singles();
  void seconds();
  bool refit(const Solution& from, const std::string& id, std::vector<std::string> ids,
             std::size_t start);
  void score();
  void report_best();
  bool lowers_the_error(const FittedFormula& one) const;
  double log_prior(const FittedFormula& one) const;
  double start_log_prior(const Structure& structure) const;
  Discovery answer();
  Proposal proposal_of(const FittedFormula& one, std::size_t number) const;
  int size_of(const FittedFormula& one) const;
  bool equals(const FittedFormula& simpler, const FittedFormula& one) const;
  std::vector<const FittedFormula*> front() const;
  double with_larger(const FittedFormula& one, std::span<const double> of_found) const;

  const Problem& problem_;
  const Diagnosis& diagnosis_;
  DiscoverOptions options_;
  const core::Progress& progress_;
  Residual residual_;
  std::vector<SearchStart> starts_;
  std::optional<FormulaScreen> screen_;             // on the first start
  std::vector<FormulaEffect> effects_;              // offered so far
  std::vector<std::unique_ptr<Problem>> problems_;  // with them
  std::optional<Residual> tried_residual_;
  std::vector<FittedFormula> found_;
  double correlation_ = 1.0;
  bool stopped_ = false;
};

void FormulaSearch::begin(const Fit& fit) {
  Solution at = search(residual_, fit.structure, fit.values, nullptr, {.max_iterations = 1});
  differentiate(residual_, at);
  starts_.push_back({std::move(at), &fit});
}

/// Makes the best terms effects; returns their ids, new or known.
std::vector<std::string> FormulaSearch::offered(const std::vector<ScreenedTerm>& ranked,
                                                std::size_t most) {
  std::vector<std::string> out;
  for (const ScreenedTerm& one : ranked) {
    if (out.size() == most) break;
    const Term& term = screen_->terms()[one.term];
    const auto known = std::ranges::find(effects_, term.family,
                                         [](const FormulaEffect& e) { return e.term.family; });
    if (known != effects_.end()) {
      out.push_back(known->id);
      continue;
    }
    effects_.push_back(formula_effect(fmt::format("expression:f{}", effects_.size()), term,
                                      screen_->factors(), one.amplitude));
    out.push_back(effects_.back().id);
  }
  return out;
}

/// The problem with all effects offered so far.
void FormulaSearch::offer() {
  std::vector<std::pair<effects::EffectInstance, effects::EffectFacts>> all;
  for (const FormulaEffect& e : effects_) all.emplace_back(e.use, e.facts);
  problems_.push_back(problem_.formula_terms()->with(UserEffects(std::move(all))));
  tried_residual_.emplace(*problems_.back(), options_.threads);
}

bool FormulaSearch::refit(const Solution& from, const std::string& id, std::vector<std::string> ids,
                          std::size_t start) {
  const LinearScreen screened = linear_screen(tried(), from, id);
  if (!screened.excited) return false;
  Solution at = extend(tried(), from, screened, id, 1);
  found_.push_back({std::move(at), std::move(ids), start});
  return true;
}

void FormulaSearch::singles() {
  std::vector<std::vector<std::string>> ids;
  for (const SearchStart& start : starts_) {
    const double correlation = correlation_of(screen_->residuals_of(residual_, start.at));
    ids.push_back(offered(screen_->ranked(residual_, start.at, correlation),
                          kDiscovery.refitted / starts_.size()));
  }
  offer();
  for (std::size_t s = 0; s < starts_.size(); ++s)
    for (const std::string& id : ids[s]) {
      if (!go_on(0.3 + 0.3 * double(found_.size()) / double(kDiscovery.refitted))) return;
      refit(starts_[s].at, id, {id}, s);
    }
}

/// Every score with the same count of independent observations: that of the best formula's residual.
void FormulaSearch::score() {
  correlation_ = correlation_of(screen_->residuals_of(residual_, starts_.front().at));
  for (int round = 0; round < 2; ++round) {
    for (FittedFormula& one : found_)
      one.evidence = screen_->evidence_of(tried(), one.solution, correlation_);
    std::ranges::stable_sort(found_, std::greater<>(), [&](const FittedFormula& f) {
      return f.evidence.total + log_prior(f);
    });
    if (!found_.empty())
      correlation_ = correlation_of(screen_->residuals_of(tried(), found_.front().solution));
  }
}

/// A second term on the best single ones.
void FormulaSearch::seconds() {
  if (found_.empty() || found_.front().evidence.mean_square < kDiscovery.enough) return;
  std::vector<FittedFormula> from(
      found_.begin(),
      found_.begin() + std::ptrdiff_t(std::min(kDiscovery.extended, found_.size())));
  std::vector<std::vector<std::string>> ids;
  for (FittedFormula& one : from) {
    differentiate(tried(), one.solution);
    ids.push_back(
        offered(screen_->ranked(tried(), one.solution, correlation_), kDiscovery.second_terms));
  }
  offer();
  for (std::size_t k = 0; k < from.size(); ++k)
    for (const std::string& id : ids[k]) {
      if (!go_on(0.6 + 0.05 * double(k))) return;
      if (contains(from[k].solution.structure, id)) continue;
      const Structure both = plus(from[k].solution.structure, id);
      const auto same = [&](const FittedFormula& f) { return f.solution.structure == both; };
      if (std::ranges::any_of(found_, same)) continue;
      refit(from[k].solution, id, {from[k].ids.front(), id}, from[k].start);
    }
}

/// Held-out errors of the best.
void FormulaSearch::report_best() {
  if (found_.size() > options_.most + kDiscovery.spare)
    found_.resize(options_.most + kDiscovery.spare);
  for (FittedFormula& one : found_) {
    if (!go_on(0.9)) return;
    one.fit = report(tried(), one.solution, true);
  }
  std::erase_if(found_, [&](const FittedFormula& one) { return !lowers_the_error(one); });
}

int trials_improved(const Fit& with, const Fit& without) {
  int out = 0;
  for (std::size_t k = 0; k < with.trials.size(); ++k)
    out += with.trials[k].held_out_rmse < without.trials[k].held_out_rmse;
  return out;
}

/// Weights of a robust fit may hide what a term makes worse: each must lower the error without
/// weights on held-out trials, in nearly all of them; two must do so against each alone.
bool FormulaSearch::lowers_the_error(const FittedFormula& one) const {
  const auto better = [&](const Fit& than) {
    return one.fit.held_out_rmse < (1.0 - kSettings.selection.least_fall) * than.held_out_rmse &&
           trials_improved(one.fit, than) >=
               kDiscovery.least_trials * double(one.fit.trials.size());
  };
  if (!better(*starts_[one.start].fit)) return false;
  if (one.ids.size() == 1) return true;
  return std::ranges::all_of(found_, [&](const FittedFormula& part) {
    return part.ids.size() != 1 || part.start != one.start || part.fit.trials.empty() ||
           std::ranges::find(one.ids, part.ids.front()) == one.ids.end() || better(part.fit);
  });
}

/// One over the structures of its size; and what is free in each trial, which a held-out trial was
/// fitted with, pays for each number as Schwarz's criterion does [Schwarz1978].
double FormulaSearch::start_log_prior(const Structure& structure) const {
  const double rows = double(residual_.size()) / residual_.trials() / correlation_;
  return -double(structure.effects.size()) * std::log(double(problem_.candidates().size())) -
         0.5 * problem_.free_per_trial(structure) * residual_.trials() *
             std::log(std::max(2.0, rows));
}

double FormulaSearch::log_prior(const FittedFormula& one) const {
  const double families = double(screen_->families());
  return start_log_prior(starts_[one.start].at.structure) -
         double(one.ids.size()) * std::log(families) + std::log(double(one.ids.size()));
}

/// Factors and numbers, those of the catalogue's effects beside it among them.
int FormulaSearch::size_of(const FittedFormula& one) const {
  const auto count = [](const Solution& at) {
    return int(at.structure.effects.size() + at.values.size());
  };
  int out = count(one.solution) - count(starts_.front().at);
  for (const std::string& id : one.ids)
    out += int(std::ranges::find(effects_, id, &FormulaEffect::id)->term.factors.size()) - 1;
  return out;
}

/// Does a simpler one as well as this one, but for what is not material?
bool FormulaSearch::equals(const FittedFormula& simpler, const FittedFormula& one) const {
  return size_of(simpler) < size_of(one) &&
         simpler.fit.held_out_rmse < (1.0 + kSettings.selection.least_fall) * one.fit.held_out_rmse;
}

/// Those that no simpler one equals.
std::vector<const FittedFormula*> FormulaSearch::front() const {
  std::vector<const FittedFormula*> out;
  for (const FittedFormula& one : found_)
    if (std::ranges::none_of(found_,
                             [&](const FittedFormula& other) { return equals(other, one); }))
      out.push_back(&one);
  return out;
}

/// A formula's own probability, and that of larger ones that hold it and add nothing material.
double FormulaSearch::with_larger(const FittedFormula& one,
                                  std::span<const double> of_found) const {
  double out = 0.0;
  for (std::size_t k = 0; k < found_.size(); ++k) {
    const auto& theirs = found_[k].solution.structure.effects;
    const auto& mine = one.solution.structure.effects;
    const bool holds = std::ranges::includes(theirs, mine);
    if (&found_[k] == &one || (holds && equals(one, found_[k]))) out += of_found[k];
  }
  return out;
}

Proposal FormulaSearch::proposal_of(const FittedFormula& one, std::size_t number) const {
  Proposal out;
  for (std::size_t k = 0; k < one.ids.size(); ++k) {
    const auto& effect = *std::ranges::find(effects_, one.ids[k], &FormulaEffect::id);
    std::string id = fmt::format("expression:proposal_{}", number);
    if (one.ids.size() > 1) id += char('a' + k);
    out.terms.push_back(proposed_term(effect, screen_->factors(), one.fit, id));
  }
  for (const std::string& id : starts_[one.start].at.structure.effects) out.beside.push_back(id);
  out.rmse = one.fit.rmse;
  out.held_out_rmse = one.fit.held_out_rmse;
  out.trials = int(one.fit.trials.size());
  out.trials_improved = trials_improved(one.fit, *starts_[one.start].fit);
  out.size = size_of(one);
  const auto work = tried().problem().formula_terms()->work_of_cycles(one.solution.structure,
                                                                      one.solution.values);
  out.passive = work.taken_J >= -kDiscovery.active_share * work.turned_over_J;
  return out;
}

Discovery FormulaSearch::answer() {
  Discovery out;
  out.formulas_tried = screen_->terms().size();
  out.base_held_out_rmse = diagnosis_.base.held_out_rmse;
  out.noise_floor = diagnosis_.base.noise_floor;
  auto unknown = unknown_functions(residual_, starts_.front().at, *screen_, correlation_);
  // Nothing, the catalogue's answer, functions without a formula, formulas.
  std::vector<Eigen::VectorXd> scores;
  std::vector<double> prior;
  for (const SearchStart& start : starts_) {
    scores.push_back(screen_->evidence_of(residual_, start.at, correlation_).log_score);
    prior.push_back(start_log_prior(start.at.structure));
  }
  for (const UnknownFunction& f : unknown) {
    scores.push_back(f.evidence.log_score);
    prior.push_back(-std::log(double(unknown.size())));
  }
  const std::size_t formulas = scores.size();
  for (const FittedFormula& one : found_) {
    scores.push_back(one.evidence.log_score);
    prior.push_back(log_prior(one));
  }
  const auto probability = stacked_probabilities(scores, prior);
  const auto best = share_of_best(scores, prior);
  if (starts_.size() > 1) out.catalogue_probability = probability[1];
  for (std::size_t k = 0; k < unknown.size(); ++k)
    out.unknown_probability += probability[starts_.size() + k];
  if (!unknown.empty()) out.unknown = std::move(unknown.front());
  for (const FittedFormula* one : front()) {
    Proposal proposal = proposal_of(*one, out.proposals.size() + 1);
    proposal.probability = with_larger(*one, std::span(probability).subspan(formulas));
    proposal.stability = with_larger(*one, std::span(best).subspan(formulas));
    if (out.unknown_probability > 0.5 ||
        proposal.held_out_rmse > kDiscovery.far_from_floor * out.noise_floor)
      proposal.probability = std::min(proposal.probability, kDiscovery.most_if_far);
    out.proposals.push_back(std::move(proposal));
    if (out.proposals.size() == options_.most) break;
  }
  if (out.proposals.empty())
    out.remark = "no formula lowers the error on nearly all held-out trials";
  return out;
}

core::Result<Discovery> FormulaSearch::run() {
  begin(diagnosis_.base_fit);
  if (!diagnosis_.final_fit.structure.effects.empty()) begin(diagnosis_.final_fit);
  if (!go_on(0.05)) return Error{Errc::cancelled, "stopped"};
  screen_.emplace(residual_, starts_.front().at);
  singles();
  if (!stopped_) score();
  if (!stopped_) seconds();
  if (!stopped_) score();
  if (!stopped_) report_best();  // which differentiates anew
  if (!stopped_) score();
  if (stopped_) return Error{Errc::cancelled, "stopped"};
  return answer();
}

}  // namespace

core::Result<Discovery> discover(const Problem& problem, const Diagnosis& diagnosis,
                                 const DiscoverOptions& options, const core::Progress& progress) {
  Discovery none;
  none.base_held_out_rmse = diagnosis.base.held_out_rmse;
  none.noise_floor = diagnosis.base.noise_floor;
  if (!problem.formula_terms())
    none.remark = "formulas are searched for in recordings of a probe that slides";
  else if (diagnosis.verdict == Verdict::complete)
    none.remark = "nothing is missing, so that no formula was searched for";
  else if (diagnosis.verdict == Verdict::undecided)
    none.remark =
        "these recordings cannot tell whether anything is missing, so that no formula was searched "
        "for";
  if (!none.remark.empty()) return none;
  return FormulaSearch(problem, diagnosis, options, progress).run();
}

}  // namespace lab
}  // namespace tractus
