#include "lab/rigs/probing/problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/identify/fit_report.hpp"
#include "lab/identify/least_squares.hpp"
#include "lab/identify/parallel.hpp"
#include "lab/rigs/probing/probing_problem.hpp"
#include "lab/rigs/probing/statistics.hpp"

namespace tractus {
namespace lab {

namespace {

using core::Errc;
using core::Error;
using core::Result;

}  // namespace

/// At rest dry friction takes whatever value within its size holds the probe (Coulomb's law is
/// set-valued there), so a residual counts from there on.
std::vector<double> ProbingProblem::dry_at_rest(const models::ProbingModel& model,
                                                const SampledMotion& r) const {
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
  runtime->predict(r.at_rest, in, primary());
  runtime->predict(back, out, primary());
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
  const bool slides =
      std::ranges::none_of(trials_, [](const auto& r) { return r.recorded_x_m.empty(); });
  const bool angle = every(&effects::ProbingMotion::omega_rad_s),
             torque = every(&effects::ProbingMotion::tz_Nm);
  std::vector<effects::EffectFacts> all;
  for (const auto& info : effects::probing_effects()) all.push_back(info.facts);
  for (const auto& [use, facts] : numbers_.user_effects().all()) all.push_back(facts);
  for (const effects::EffectFacts& facts : all) {
    // The torque is judged where the rig only turns, the force everywhere else.
    const bool shows = (facts.channel == effects::Channel::torque) == turns_;
    if (numbers_.has(facts.id) || (!shows && slides)) continue;
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
  double sum = 0.0, count = 0.0, other = 0.0, squares = 0.0;
  bool both = true;
  for (const auto& r : trials_) {
    sum += r.floor * r.floor * double(r.size());
    other += r.other_noise_sd * r.other_noise_sd * double(r.size());
    count += double(r.size());
    for (const double v : r.measured) squares += v * v;
    both = both && !r.other.empty() && !r.motion.theta_rad.empty();
  }
  channels_ = {{.name = turns_ ? "tz_Nm" : "fz_N",
                .noise_floor = std::sqrt(sum / count),
                .measured_rms = std::sqrt(squares / count)}};
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
  const auto predicted = forces(structure, values, r, models::ProbingOutput::both);
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

core::Json ProbingProblem::model(const Structure& structure, std::span<const double> values) const {
  models::ProbingModel model = numbers_.with(structure, values);
  const std::string drift = numbers_.drift(structure);
  for (const Derived& range : derived(structure, values, drift))
    model.effects.push_back({drift, {range.value}});
  return model.to_json();
}

namespace {

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
  const bool turns = options.torque_beside_force ||
                     std::ranges::any_of(set.trials, [](const auto& t) { return t.x_m.empty(); });
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
  mark_saturated(recordings);
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
  // Borders and dampings of the file first, then those of a fit, and of one whose samples near borders are left out aright.
  std::vector<double> values;
  for (const Parameter& p : problem->parameters({})) values.push_back(p.start);
  problem->focus(values);
  if (!values.empty()) {
    for (int fits = 0; fits < 2; ++fits) {
      const auto fitted = fit_base(Residual(*problem, options.threads)).values;
      problem->estimate_noise(fitted);
      problem->focus(fitted);
    }
    problem->estimate_delay(options.threads);
  }
  return std::unique_ptr<Problem>(std::move(problem));
}

}  // namespace lab
}  // namespace tractus
