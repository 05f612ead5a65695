#include "lab/rigs/probing/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/require.hpp"
#include "effects/delayed.hpp"
#include "effects/expression.hpp"
#include "lab/identify/fit_report.hpp"
#include "lab/identify/least_squares.hpp"
#include "lab/identify/parallel.hpp"
#include "lab/rigs/probing/parameter_space.hpp"
#include "lab/rigs/probing/recording.hpp"
#include "lab/rigs/probing/statistics.hpp"
#include "lab/settings.hpp"
#include "lab/signal/drift.hpp"
#include "models/probing_runtime.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;

class ProbingProblem final : public Problem, public FormulaTerms {
 public:
  ProbingProblem(ProbingParameterSpace numbers, std::vector<ProbingRecording> trials, bool turns)
      : numbers_(std::move(numbers)), trials_(std::move(trials)), turns_(turns) {
    for (const auto& r : trials_) drifts_.push_back(drift_of(r));
    set_candidates();
    set_channels();
    notes_ = numbers_.notes();
  }

  std::string_view rig() const override { return "probing"; }
  int trials() const override { return int(trials_.size()); }
  std::string trial_id(int k) const override { return trial(k).id; }
  double seconds(int k) const override { return trial(k).seconds(); }
  const std::vector<Channel>& channels() const override { return channels_; }
  const std::vector<Candidate>& candidates() const override { return candidates_; }
  const std::vector<std::string>& notes() const override { return notes_; }
  std::vector<Parameter> parameters(const Structure& structure) const override {
    return numbers_.parameters(structure);
  }
  effects::Starts starts(std::string_view effect, const Eigen::VectorXd& residual) const override;

  const SelectionThresholds& selection_thresholds() const override {
    return kSettings.probing_thresholds;
  }
  Eigen::Index residual_size(int k) const override {
    return Eigen::Index(trial(k).measured_thin.size());
  }
  void residuals(const Structure& structure, std::span<const double> values, int k,
                 Eigen::Ref<Eigen::VectorXd> out) const override {
    raw_residuals(structure, values, k, out);
    if (!has_drift(structure)) return;
    const Eigen::VectorXd before = out;
    drifts_[std::size_t(k)].remove(out);
    out = (before.array() == 0.0).select(0.0, out);
  }
  int free_per_trial(const Structure& structure) const override {
    return has_drift(structure) ? Drift::kOrders : 0;
  }

  double noise_floor(const Structure& structure, std::span<const double> values) const override;
  Residuals full_rate(const Structure& structure, std::span<const double> values,
                      int k) const override;
  States states(int k) const override;
  std::vector<Derived> derived(const Structure& structure, std::span<const double> values,
                               std::string_view effect) const override;
  core::Json model(const Structure& structure, std::span<const double> values) const override;

  const FormulaTerms* formula_terms() const override { return turns_ ? nullptr : this; }
  const effects::ExpressionRig& expressions() const override {
    return effects::probing_expressions();
  }
  FormulaSignals signals(const Structure& structure, std::span<const double> values,
                         int k) const override;
  void response(const Structure& structure, int k, std::span<const double> added,
                Eigen::Ref<Eigen::VectorXd> out) const override;
  std::vector<bool> moving(int k) const override;
  Work work_of_cycles(const Structure& structure, std::span<const double> values) const override;
  std::unique_ptr<Problem> with(UserEffects more) const override {
    auto out = std::make_unique<ProbingProblem>(*this);
    out->numbers_.add(more);
    out->candidates_.clear();
    out->set_candidates();
    return out;
  }

  void note(std::string words) { notes_.push_back(std::move(words)); }

  /// Where the recordings' force lies in time against the motion if the given model is right, as every search's start.
  void estimate_delay(int threads);
  /// Estimates the sensors' noise anew from what the base with these values leaves.
  void estimate_noise(std::span<const double> values);

