#include "lab/rigs/palpation/problem.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/require.hpp"
#include "core/try.hpp"
#include "effects/palpation_effect.hpp"
#include "lab/identify/least_squares.hpp"
#include "lab/identify/parallel.hpp"
#include "lab/rigs/palpation/force_laws.hpp"
#include "lab/rigs/palpation/noise.hpp"
#include "lab/rigs/palpation/parameter_space.hpp"
#include "lab/rigs/palpation/recording.hpp"
#include "lab/rigs/palpation/trend.hpp"
#include "lab/rigs/palpation/weights.hpp"
#include "lab/settings.hpp"

namespace tractus {
namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using math::Vec3;

constexpr const auto& kCompared = kSettings.palpation_fit;
/// What a drift counts when structures are compared: the orders of one course, which the channels
/// share as a rule, and more than the six numbers of a constant bias, which it contains.
constexpr int kDriftCounts = 2 * Trend::kOrders;
constexpr const char* kChannelNames[] = {"fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"};

class PalpationProblem final : public Problem {
 public:
  PalpationProblem(volume::ForceField field, models::PalpationModel model, UserEffects user_effects,
                   std::vector<PalpationRecording> trials, std::optional<trial::StatedTract> tract)
      : field_(std::move(field)),
        numbers_(std::move(model), 500.0, std::move(user_effects)),
        trials_(std::move(trials)),
        trends_(trials_.size()),
        rests_(trials_.size()),
        tract_(tract) {
    set_candidates();
    set_instants();
  }

  std::string_view rig() const override { return "palpation"; }
  int trials() const override { return int(trials_.size()); }
  std::string trial_id(int k) const override { return trial(k).id; }
  double seconds(int k) const override { return trial(k).seconds(); }
  const std::vector<Channel>& channels() const override { return channels_; }
  const std::vector<Candidate>& candidates() const override { return candidates_; }
  std::vector<Parameter> parameters(const Structure& structure) const override {
    return numbers_.parameters(structure);
  }
  effects::Starts starts(std::string_view effect, const Eigen::VectorXd& residual) const override {
    auto own = numbers_.starts(effect);
    return own.empty() ? ParameterSpace::starts(effect, residual) : own;
  }
  Eigen::Index residual_size(int k) const override {
    return 6 * Eigen::Index(trial(k).instants.size());
  }
  void residuals(const Structure& structure, std::span<const double> values, int k,
                 Eigen::Ref<Eigen::VectorXd> out) const override {
    whitened(structure, values, k, out);
    if (has_drift(structure)) trends_[std::size_t(k)].remove(out);
  }
  const SelectionThresholds& selection_thresholds() const override {
    return kSettings.palpation_thresholds;
  }
  bool differs_cheaply() const override { return true; }
  void residuals_near(const Structure& structure, std::span<const double> values,
                      const std::vector<std::vector<double>>& points, int k,
                      Eigen::Ref<Eigen::MatrixXd> out) const override;
  void leave_stretches_out(const Structure& structure, int k, int stretches,
                           Eigen::Ref<Eigen::VectorXd> residual) const override {
    if (has_drift(structure)) trends_[std::size_t(k)].leave_stretches_out(stretches, residual);
  }
  int free_per_trial(const Structure& structure) const override {
    return has_drift(structure) ? kDriftCounts : 0;
  }
  double noise_floor(const Structure& structure, std::span<const double> values) const override;
  Residuals full_rate(const Structure& structure, std::span<const double> values,
                      int k) const override;
  std::vector<bool> in_free_air(int k) const override;
  States states(int k) const override;
  States predictors(int k) const override;
  ForceLaws force_laws(int k) const override;
  std::vector<Derived> derived(const Structure& structure, std::span<const double> values,
                               std::string_view effect) const override;
  const std::vector<std::string>& notes() const override { return notes_; }
  core::Json model(const Structure& structure, std::span<const double> values) const override;

  /// Follows the shank and weighs the residuals anew, as the model with these values says.
  void focus(std::span<const double> values, int threads) {
    const auto runtime = runtime_of({}, values);
    parallel(trials(), threads, [&](int k) {
      PalpationRecording& r = trials_[std::size_t(k)];
      weigh(runtime, r);
      rests_[std::size_t(k)].deflection_m.clear();
    });
    normalise();
    parallel(trials(), threads,
             [&](int k) { trends_[std::size_t(k)] = trend_of(trials_[std::size_t(k)]); });
    set_channels();
    std::vector<double> field;
    for (const auto& r : trials_)
      field.insert(field.end(), r.field_per_m.begin(), r.field_per_m.end());
    touches_ = !field.empty();
    if (!touches_) return;
    const auto middle = field.begin() + std::ptrdiff_t(field.size() / 2);
    std::ranges::nth_element(field, middle);
    numbers_ = PalpationParameterSpace(numbers_.model(), *middle, numbers_.user_effects());
  }
  bool touches() const { return touches_; }

