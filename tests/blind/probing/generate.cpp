#include "probing/generate.hpp"

#include <algorithm>
#include <cmath>

#include "probing/judge.hpp"

namespace blind {
namespace {

constexpr std::size_t kJudgedStride = 200;  // fine steps between judged points: 10 ms

/// One trial with its forces at the fine step.
struct Worked {
  Series series;
  std::vector<double> torque_Nm, recorded_N;
  std::vector<std::vector<double>> added_N;  ///< per effect, last all together
};

std::vector<HiddenEffect> without(std::vector<HiddenEffect> effects, std::size_t which) {
  if (which == effects.size()) return {};
  effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(which));
  return effects;
}

/// The laws of a set: with every effect, with all but each one, with none. They live through all
/// trials.
struct Laws {
  explicit Laws(const SetPlan& plan)
      : full(plan.truth, plan.effects, plan.request.seed),
        loop(full_copy(plan)),
        sampled(full_copy(plan)) {
    for (std::size_t i = 0; i <= plan.effects.size() && !plan.effects.empty(); ++i)
      reduced.emplace_back(plan.truth, without(plan.effects, i), plan.request.seed);
  }
  static Physics full_copy(const SetPlan& plan) {
    return {plan.truth, plan.effects, plan.request.seed};
  }
  Physics full, loop, sampled;
  std::vector<Physics> reduced;
};

Worked work(const SetPlan& plan, std::size_t index, Laws& laws) {
  const TrialPlan& trial = plan.trials[index];
  const TrialContext context{static_cast<int>(index), trial.duration_s, plan.truth.end_m(),
                             trial.seed};
  Worked out;
  out.series = move(trial, laws.loop, context);
  out.torque_Nm = torque(out.series, plan.truth.rotary);
  const auto full = evaluate(out.series, laws.full, context);
  if (out.series.force_N.empty()) out.series.force_N = full;
  const auto full_recorded = as_recorded(full, out.torque_Nm, plan.effects, trial.seed);
  out.recorded_N = as_recorded(out.series.force_N, out.torque_Nm, plan.effects, trial.seed);
  for (std::size_t i = 0; i < laws.reduced.size(); ++i) {
    auto less = as_recorded(evaluate(out.series, laws.reduced[i], context), out.torque_Nm,
                            without(plan.effects, i), trial.seed);
    for (std::size_t k = 0; k < less.size(); ++k) less[k] = full_recorded[k] - less[k];
    out.added_N.push_back(std::move(less));
  }
  return out;
}

double sum_of_squares(const std::vector<double>& values) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); i += 20) sum += values[i] * values[i];
  return sum;
}

/// Share of the force that each effect makes over the first `trials`; the force's RMS last.
std::vector<double> strengths(const SetPlan& plan, std::size_t trials) {
  Laws laws(plan);
  std::vector<double> added(plan.effects.size(), 0.0);
  double force = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    const Worked trial = work(plan, i, laws);
    force += sum_of_squares(trial.recorded_N);
    count += (trial.recorded_N.size() + 19) / 20;
    for (std::size_t e = 0; e < added.size(); ++e) added[e] += sum_of_squares(trial.added_N[e]);
  }
  for (double& a : added) a = std::sqrt(a / force);
  added.push_back(std::sqrt(force / static_cast<double>(count)));
  return added;
}

/// Brings the base to 22–38 N of RMS, then each effect to its wanted share of the force.
void tune(SetPlan& plan) {
  Random random(plan.request.seed ^ 0xF0CE);
  const double wanted_N = random.uniform(22, 38);
  SetPlan bare = plan;
  bare.effects.clear();
  for (TrialPlan& trial : bare.trials)
    if (trial.mode == Mode::kHand) trial.mode = Mode::kPlayedHand;
  const std::size_t few = std::min<std::size_t>(4, plan.trials.size());
  for (int i = 0; i < 2; ++i) {
    const double factor = wanted_N / strengths(bare, few).back();
    scale_base(bare, factor);
    scale_base(plan, factor);
  }
  for (int i = 0; i < 7 && !plan.effects.empty(); ++i) {
    const auto now = strengths(plan, i < 4 ? few : plan.trials.size());
    for (std::size_t e = 0; e < plan.effects.size(); ++e) {
      const double ratio = plan.strengths[e] / std::max(1e-9, now[e]);
      const double factor = std::min(4.0, std::max(0.25, ratio));
      for (const auto& name : amplitudes_of(plan.effects[e].id))
        plan.effects[e].parameters[name] *= factor;
    }
  }
}

/// Squared errors of the true law on the sampled motion: what no reader of the file can beat.
struct Best {
  double all = 0, away = 0, count = 0, away_count = 0;
};