  /// Weighs the residuals anew with the borders and dampings that these values have.
  void focus(std::span<const double> values) {
    if (turns_) return;
    const auto law = numbers_.with({}, values).law(kProbingRecording.longest_model_m);
    core::require(bool(law), "a fitted model runs");
    for (std::size_t k = 0; k < trials_.size(); ++k) {
      weigh(*law, trials_[k]);
      drifts_[k] = drift_of(trials_[k]);
    }
    set_channels();
    floor_of_bone_ = channels_.front().noise_floor;
    channels_.front().noise_floor =
        std::hypot(floor_of_bone_, floor_of_effects(numbers_.with({}, values)));
  }

 private:
  bool has_drift(const Structure& structure) const { return !numbers_.drift(structure).empty(); }
  const ProbingRecording& trial(int k) const { return trials_[std::size_t(k)]; }
  static Drift drift_of(const ProbingRecording& r);
  void set_candidates();
  void set_channels();

  /// What the law says, and by how much dry friction at rest may differ from it.
  struct Predicted {
    models::ProbingForces forces;
    std::vector<double> at_rest_N;  // (or N·m) one per sample of `rest`; empty without dry friction
  };
  double floor_of_effects(const models::ProbingModel& model) const;
  std::vector<double> dry_at_rest(const models::ProbingModel& model,
                                  const ProbingRecording& r) const;
  Predicted forces(const Structure& structure, std::span<const double> values,
                   const ProbingRecording& r) const {
    const models::ProbingModel model = numbers_.with(structure, values);
    const auto runtime = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
    core::require(bool(runtime), "values within their bounds make a model that runs");
    Predicted out;
    runtime->predict(r.motion, out.forces);
    effects::delay(r.motion.t_s, numbers_.force_delay_s(structure, values), out.forces.fz_N);
    out.at_rest_N = dry_at_rest(model, r);
    for (std::size_t i = 0; i < out.at_rest_N.size(); ++i) {  // the middle of what it may be
      const std::size_t k = r.rest[i];
      if (turns_)
        out.forces.tz_Nm[k] -=
            out.at_rest_N[i] * effects::direction(r.motion.omega_rad_s[k], r.motion.rest_rad_s);
      else
        out.forces.fz_N[k] -=
            out.at_rest_N[i] * effects::direction(r.motion.v_m_s[k], r.motion.rest_m_s);
    }
    return out;
  }
  void raw_residuals(const Structure& structure, std::span<const double> values, int k,
                     Eigen::Ref<Eigen::VectorXd> out) const {
    const ProbingRecording& r = trial(k);
    const auto predicted = forces(structure, values, r);
    std::vector<double> thin(r.measured_thin.size());
    r.decimator.apply(turns_ ? predicted.forces.tz_Nm : predicted.forces.fz_N, thin);
    std::vector<double> either_way(thin.size(), 0.0);
    if (!predicted.at_rest_N.empty())
      r.decimator.apply_sizes(r.rest, predicted.at_rest_N, either_way);
    for (std::size_t j = 0; j < thin.size(); ++j)
      out(Eigen::Index(j)) = beyond(r.measured_thin[j] - thin[j], either_way[j]) / r.sd_thin[j];
  }
  /// The fitted trend of a trial at its full rate, N.
  Eigen::VectorXd drift(const Structure& structure, std::span<const double> values, int k) const {
    Eigen::VectorXd residual(residual_size(k));
    raw_residuals(structure, values, k, residual);
    const Drift& d = drifts_[std::size_t(k)];
    return d.at(trial(k).motion.t_s, d.fit(residual));
  }

  ProbingParameterSpace numbers_;
  std::vector<ProbingRecording> trials_;
  std::vector<Drift> drifts_;
  std::vector<Candidate> candidates_;
  std::vector<Channel> channels_;
  std::vector<std::string> notes_;
  bool turns_;
  double floor_of_bone_ =
      0.0;  // the primary's noise floor without what effects make of the motion's errors
};