 private:
  bool has_drift(const Structure& structure) const { return !numbers_.drift(structure).empty(); }
  const PalpationRecording& trial(int k) const { return trials_[std::size_t(k)]; }
  static Trend trend_of(const PalpationRecording& r);
  void normalise();
  void set_candidates();
  void set_instants();
  void set_channels();

  /// By the given model.
  Felt felt(int k) const;
  models::PalpationRuntime runtime_of(const Structure& structure,
                                      std::span<const double> values) const {
    auto runtime = models::PalpationRuntime::make(numbers_.recorded(structure, values), field_);
    core::require(bool(runtime), "values within their bounds make a model that runs");
    return std::move(*runtime);
  }
  models::PalpationAnswer answer(const Structure& structure, std::span<const double> values,
                                 const PalpationRecording& r,
                                 std::span<const std::size_t> samples) const {
    models::PalpationAnswer out;
    runtime_of(structure, values).predict_at(r.motion, samples, r.deflection_m, out);
    return out;
  }
  static void whiten(const PalpationRecording& r, const models::PalpationAnswer& predicted,
                     Eigen::Ref<Eigen::VectorXd> out) {
    for (std::size_t j = 0; j < r.instants.size(); ++j) {
      const Vec6 difference = r.missed(r.instants[j], predicted.wrench_H[j]);
      out.segment<6>(6 * Eigen::Index(j)) =
          r.whitener[j].triangularView<Eigen::Lower>() * difference;
    }
  }
  void whitened(const Structure& structure, std::span<const double> values, int k,
                Eigen::Ref<Eigen::VectorXd> out) const {
    auto found = answer(structure, values, trial(k), trial(k).instants);
    whiten(trial(k), found, out);
    Rests& last = rests_[std::size_t(k)];
    const std::scoped_lock lock(last.mutex);
    last.structure = structure;
    last.values.assign(values.begin(), values.end());
    last.deflection_m = std::move(found.deflection_m);
  }
  std::vector<math::Vec2> rests_at(const Structure& structure, std::span<const double> values,
                                   int k) const;
  /// The fitted trend of a trial at its full rate, [channel][sample].
  Eigen::MatrixXd trend(const Structure& structure, std::span<const double> values, int k) const {
    Eigen::VectorXd residual(residual_size(k));
    whitened(structure, values, k, residual);
    return trends_[std::size_t(k)].at(trial(k).motion.t_s, residual);
  }

  /// Where the shank of a trial rested when it was last asked, at each instant: a search asks for
  /// differences where it has just been.
  struct Rests {
    mutable std::mutex mutex;
    Structure structure;
    std::vector<double> values;
    std::vector<math::Vec2> deflection_m;
  };