void read_perfectly(const SetPlan& plan, std::size_t index, const Worked& trial,
                    const Samples& samples, Laws& laws, Best& best) {
  constexpr std::size_t kNear = 10;  // samples about a change of layer that are counted apart
  const TrialPlan& how = plan.trials[index];
  const TrialContext context{static_cast<int>(index), how.duration_s, plan.truth.end_m(), how.seed};
  const Series motion = sampled_motion(trial.series, plan);
  const auto force =
      as_recorded(evaluate(motion, laws.sampled, context), torque(motion, plan.truth.rotary),
                  plan.effects, how.seed, 1.0 / plan.request.rate_Hz);
  std::vector<bool> near(force.size(), false);
  for (std::size_t i = 1; i < force.size(); ++i)
    if (plan.truth.at(motion.moments[i].x_m) != plan.truth.at(motion.moments[i - 1].x_m))
      for (std::size_t k = i - std::min(i, kNear); k < std::min(force.size(), i + kNear); ++k)
        near[k] = true;
  for (std::size_t i = 1; i + 1 < force.size(); ++i) {
    const double error = samples.force_N[i] - force[i];
    best.all += error * error;
    best.count += 1;
    if (near[i]) continue;
    best.away += error * error;
    best.away_count += 1;
  }
}

void judge(GeneratedSet& set, const std::vector<JudgedPoint>& points) {
  if (set.plan.effects.empty()) return;
  const auto left = projected_rms(points, set.plan);
  std::vector<double> sums(left.size(), 0.0);
  for (const JudgedPoint& p : points)
    for (std::size_t e = 0; e < sums.size(); ++e) sums[e] += p.added_N[e] * p.added_N[e];
  for (std::size_t e = 0; e < set.plan.effects.size(); ++e) {
    const double rms = std::sqrt(sums[e] / static_cast<double>(points.size()));
    set.outcomes.push_back({rms, rms / set.force_rms_N, left[e]});
  }
  set.hidden_projected_N = left.back();
}

GeneratedSet record(SetPlan plan) {
  GeneratedSet set;
  set.plan = std::move(plan);
  Laws laws(set.plan);
  std::vector<JudgedPoint> points;
  double force = 0, floor = 0;
  std::size_t count = 0;
  Best best;
  for (std::size_t i = 0; i < set.plan.trials.size(); ++i) {
    const Worked trial = work(set.plan, i, laws);
    set.trials.push_back(
        sample(trial.series, trial.recorded_N, trial.torque_Nm, set.plan, set.plan.trials[i].seed));
    read_perfectly(set.plan, i, trial, set.trials.back(), laws, best);
    const auto trials = static_cast<double>(set.plan.trials.size());
    floor += set.trials.back().floor_N * set.trials.back().floor_N / trials;
    set.stuck_share += trial.series.stuck_share / trials;
    for (std::size_t k = 0; k < trial.recorded_N.size(); k += kJudgedStride) {
      JudgedPoint point{trial.series.moments[k].x_m, trial.series.moments[k].v_m_s, {}};
      for (const auto& added : trial.added_N) point.added_N.push_back(added[k]);
      points.push_back(std::move(point));
      force += trial.recorded_N[k] * trial.recorded_N[k];
      ++count;
    }
  }
  set.force_rms_N = std::sqrt(force / static_cast<double>(count));
  set.floor_N = std::sqrt(floor);
  set.attainable_N = std::sqrt(best.all / best.count);
  set.attainable_away_N = std::sqrt(best.away / std::max(1.0, best.away_count));
  judge(set, points);
  return set;
}

/// Whether every effect came to a size that a rig can have, and every trial stayed where the layers
/// are.
bool acceptable(const GeneratedSet& set) {
  for (const HiddenEffect& effect : set.plan.effects)
    if (!plausible(effect)) return false;
  for (std::size_t i = 0; i < set.plan.effects.size(); ++i)
    if (set.outcomes[i].strength < 0.04 || set.outcomes[i].strength > 0.10) return false;
  const double end = set.plan.truth.end_m();
  for (std::size_t i = 0; i < set.trials.size(); ++i) {
    const auto [low, high] = std::ranges::minmax(set.trials[i].x_m);
    const bool air = set.plan.trials[i].air_s > 0;
    if (!(high < end - 1e-4) || !(low > (air ? -0.01 : 1e-4))) return false;
  }
  return true;
}

}  // namespace

GeneratedSet generate(const Request& request) {
  Request drawn = request;
  if (drawn.kind.empty()) {  // the kind stays what the first draw said
    const SetPlan first = draw_plan(request);
    drawn.kind = first.kind;
    for (const HiddenEffect& effect : first.effects) drawn.ids.push_back(effect.id);
  }
  GeneratedSet set;
  constexpr int kAttempts = 12;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    Request again = drawn;
    again.seed = request.seed + 1000003ULL * static_cast<std::uint64_t>(attempt);
    SetPlan plan = draw_plan(again);
    tune(plan);
    draw_supplied(plan);
    set = record(std::move(plan));
    set.accepted = acceptable(set);
    if (set.accepted) break;
  }
  set.plan.request.seed = request.seed;
  return set;
}

}  // namespace blind