void ProbingProblem::estimate_delay(int threads) {
  const auto parameters = numbers_.parameters({});
  const auto delay = std::ranges::find_if(
      parameters, [](const Parameter& p) { return p.pointer.starts_with("/sensor/"); });
  if (delay == parameters.end()) return;
  std::vector<double> values;
  for (const Parameter& p : parameters) values.push_back(p.start);
  const Residual residual(*this, threads);
  const double scale = robust_scale(residual({}, values));
  double& delay_s = values[std::size_t(delay - parameters.begin())];
  const auto loss = [&](double at_s) {
    delay_s = at_s;
    const double away = at_s / delay->prior_sd;
    return robust_loss(residual({}, values), scale) + away * away;
  };
  double best_s = 0.0, least = loss(0.0);
  for (double step_s = 0.5 * delay->high; step_s > 0.02 * delay->high; step_s *= 0.5)
    for (const double at_s : {best_s - step_s, best_s + step_s})
      if (at_s >= delay->low && at_s <= delay->high)
        if (const double now = loss(at_s); now < least) least = now, best_s = at_s;
  numbers_.begin_at_delay(best_s);
}

void ProbingProblem::estimate_noise(std::span<const double> values) {
  if (turns_) return;
  for (std::size_t k = 0; k < trials_.size(); ++k) {
    ProbingRecording& r = trials_[k];
    const auto full = full_rate({}, values, int(k)).channels.front();
    std::vector<double> thin(r.measured_thin.size());
    r.decimator.apply(full, thin);
    lab::estimate_noise(r, full, thin);
  }
}