  volume::ForceField field_;
  PalpationParameterSpace numbers_;
  std::vector<PalpationRecording> trials_;
  std::vector<Trend> trends_;
  mutable std::vector<Rests> rests_;
  std::optional<trial::StatedTract> tract_;
  std::vector<Candidate> candidates_;
  std::vector<Channel> channels_;
  std::vector<std::string> notes_;
  bool touches_ = false;
};

Trend PalpationProblem::trend_of(const PalpationRecording& r) {
  std::vector<double> t_s;
  for (const std::size_t k : r.instants) t_s.push_back(r.motion.t_s[k]);
  return Trend(t_s, r.whitener);
}

/// Weighs all alike so that noise alone leaves variance 1: the parts that are poorly known count
/// less than that.
void PalpationProblem::normalise() {
  double sum = 0.0, count = 0.0;
  for (const auto& r : trials_) {
    sum += r.usual_square * double(r.whitener.size());
    count += double(r.whitener.size());
  }
  const double scale = std::sqrt(count / sum);
  for (auto& r : trials_)
    for (Mat6& w : r.whitener) w *= scale;
}

void PalpationProblem::set_candidates() {
  for (const auto& info : effects::palpation_effects())
    if (std::ranges::none_of(numbers_.model().effects,
                             [&](const auto& use) { return use.id == info.facts.id; }))
      candidates_.push_back({info.facts, true, ""});
  for (const auto& [use, facts] : numbers_.user_effects().all())
    candidates_.push_back({facts, true, ""});
}

void PalpationProblem::set_instants() {
  std::size_t samples = 0;
  double seconds = 0.0;
  for (auto& r : trials_) {
    samples += r.size(), seconds += r.seconds();
    if (!r.note.empty()) notes_.push_back(r.note);
  }
  const double wanted = std::min(double(kCompared.most_instants), kCompared.instants_Hz * seconds);
  for (auto& r : trials_)
    choose_instants(r, std::max<std::size_t>(1, std::size_t(std::ceil(double(samples) / wanted))));
}

std::vector<math::Vec2> PalpationProblem::rests_at(const Structure& structure,
                                                   std::span<const double> values, int k) const {
  const Rests& last = rests_[std::size_t(k)];
  {
    const std::scoped_lock lock(last.mutex);
    if (!last.deflection_m.empty() && last.structure == structure &&
        std::ranges::equal(last.values, values))
      return last.deflection_m;
  }
  return answer(structure, values, trial(k), trial(k).instants).deflection_m;
}

void PalpationProblem::residuals_near(const Structure& structure, std::span<const double> values,
                                      const std::vector<std::vector<double>>& points, int k,
                                      Eigen::Ref<Eigen::MatrixXd> out) const {
  const PalpationRecording& r = trial(k);
  const auto rests = rests_at(structure, values, k);
  models::PalpationAnswer there;
  models::FieldMemo memo;
  runtime_of(structure, values).respond_at(r.motion, r.instants, rests, there, memo);
  for (std::size_t p = 0; p < points.size(); ++p) {
    runtime_of(structure, points[p]).respond_at(r.motion, r.instants, rests, there, memo);
    auto column = out.col(Eigen::Index(p));
    whiten(r, there, column);
    if (has_drift(structure)) trends_[std::size_t(k)].remove(column);
  }
}

void PalpationProblem::set_channels() {
  Vec6 squares = Vec6::Zero();
  double count = 0.0, measured = 0.0;
  for (const auto& r : trials_) {
    squares += r.floor.cwiseAbs2() * double(r.size());
    for (const Vec6& wrench : r.measured) measured += wrench.head<3>().squaredNorm();
    count += double(r.size());
  }
  squares /= count;
  channels_ = {{"force_N", std::sqrt(squares.head<3>().sum()), 3, std::sqrt(measured / count)}};
  for (int c = 0; c < 6; ++c) channels_.push_back({kChannelNames[c], std::sqrt(squares[c])});
}

Residuals PalpationProblem::full_rate(const Structure& structure, std::span<const double> values,
                                      int k) const {
  const PalpationRecording& r = trial(k);
  const auto predicted = answer(structure, values, r, r.all());
  Residuals out{r.motion.t_s, std::vector<std::vector<double>>(7), r.judgement};
  Eigen::MatrixXd slow;
  if (has_drift(structure)) slow = trend(structure, values, k);
  for (auto& channel : out.channels) channel.reserve(r.size());
  for (std::size_t i = 0; i < r.size(); ++i) {
    Vec6 error = r.missed(i, predicted.wrench_H[i]);
    if (slow.size() > 0) error -= slow.col(Eigen::Index(i));
    out.channels[0].push_back(error.head<3>().norm());
    for (int c = 0; c < 6; ++c) out.channels[std::size_t(c) + 1].push_back(error[c]);
  }
  return out;
}

/// Where the given model feels less than a contact's force, for as long as a mean of the acceleration before and after.
std::vector<bool> PalpationProblem::in_free_air(int k) const {
  const PalpationRecording& r = trial(k);
  std::vector<double> start;
  for (const Parameter& p : numbers_.parameters({})) start.push_back(p.start);
  models::PalpationAnswer at;
  runtime_of({}, start).predict_at(r.motion, r.all(), r.deflection_m, at);
  std::vector<bool> out(r.size(), true);
  const double around_s = kSettings.palpation_recording.acceleration_of_means_s;
  for (std::size_t i = 0, from = 0; i < r.size(); ++i) {
    if (at.wrench_H[i].force_N.norm() < kSettings.palpation_weights.contact_N) continue;
    while (r.motion.t_s[from] < r.motion.t_s[i] - around_s) ++from;
    for (std::size_t j = from; j < r.size() && r.motion.t_s[j] <= r.motion.t_s[i] + around_s; ++j)
      out[j] = false;
  }
  return out;
}

Felt PalpationProblem::felt(int k) const {
  std::vector<double> start;
  for (const Parameter& p : numbers_.parameters({})) start.push_back(p.start);
  return felt_by(runtime_of({}, start), trial(k));
}

States PalpationProblem::states(int k) const {
  const PalpationRecording& r = trial(k);
  const Felt of_trial = felt(k);
  const auto& [tip, velocity, force, force_H] = of_trial;
  States out;
  const auto add = [&](const char* name, const auto& value) {
    out.names.emplace_back(name);
    auto& column = out.values.emplace_back();
    for (std::size_t i = 0; i < r.size(); ++i) column.push_back(value(i));
  };
  const auto handle = [&](std::size_t i) -> const effects::HandleMotion& {
    return r.motion.handle[i];
  };
  add("time_s", [&](std::size_t i) { return r.motion.t_s[i] - r.motion.t_s.front(); });
  if (tract_) {
    const Vec3 axis = tract_->axis;
    Vec3 across = axis.cross(std::abs(axis.x()) < 0.9 ? Vec3::UnitX() : Vec3::UnitY());
    across.normalize();
    const Vec3 third = axis.cross(across);
    add("depth_m", [&](std::size_t i) { return (tip[i] - tract_->entry_m).dot(axis); });
    add("wall_angle_rad", [&](std::size_t i) {
      const double angle = std::atan2(-force[i].dot(third), -force[i].dot(across));
      return angle < 0.0 ? angle + 2.0 * M_PI : angle;
    });
  } else {
    add("tip_x_m", [&](std::size_t i) { return tip[i].x(); });
    add("tip_y_m", [&](std::size_t i) { return tip[i].y(); });
    add("tip_z_m", [&](std::size_t i) { return tip[i].z(); });
  }
  add("velocity_m_s", [&](std::size_t i) { return velocity[i].norm(); });
  add("speed_along_force_m_s", [&](std::size_t i) {
    const double F = force[i].norm();
    return F > 1e-6 ? velocity[i].dot(force[i]) / F : 0.0;
  });
  add("acceleration_m_s2", [&](std::size_t i) { return handle(i).a_m_s2.norm(); });
  add("force_N", [&](std::size_t i) { return force[i].norm(); });
  add("omega_rad_s", [&](std::size_t i) { return handle(i).omega_rad_s.norm(); });
  add("force_x_N", [&](std::size_t i) { return force_H[i].x(); });
  add("force_y_N", [&](std::size_t i) { return force_H[i].y(); });
  add("force_z_N", [&](std::size_t i) { return force_H[i].z(); });
  return out;
}

/// No acceleration: its error goes with that of the place, by which bone's force errs.
States PalpationProblem::predictors(int k) const {
  States out = states(k);
  const auto add = [&](const char* name, auto vector_V) {
    for (int axis = 0; axis < 3; ++axis) {
      out.names.push_back(fmt::format("{} {}", name, "xyz"[axis]));
      auto& column = out.values.emplace_back();
      for (const effects::HandleMotion& h : trial(k).motion.handle)
        column.push_back((h.X_VH.q.conjugate() * vector_V(h))[axis]);
    }
  };
  add("velocity", [](const effects::HandleMotion& h) -> Vec3 { return h.v_m_s; });
  add("turning", [](const effects::HandleMotion& h) -> Vec3 { return h.omega_rad_s; });
  add("gravity", [](const effects::HandleMotion& h) -> Vec3 { return h.down; });
  return out;
}

ForceLaws PalpationProblem::force_laws(int k) const {
  const PalpationRecording& r = trial(k);
  const Felt of_trial = felt(k);
  std::vector<double> depth_m;
  if (tract_)
    for (const Vec3& tip : of_trial.tip_m)
      depth_m.push_back((tip - tract_->entry_m).dot(tract_->axis));
  ForceLaws out{force_laws_of({.t_s = r.motion.t_s,
                               .handle = r.motion.handle,
                               .force_V_N = of_trial.force_V_N,
                               .tip_v_m_s = of_trial.velocity_m_s,
                               .depth_m = depth_m}),
                {}};
  const double sensor = r.sensor_squares().head<3>().sum();
  for (const double motion_N : r.motion_N)
    out.error_sd_N.push_back(std::sqrt(sensor + motion_N * motion_N));
  return out;
}

double PalpationProblem::noise_floor(const Structure& structure,
                                     std::span<const double> values) const {
  std::vector<NoiseSample> all;
  for (int k = 0; k < trials(); ++k) {
    const PalpationRecording& r = trial(k);
    const Residuals left = full_rate(structure, values, k);
    const double sensor = r.sensor_squares().head<3>().sum();
    for (std::size_t i = 0; i < left.t_s.size(); ++i)
      if (left.judgement[i] == Judgement::judged || left.judgement[i] == Judgement::unknown_motion)
        all.push_back({std::pow(left.channels[0][i], 2), sensor, std::pow(r.motion_N[i], 2),
                       left.judgement[i] == Judgement::judged});
  }
  const double noise = judged_noise(all);
  return noise > 0.0 ? noise : channels_.front().noise_floor;
}

std::vector<Derived> PalpationProblem::derived(const Structure& structure,
                                               std::span<const double> values,
                                               std::string_view effect) const {
  if (effect.empty() || effect != numbers_.drift(structure)) return {};
  // Mean over the trials, and over the axes that drift: by half as much as the one that does most.
  double sum = 0.0, variance = 0.0;
  for (int k = 0; k < trials(); ++k) {
    const Eigen::Matrix3Xd slow = trend(structure, values, k).topRows<3>();
    const auto& t_s = trials_[std::size_t(k)].motion.t_s;
    Vec3 range, square;
    for (int axis = 0; axis < 3; ++axis) {
      Eigen::Index high = 0, low = 0;
      range(axis) = slow.row(axis).maxCoeff(&high) - slow.row(axis).minCoeff(&low);
      square(axis) = trends_[std::size_t(k)].variance_between(axis, t_s[std::size_t(high)],
                                                              t_s[std::size_t(low)]);
    }
    const auto drifts = (range.array() >= 0.5 * range.maxCoeff()).cast<double>();
    sum += (range.array() * drifts).sum() / drifts.sum();
    variance += (square.array() * drifts).sum() / (drifts.sum() * drifts.sum());
  }
  const double n = trials();
  return {{numbers_.facts_of(effect).params.front().name, sum / n, std::sqrt(variance) / n}};
}

core::Json PalpationProblem::model(const Structure& structure,
                                   std::span<const double> values) const {
  models::PalpationModel model = numbers_.with(structure, values);
  const std::string drift = numbers_.drift(structure);
  for (const Derived& range : derived(structure, values, drift))
    model.effects.push_back({drift, {range.value}});
  return model.to_json();
}

}  // namespace

