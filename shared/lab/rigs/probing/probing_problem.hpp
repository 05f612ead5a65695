/// The probing rig as the engine sees it; its parts stand in problem.cpp (prediction, residuals), sensor_noise.cpp and
/// formula_signals.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/require.hpp"
#include "effects/delayed.hpp"
#include "lab/rigs/probing/parameter_space.hpp"
#include "lab/rigs/probing/problem.hpp"
#include "lab/rigs/probing/recording.hpp"
#include "lab/settings.hpp"
#include "lab/signal/drift.hpp"
#include "models/probing_runtime.hpp"

namespace tractus::lab {

class ProbingProblem final : public Problem, public FormulaTerms {
 public:
  ProbingProblem(ProbingParameterSpace numbers, std::vector<ProbingRecording> trials, bool turns)
      : numbers_(std::move(numbers)), trials_(std::move(trials)), turns_(turns) {
    for (const auto& r : trials_) {
      drifts_.push_back(drift_of(r));
      fit_.push_back(fit_samples(r));
    }
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
    return turns_ ? kSettings.torque_thresholds : kSettings.probing_thresholds;
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
  void leave_stretches_out(const Structure& structure, int k, int stretches,
                           Eigen::Ref<Eigen::VectorXd> residual) const override {
    if (has_drift(structure)) drifts_[std::size_t(k)].leave_stretches_out(stretches, residual);
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
    const models::ProbingModel given = numbers_.with({}, values);
    const auto law = given.law(kProbingRecording.longest_model_m);
    core::require(bool(law), "a fitted model runs");
    for (std::size_t k = 0; k < trials_.size(); ++k) {
      weigh(*law, variance_by_effects(given, trials_[k]), trials_[k]);
      drifts_[k] = drift_of(trials_[k]);
    }
    set_channels();
    floor_of_bone_ = channels_.front().noise_floor;
    channels_.front().noise_floor = std::hypot(floor_of_bone_, floor_of_effects(given));
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
  /// Variance of the force by what the motion's errors make of a model's effects, sample by sample.
  std::vector<double> variance_by_effects(const models::ProbingModel& model,
                                          const ProbingRecording& r) const;
  double floor_of_effects(const models::ProbingModel& model) const;
  std::vector<double> dry_at_rest(const models::ProbingModel& model, const SampledMotion& r) const;
  models::ProbingOutput primary() const {
    return turns_ ? models::ProbingOutput::torque : models::ProbingOutput::force;
  }
  Predicted forces(const Structure& structure, std::span<const double> values,
                   const SampledMotion& r, models::ProbingOutput wanted) const {
    const models::ProbingModel model = numbers_.with(structure, values);
    const auto runtime = models::ProbingRuntime::make(model, kProbingRecording.longest_model_m);
    core::require(bool(runtime), "values within their bounds make a model that runs");
    Predicted out;
    runtime->predict(r.motion, out.forces, wanted);
    effects::delay(r.motion.t_s, numbers_.sensor_delay_s(structure, values),
                   turns_ ? out.forces.tz_Nm : out.forces.fz_N);
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
    const FitSamples& samples = fit_[std::size_t(k)];
    const auto predicted = forces(structure, values, samples, primary());
    std::vector<double> thin(r.measured_thin.size());
    samples.decimator.apply(turns_ ? predicted.forces.tz_Nm : predicted.forces.fz_N, thin);
    std::vector<double> either_way(thin.size(), 0.0);
    if (!predicted.at_rest_N.empty())
      samples.decimator.apply_sizes(samples.rest, predicted.at_rest_N, either_way);
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
  std::vector<FitSamples> fit_;  // of each trial
  std::vector<Drift> drifts_;
  std::vector<Candidate> candidates_;
  std::vector<Channel> channels_;
  std::vector<std::string> notes_;
  bool turns_;
  double floor_of_bone_ =
      0.0;  // the primary's noise floor without what effects make of the motion's errors
};

}  // namespace tractus::lab