/// What the motion's errors make of a model's effects, root mean square over the judged samples: the speed's, then the
/// acceleration's standard error is added to one sample and taken from the next, and what the prediction differs by,
/// beyond that of the bone alone, adds in squares.
double ProbingProblem::floor_of_effects(const models::ProbingModel& model) const {
  if (turns_ || model.effects.empty()) return 0.0;
  models::ProbingModel bone = model;
  bone.effects.clear();
  const auto runtime = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m),
             of_bone = models::ProbingRuntime::make(bone, kProbingRecording.longest_model_m);
  core::require(runtime && of_bone, "values within their bounds make a model that runs");
  const auto difference = [](const models::ProbingRuntime& of, const effects::ProbingMotion& a,
                             const effects::ProbingMotion& b) {
    models::ProbingForces there, here;
    of.predict(a, there);
    of.predict(b, here);
    for (std::size_t k = 0; k < there.fz_N.size(); ++k) there.fz_N[k] -= here.fz_N[k];
    return there.fz_N;
  };
  double sum = 0.0, count = 0.0;
  for (const ProbingRecording& r : trials_) {
    std::vector<double> variance(r.size(), 0.0);
    const auto move = [&](auto member, const std::vector<double>& sd) {
      effects::ProbingMotion motion = r.motion;
      for (std::size_t k = 0; k < sd.size(); ++k)
        (motion.*member)[k] += k % 2 == 0 ? sd[k] : -sd[k];
      const auto all = difference(*runtime, motion, r.motion),
                 own = difference(*of_bone, motion, r.motion);
      for (std::size_t k = 0; k < variance.size(); ++k)
        variance[k] += std::max(0.0, all[k] * all[k] - own[k] * own[k]);
    };
    move(&effects::ProbingMotion::v_m_s, r.v_sd_m_s);
    move(&effects::ProbingMotion::a_m_s2, r.a_sd_m_s2);
    for (std::size_t k = 0; k < r.size(); ++k)
      if (r.judgement[k] == Judgement::judged) sum += variance[k], count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double ProbingProblem::noise_floor(const Structure& structure,
                                   std::span<const double> values) const {
  if (structure.effects.empty()) return channels_.front().noise_floor;
  return std::hypot(floor_of_bone_, floor_of_effects(numbers_.with(structure, values)));
}

/// At rest dry friction takes whatever value within its size holds the probe (Coulomb's law is
/// set-valued there), so a residual counts from there on.
std::vector<double> ProbingProblem::dry_at_rest(const models::ProbingModel& model,
                                                const ProbingRecording& r) const {
  models::ProbingModel dry;
  dry.rotary.viscous_Nms_per_rad = dry.rotary.detent_Nm = 0.0;
  for (const effects::EffectInstance& use : model.effects)
    if (numbers_.facts_of(use.id).is_dry) dry.effects.push_back(use);
  if (dry.effects.empty() || r.rest.empty()) return {};
  const auto runtime = models::ProbingRuntime::make(dry, kProbingRecording.longest_model_m);
  core::require(bool(runtime), "values within their bounds make a model that runs");
  effects::ProbingMotion back = r.at_rest;
  for (double& v : back.v_m_s) v = -v;
  for (double& omega : back.omega_rad_s) omega = -omega;
  models::ProbingForces in, out;
  runtime->predict(r.at_rest, in);
  runtime->predict(back, out);
  // A rig that only turns has an angle at rest, one that slides has not.
  std::vector<double>& size = in.tz_Nm.empty() ? in.fz_N : in.tz_Nm;
  const std::vector<double>& other = in.tz_Nm.empty() ? out.fz_N : out.tz_Nm;
  for (std::size_t k = 0; k < size.size(); ++k) size[k] = 0.5 * std::abs(size[k] - other[k]);
  return size;
}

Drift ProbingProblem::drift_of(const ProbingRecording& r) {
  std::vector<double> t_s;
  for (std::size_t j = 0; j < r.measured_thin.size(); ++j)
    t_s.push_back(r.motion.t_s[r.decimator.middle(j)]);
  return Drift(t_s, r.sd_thin);
}

void ProbingProblem::set_candidates() {
  const auto every = [&](auto member) {
    return std::ranges::none_of(trials_, [&](const auto& r) { return (r.motion.*member).empty(); });
  };
  const bool angle = every(&effects::ProbingMotion::omega_rad_s),
             torque = every(&effects::ProbingMotion::tz_Nm);
  std::vector<effects::EffectFacts> all;
  for (const auto& info : effects::probing_effects()) all.push_back(info.facts);
  for (const auto& [use, facts] : numbers_.user_effects().all()) all.push_back(facts);
  for (const effects::EffectFacts& facts : all) {
    // The torque is judged where the rig only turns, the force everywhere else.
    const bool shows = (facts.channel == effects::Channel::torque) == turns_;
    if (numbers_.has(facts.id) || (!turns_ && !shows)) continue;
    Candidate candidate{facts, true, ""};
    const auto lacks = [&](const std::string& why) {
      candidate.possible = false;
      candidate.why_not = why;
    };
    if (!shows) lacks("depth and force were not recorded");
    for (const std::string& need : facts.needs) {
      if (!angle && (need == "omega_rad_s" || need == "theta_rad"))
        lacks("theta_rad was not recorded in every trial");
      if (!torque && need == "tz_Nm") lacks("tz_Nm was not recorded in every trial");
    }
    candidates_.push_back(std::move(candidate));
  }
}

void ProbingProblem::set_channels() {
  double sum = 0.0, count = 0.0, other = 0.0;
  bool both = true;
  for (const auto& r : trials_) {
    sum += r.floor * r.floor * double(r.size());
    other += r.other_noise_sd * r.other_noise_sd * double(r.size());
    count += double(r.size());
    both = both && !r.other.empty() && !r.motion.theta_rad.empty();
  }
  channels_ = {{turns_ ? "tz_Nm" : "fz_N", std::sqrt(sum / count)}};
  if (both) channels_.push_back({"tz_Nm", std::sqrt(other / count)});
}

effects::Starts ProbingProblem::starts(std::string_view effect,
                                       const Eigen::VectorXd& residual) const {
  const auto* info = effects::find_probing_effect(effect);
  effects::Starts found;
  if (info && info->starts) found = info->starts(statistics_of(trials_, residual));
  return found.empty() ? ParameterSpace::starts(effect, residual) : found;
}

Residuals ProbingProblem::full_rate(const Structure& structure, std::span<const double> values,
                                    int k) const {
  const ProbingRecording& r = trial(k);
  const auto predicted = forces(structure, values, r);
  const auto minus = [](const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> out(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) out[i] = a[i] - b[i];
    return out;
  };
  Residuals out{r.motion.t_s,
                {minus(r.measured, turns_ ? predicted.forces.tz_Nm : predicted.forces.fz_N)},
                r.judgement};
  if (has_drift(structure)) {
    const Eigen::VectorXd trend = drift(structure, values, k);
    for (std::size_t i = 0; i < r.size(); ++i) out.channels[0][i] -= trend(Eigen::Index(i));
  }
  for (std::size_t i = 0; i < predicted.at_rest_N.size(); ++i) {
    double& residual = out.channels[0][r.rest[i]];
    residual = beyond(residual, predicted.at_rest_N[i]);
    if (residual == 0.0) out.judgement[r.rest[i]] = Judgement::standstill;
  }
  if (channels_.size() > 1) out.channels.push_back(minus(r.other, predicted.forces.tz_Nm));
  return out;
}

States ProbingProblem::states(int k) const {
  const effects::ProbingMotion& m = trial(k).motion;
  States out{{"time_s"}, {{}}};
  for (const double t : m.t_s) out.values[0].push_back(t - m.t_s.front());
  const auto add = [&](const char* name, const std::vector<double>& values) {
    if (values.empty()) return;
    out.names.emplace_back(name);
    out.values.push_back(values);
  };
  if (!turns_) {
    add("depth_m", m.x_m);
    add("velocity_m_s", m.v_m_s);
    add("acceleration_m_s2", m.a_m_s2);
  }
  add("theta_rad", m.theta_rad);
  add("omega_rad_s", m.omega_rad_s);
  if (!turns_) add("tz_Nm", m.tz_Nm);
  return out;
}

std::vector<Derived> ProbingProblem::derived(const Structure& structure,
                                             std::span<const double> values,
                                             std::string_view effect) const {
  if (effect.empty() || effect != numbers_.drift(structure)) return {};
  double sum = 0.0, variance = 0.0;
  for (int k = 0; k < trials(); ++k) {
    const Eigen::VectorXd trend = drift(structure, values, k);
    const auto& t_s = trial(k).motion.t_s;
    Eigen::Index high = 0, low = 0;
    sum += trend.maxCoeff(&high) - trend.minCoeff(&low);
    variance +=
        drifts_[std::size_t(k)].variance_between(t_s[std::size_t(high)], t_s[std::size_t(low)]);
  }
  const double n = trials();
  return {{numbers_.facts_of(effect).params.front().name, sum / n, std::sqrt(variance) / n}};
}

/// The resistance of the bone over a motion, N, as a formula is told it.
std::vector<double> resistance_N(models::ProbingModel model, const effects::ProbingMotion& motion) {
  std::erase_if(model.effects, [](const effects::EffectInstance& use) {
    const auto* info = effects::find_probing_effect(use.id);
    return !info || info->facts.kind == effects::Kind::measurement;
  });
  const auto without = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
  const auto base = effects::Expression::from_json(
      {{"format", effects::kEffectFormat},
       {"id", "expression:base"},
       {"rig", "probing"},
       {"adds_to", "fz_N"},
       {"formula", "c * base_N"},
       {"parameters", {{"c", {{"unit", "1"}, {"initial", 1}, {"low", 0}, {"high", 2}}}}}},
      "", effects::probing_expressions());
  core::require(bool(base), "a formula of one product is right");
  model.effects.push_back(base->use());
  const auto with = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
  core::require(without && with, "values within their bounds make a model that runs");
  models::ProbingForces once, twice;
  without->predict(motion, once);
  with->predict(motion, twice);
  for (std::size_t k = 0; k < once.fz_N.size(); ++k) twice.fz_N[k] -= once.fz_N[k];
  return std::move(twice.fz_N);
}

FormulaSignals ProbingProblem::signals(const Structure& structure, std::span<const double> values,
                                       int k) const {
  const effects::ProbingMotion& m = trial(k).motion;
  FormulaSignals out;
  out.states = {
      m.x_m,         m.v_m_s, m.a_m_s2, m.theta_rad,
      m.omega_rad_s, m.t_s,   m.tz_Nm,  resistance_N(numbers_.with(structure, values), m)};
  for (double& v : out.states[1])
    if (std::abs(v) <= m.rest_m_s) v = 0.0;
  for (std::size_t i = 0; i < m.size(); ++i)
    out.steps.push_back({i == 0 ? 0.0 : m.t_s[i] - m.t_s[i - 1], m.rest_m_s});
  return out;
}

void ProbingProblem::response(const Structure& structure, int k, std::span<const double> added,
                              Eigen::Ref<Eigen::VectorXd> out) const {
  const ProbingRecording& r = trial(k);
  r.decimator.apply(added, std::span(out.data(), std::size_t(out.size())));
  for (Eigen::Index j = 0; j < out.size(); ++j) out(j) /= -r.sd_thin[std::size_t(j)];
  if (has_drift(structure)) drifts_[std::size_t(k)].remove(out);
}

std::vector<bool> ProbingProblem::moving(int k) const {
  const ProbingRecording& r = trial(k);
  std::vector<double> share(r.measured_thin.size());
  const std::vector<double> one(r.rest.size(), 1.0);
  r.decimator.apply_sizes(r.rest, one, share);
  std::vector<bool> out;
  for (const double s : share) out.push_back(s < kProbingRecording.least_moving_rest);
  return out;
}

bool contains_id(const Structure& structure, const std::string& id) {
  return std::ranges::find(structure.effects, id) != structure.effects.end();
}

FormulaTerms::Work ProbingProblem::work_of_cycles(const Structure& structure,
                                                  std::span<const double> values) const {
  models::ProbingModel model = numbers_.with(structure, values), base = model;
  std::erase_if(base.effects, [&](const effects::EffectInstance& use) {
    return effects::is_expression(use.id) && contains_id(structure, use.id);
  });
  const auto with = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
  const auto without = models::ProbingRuntime::make(base, kProbingRecording.longest_model_m);
  core::require(with && without, "values within their bounds make a model that runs");
  double least_m = 1e9, most_m = -1e9, fastest_m_s = 1e-4;
  for (const ProbingRecording& r : trials_) {
    const auto [a, b] = std::ranges::minmax(r.motion.x_m);
    least_m = std::min(least_m, a), most_m = std::max(most_m, b);
    for (const double v : r.motion.v_m_s) fastest_m_s = std::max(fastest_m_s, std::abs(v));
  }
  const double half_m = 0.5 * (most_m - least_m), middle_m = 0.5 * (most_m + least_m);
  constexpr int kSamples = 4000;  // of a cycle
  Work out{std::numeric_limits<double>::infinity(), 0.0};
  for (const double share : {0.1, 0.8}) {
    const double w = share * fastest_m_s / half_m;
    effects::ProbingMotion m{.rest_m_s = 0.0};
    for (int i = 0; i <= 3 * kSamples; ++i) {
      const double t = 2.0 * std::numbers::pi * i / kSamples / w;
      m.t_s.push_back(t);
      m.x_m.push_back(middle_m - half_m * std::cos(w * t));
      m.v_m_s.push_back(half_m * w * std::sin(w * t));
      m.a_m_s2.push_back(half_m * w * w * std::cos(w * t));
    }
    models::ProbingForces all, own;
    with->predict(m, all);
    without->predict(m, own);
    double taken_J = 0.0, turned_J = 0.0;
    for (std::size_t i = 2 * kSamples + 1; i < m.size(); ++i) {
      const double mean_N = 0.5 * (all.fz_N[i] + all.fz_N[i - 1] - own.fz_N[i] - own.fz_N[i - 1]);
      const double step_J = mean_N * (m.x_m[i] - m.x_m[i - 1]);
      taken_J += step_J, turned_J += std::abs(step_J);
    }
    if (taken_J < out.taken_J) out = {taken_J, turned_J};
  }
  return out;
}

core::Json ProbingProblem::model(const Structure& structure, std::span<const double> values) const {
  models::ProbingModel model = numbers_.with(structure, values);
  const std::string drift = numbers_.drift(structure);
  for (const Derived& range : derived(structure, values, drift))
    model.effects.push_back({drift, {range.value}});
  return model.to_json();
}

/// Cuts the ends of the trials of a set that is longer than it need be; says so.
std::string shorten(trial::ProbingSet& set) {
  std::size_t total = 0;
  for (const auto& t : set.trials) total += t.t_s.size();
  if (total <= kProbingRecording.most_samples) return {};
  const double share = double(kProbingRecording.most_samples) / double(total);
  for (auto& t : set.trials) {
    const auto kept = std::min(t.t_s.size(), kProbingRecording.least_kept_samples +
                                                 std::size_t(share * double(t.t_s.size())));
    for (auto* all : {&t.t_s, &t.x_m, &t.theta_rad, &t.fz_N, &t.tz_Nm}) {
      if (all->empty()) continue;
      all->resize(kept);
      all->shrink_to_fit();
    }
  }
  return fmt::format(
      "{} samples are more than are needed: the first {:.3g} % of each trial were used", total,
      100.0 * share);
}

}  // namespace

