#include <algorithm>
#include <cmath>

#include "lab/identify/least_squares.hpp"
#include "lab/rigs/probing/probing_problem.hpp"

namespace tractus {
namespace lab {

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
  for (std::size_t k = 0; k < trials_.size(); ++k) {
    ProbingRecording& r = trials_[k];
    const auto full = full_rate({}, values, int(k)).channels.front();
    std::vector<double> thin(r.measured_thin.size());
    r.decimator.apply(full, thin);
    lab::estimate_noise(r, full, thin);
  }
}

/// The speed's, then the acceleration's standard error is added to one sample and taken from the next, and what the
/// prediction differs by, beyond that of the bone alone, adds in squares.
std::vector<double> ProbingProblem::variance_by_effects(const models::ProbingModel& model,
                                                        const ProbingRecording& r) const {
  std::vector<double> variance(r.size(), 0.0);
  if (turns_ || model.effects.empty()) return variance;
  models::ProbingModel bone = model;
  bone.effects.clear();
  const auto runtime = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m),
             of_bone = models::ProbingRuntime::make(bone, kProbingRecording.longest_model_m);
  core::require(runtime && of_bone, "values within their bounds make a model that runs");
  const auto difference = [](const models::ProbingRuntime& of, const effects::ProbingMotion& a,
                             const effects::ProbingMotion& b) {
    models::ProbingForces there, here;
    of.predict(a, there, models::ProbingOutput::force);
    of.predict(b, here, models::ProbingOutput::force);
    for (std::size_t k = 0; k < there.fz_N.size(); ++k) there.fz_N[k] -= here.fz_N[k];
    return there.fz_N;
  };
  const auto move = [&](auto member, const std::vector<double>& sd) {
    effects::ProbingMotion motion = r.motion;
    for (std::size_t k = 0; k < sd.size(); ++k) (motion.*member)[k] += k % 2 == 0 ? sd[k] : -sd[k];
    const auto all = difference(*runtime, motion, r.motion),
               own = difference(*of_bone, motion, r.motion);
    for (std::size_t k = 0; k < variance.size(); ++k)
      variance[k] += std::max(0.0, all[k] * all[k] - own[k] * own[k]);
  };
  move(&effects::ProbingMotion::v_m_s, r.v_sd_m_s);
  move(&effects::ProbingMotion::a_m_s2, r.a_sd_m_s2);
  return variance;
}

/// What the motion's errors make of a model's effects, root mean square over the judged samples.
double ProbingProblem::floor_of_effects(const models::ProbingModel& model) const {
  if (turns_ || model.effects.empty()) return 0.0;
  double sum = 0.0, count = 0.0;
  for (const ProbingRecording& r : trials_) {
    const std::vector<double> variance = variance_by_effects(model, r);
    for (std::size_t k = 0; k < r.size(); ++k)
      if (r.judgement[k] == Judgement::judged) sum += variance[k], count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double ProbingProblem::noise_floor(const Structure& structure,
                                   std::span<const double> values) const {
  if (turns_ || structure.effects.empty()) return channels_.front().noise_floor;
  return std::hypot(floor_of_bone_, floor_of_effects(numbers_.with(structure, values)));
}

}  // namespace lab
}  // namespace tractus