Result<std::unique_ptr<Problem>> make_palpation_problem(const models::PalpationModel& model,
                                                        trial::PalpationSet set,
                                                        const volume::Volume& volume,
                                                        const PalpationOptions& options,
                                                        const core::Progress& progress) {
  const auto down = trial::stated_down(set);
  if (!down) return Error{down.error().code, (set.folder / down.error().what).string()};
  auto field = TRY(volume::ForceField::make(volume, model.transfer, model.field));
  if (progress && !progress(0.3)) return Error{Errc::cancelled, "stopped"};
  std::vector<PalpationRecording> recordings(set.trials.size());
  std::vector<std::string> wrong(set.trials.size());
  parallel(int(set.trials.size()), options.threads, [&](int k) {
    auto& t = set.trials[std::size_t(k)];
    const std::string where = (set.folder / t.file).string();
    auto ready = prepare(std::move(t), *down, where, kCompared.most_samples / set.trials.size());
    if (ready)
      recordings[std::size_t(k)] = std::move(*ready);
    else
      wrong[std::size_t(k)] = ready.error().what;
  });
  for (const std::string& what : wrong)
    if (!what.empty()) return Error{Errc::bad_input, what};
  mark_saturated(recordings);
  if (progress && !progress(0.6)) return Error{Errc::cancelled, "stopped"};
  auto problem = std::make_unique<PalpationProblem>(std::move(field), model, options.user_effects,
                                                    std::move(recordings), set.tract);
  // As the file has it first, then as a fit has it, and again: which rests the shank finds depends
  // on the numbers, and the numbers on the rests.
  std::vector<double> values;
  for (const Parameter& p : problem->parameters({})) values.push_back(p.start);
  problem->focus(values, options.threads);
  if (!problem->touches())
    return Error{Errc::bad_input,
                 fmt::format("{}: in no trial does the model's probe touch bone; are poses and "
                             "volume in the same frame, in metres?",
                             set.folder.string())};
  for (int round = 0; round < kCompared.rounds && !values.empty(); ++round) {
    const Residual residual(*problem, options.threads);
    values = search(residual, {}, values).values;
    problem->focus(values, options.threads);
    if (progress && !progress(0.6 + 0.4 * (round + 1) / kCompared.rounds))
      return Error{Errc::cancelled, "stopped"};
  }
  return std::unique_ptr<Problem>(std::move(problem));
}

}  // namespace lab
}  // namespace tractus