Result<std::unique_ptr<Problem>> make_probing_problem(const models::ProbingModel& model,
                                                      trial::ProbingSet set,
                                                      const ProbingOptions& options,
                                                      const core::Progress& progress) {
  const bool turns = std::ranges::any_of(set.trials, [](const auto& t) { return t.x_m.empty(); });
  if (turns && std::ranges::any_of(set.trials, [](const auto& t) { return t.theta_rad.empty(); }))
    return Error{Errc::bad_input, fmt::format("{}: some trials slide only and others turn only; "
                                              "a set of one kind is expected",
                                              set.folder.string())};
  const std::string shortened = shorten(set);
  const std::vector<double> borders_m = borders_of(model.layers);
  std::vector<ProbingRecording> recordings(set.trials.size());
  std::vector<std::string> wrong(set.trials.size());
  parallel(int(set.trials.size()), options.threads, [&](int k) {
    auto& t = set.trials[std::size_t(k)];
    auto ready = prepare(std::move(t), set.noise, turns, borders_m, (set.folder / t.file).string());
    if (ready)
      recordings[std::size_t(k)] = std::move(*ready);
    else
      wrong[std::size_t(k)] = ready.error().what;
  });
  for (const std::string& what : wrong)
    if (!what.empty()) return Error{Errc::bad_input, what};
  if (progress && !progress(0.5)) return Error{Errc::cancelled, "stopped"};
  Reach reach{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
              !turns};
  for (const auto& r : recordings) {
    const auto [least, most] = std::ranges::minmax(r.motion.x_m);
    reach.least_m = std::min(reach.least_m, least);
    reach.most_m = std::max(reach.most_m, most);
  }
  if (!recordings.empty())
    reach.spacing_s = recordings.front().seconds() / double(recordings.front().size() - 1);
  if (!turns && !(reach.most_m - reach.least_m > 1e-5))
    return Error{Errc::bad_input,
                 fmt::format("{}: the probe moves by {:.2g} m in all; nothing can be told from "
                             "that",
                             set.folder.string(), reach.most_m - reach.least_m)};
  auto problem = std::make_unique<ProbingProblem>(
      ProbingParameterSpace(model, reach, options.user_effects), std::move(recordings), turns);
  for (const std::string& remark : model.remarks) problem->note(remark);
  if (!shortened.empty()) problem->note(shortened);
  // Twice: borders and dampings of the file first, then those of a first fit.
  std::vector<double> values;
  for (const Parameter& p : problem->parameters({})) values.push_back(p.start);
  problem->focus(values);
  if (!values.empty()) {
    const Residual residual(*problem, options.threads);
    const auto fitted = fit_base(residual).values;
    problem->estimate_noise(fitted);
    problem->focus(fitted);
    problem->estimate_delay(options.threads);
  }
  return std::unique_ptr<Problem>(std::move(problem));
}

}  // namespace lab
}  // namespace tractus
