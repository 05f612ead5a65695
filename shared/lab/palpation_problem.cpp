#include "lab/palpation_problem.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "core/require.hpp"
#include "effects/palpation_effect.hpp"
#include "lab/least_squares.hpp"
#include "lab/palpation_advice.hpp"
#include "lab/palpation_numbers.hpp"
#include "lab/palpation_recording.hpp"
#include "lab/palpation_trend.hpp"
#include "lab/parallel.hpp"

namespace lab {
namespace {

using core::Errc;
using core::Error;
using core::Result;
using math::Vec3;

constexpr int kRounds = 2;
/// What a drift counts when structures are compared: the orders of one course, which the channels
/// share as a rule, and more than the six numbers of a constant bias, which it contains.
constexpr int kDriftCounts = Trend::kOrders + 2;
constexpr std::string_view kDrift = "sensor_drift";
constexpr const char* kChannelNames[] = {"fx_N", "fy_N", "fz_N", "tx_Nm", "ty_Nm", "tz_Nm"};

bool has_drift(const Structure& structure) {
  return std::ranges::find(structure.effects, kDrift) != structure.effects.end();
}

class PalpationProblem final : public Problem {
 public:
  PalpationProblem(volume::ForceField field, models::PalpationModel model, Offered offered,
                   std::vector<PalpationRecording> trials, std::optional<trial::StatedTract> tract)
      : field_(std::move(field)),
        numbers_(std::move(model), 500.0, std::move(offered)),
        trials_(std::move(trials)),
        trends_(trials_.size()),
        tract_(tract) {
    set_candidates();
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
  std::vector<std::vector<double>> starts(std::string_view effect,
                                          const Eigen::VectorXd& residual) const override {
    auto own = numbers_.starts(effect);
    return own.empty() ? Problem::starts(effect, residual) : own;
  }
  Eigen::Index residual_size(int k) const override { return 6 * trial(k).outputs(); }
  void residuals(const Structure& structure, std::span<const double> values, int k,
                 Eigen::Ref<Eigen::VectorXd> out) const override {
    whitened(structure, values, k, out);
    if (has_drift(structure)) trends_[std::size_t(k)].remove(out);
  }
  int free_per_trial(const Structure& structure) const override {
    return has_drift(structure) ? kDriftCounts : 0;
  }
  Residuals full_rate(const Structure& structure, std::span<const double> values,
                      int k) const override;
  States states(int k) const override;
  std::vector<std::pair<std::string, double>> derived(const Structure& structure,
                                                      std::span<const double> values,
                                                      std::string_view effect) const override;
  std::string recording(std::string_view a, std::string_view b) const override {
    return palpation_recording(a, b);
  }
  const std::vector<std::string>& notes() const override { return notes_; }
  core::Json model(const Structure& structure, std::span<const double> values) const override;

  /// Follows the shank and weighs the residuals anew, as the model with these values says.
  void focus(std::span<const double> values, int threads) {
    const auto runtime = runtime_of({}, values);
    parallel(trials(), threads, [&](int k) {
      PalpationRecording& r = trials_[std::size_t(k)];
      weigh(runtime, r);
      trends_[std::size_t(k)] = trend_of(r);
    });
    set_channels();
    std::vector<double> field;
    for (const auto& r : trials_)
      field.insert(field.end(), r.field_per_m.begin(), r.field_per_m.end());
    touches_ = !field.empty();
    if (!touches_) return;
    const auto middle = field.begin() + std::ptrdiff_t(field.size() / 2);
    std::ranges::nth_element(field, middle);
    numbers_ = PalpationNumbers(numbers_.model(), *middle, numbers_.offered());
  }
  bool touches() const { return touches_; }

 private:
  const PalpationRecording& trial(int k) const { return trials_[std::size_t(k)]; }
  static Trend trend_of(const PalpationRecording& r);
  void set_candidates();
  void set_channels();

  models::PalpationRuntime runtime_of(const Structure& structure,
                                      std::span<const double> values) const {
    auto runtime = models::PalpationRuntime::make(numbers_.with(structure, values), field_);
    core::require(bool(runtime), "values within their bounds make a model that runs");
    return std::move(*runtime);
  }
  models::PalpationAnswer answer(const Structure& structure, std::span<const double> values,
                                 const PalpationRecording& r) const {
    models::PalpationAnswer out;
    predict(runtime_of(structure, values), r, r.motion, out);
    return out;
  }
  void whitened(const Structure& structure, std::span<const double> values, int k,
                Eigen::Ref<Eigen::VectorXd> out) const {
    const PalpationRecording& r = trial(k);
    const auto difference =
        (r.measured_thin - r.thinned(answer(structure, values, r).wrench_H)).eval();
    for (Eigen::Index j = 0; j < difference.cols(); ++j)
      out.segment<6>(6 * j) =
          r.whitener[std::size_t(j)].triangularView<Eigen::Lower>() * difference.col(j);
  }
  /// The fitted trend of a trial at its full rate, [channel][sample].
  Eigen::MatrixXd trend(const Structure& structure, std::span<const double> values, int k) const {
    Eigen::VectorXd residual(residual_size(k));
    whitened(structure, values, k, residual);
    return trends_[std::size_t(k)].at(trial(k).motion.t_s, residual);
  }

  volume::ForceField field_;
  PalpationNumbers numbers_;
  std::vector<PalpationRecording> trials_;
  std::vector<Trend> trends_;
  std::optional<trial::StatedTract> tract_;
  std::vector<Candidate> candidates_;
  std::vector<Channel> channels_;
  std::vector<std::string> notes_;
  bool touches_ = false;
};

Trend PalpationProblem::trend_of(const PalpationRecording& r) {
  std::vector<double> t_s;
  for (std::size_t j = 0; j < std::size_t(r.outputs()); ++j)
    t_s.push_back(r.motion.t_s[r.decimator.middle(j)]);
  return Trend(t_s, r.whitener);
}

void PalpationProblem::set_candidates() {
  for (const auto& info : effects::palpation_effects())
    if (std::ranges::none_of(numbers_.model().effects,
                             [&](const auto& use) { return use.id == info.facts.id; }))
      candidates_.push_back({info.facts, true, ""});
  for (const auto& [use, facts] : numbers_.offered().all())
    candidates_.push_back({facts, true, ""});
}

void PalpationProblem::set_channels() {
  Vec6 squares = Vec6::Zero();
  double count = 0.0;
  for (const auto& r : trials_) {
    squares += r.floor.cwiseAbs2() * double(r.size());
    count += double(r.size());
  }
  squares /= count;
  channels_ = {{"force_N", std::sqrt(squares.head<3>().sum())}};
  for (int c = 0; c < 6; ++c) channels_.push_back({kChannelNames[c], std::sqrt(squares[c])});
}

Residuals PalpationProblem::full_rate(const Structure& structure, std::span<const double> values,
                                      int k) const {
  const PalpationRecording& r = trial(k);
  const auto predicted = answer(structure, values, r);
  Residuals out{r.motion.t_s, std::vector<std::vector<double>>(7), r.trusted};
  Eigen::MatrixXd slow;
  if (has_drift(structure)) slow = trend(structure, values, k);
  for (auto& channel : out.channels) channel.reserve(r.size());
  for (std::size_t i = 0; i < r.size(); ++i) {
    Vec6 error = r.measured[i] - stacked(predicted.wrench_H[i]);
    if (slow.size() > 0) error -= slow.col(Eigen::Index(i));
    out.channels[0].push_back(error.head<3>().norm());
    for (int c = 0; c < 6; ++c) out.channels[std::size_t(c) + 1].push_back(error[c]);
  }
  return out;
}

States PalpationProblem::states(int k) const {
  const PalpationRecording& r = trial(k);
  States out;
  const auto add = [&](const char* name, const auto& value) {
    out.names.emplace_back(name);
    auto& column = out.values.emplace_back();
    for (std::size_t i = 0; i < r.size(); ++i) column.push_back(value(i));
  };
  const auto handle = [&](std::size_t i) -> const effects::HandleMotion& {
    return r.motion.handle[i];
  };
  std::vector<double> start;
  for (const Parameter& p : numbers_.parameters({})) start.push_back(p.start);
  const auto runtime = runtime_of({}, start);
  std::vector<Vec3> tip, velocity, force;
  models::PalpationAnswer at;
  predict(runtime, r, r.motion, at);
  for (std::size_t i = 0; i < r.size(); ++i) {
    const auto& h = handle(i);
    tip.push_back(runtime.tip_m(h.X_VH, at.deflection_m[i]));
    velocity.push_back(h.v_m_s + h.omega_rad_s.cross(runtime.law().parameters().length_m *
                                                     (h.X_VH.q * Vec3::UnitZ())));
    force.push_back(h.X_VH.q * at.wrench_H[i].force_N);
  }
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
  return out;
}

std::vector<std::pair<std::string, double>> PalpationProblem::derived(
    const Structure& structure, std::span<const double> values, std::string_view effect) const {
  if (effect != kDrift || !has_drift(structure)) return {};
  // Mean over the trials, and over the axes that drift: by half as much as the one that does most.
  double sum = 0.0;
  for (int k = 0; k < trials(); ++k) {
    const Eigen::Matrix3Xd slow = trend(structure, values, k).topRows<3>();
    const Vec3 range = slow.rowwise().maxCoeff() - slow.rowwise().minCoeff();
    const auto drifts = (range.array() >= 0.5 * range.maxCoeff()).cast<double>();
    sum += (range.array() * drifts).sum() / drifts.sum();
  }
  return {{"range_N", sum / double(trials())}};
}

core::Json PalpationProblem::model(const Structure& structure,
                                   std::span<const double> values) const {
  models::PalpationModel model = numbers_.with(structure, values);
  for (const auto& [name, value] : derived(structure, values, kDrift))
    model.effects.push_back({std::string(kDrift), {value}});
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
  auto field = volume::ForceField::make(volume, model.transfer, model.field);
  if (!field) return field.error();
  if (progress && !progress(0.3)) return Error{Errc::cancelled, "stopped"};
  std::vector<PalpationRecording> recordings(set.trials.size());
  std::vector<std::string> wrong(set.trials.size());
  parallel(int(set.trials.size()), options.threads, [&](int k) {
    auto& t = set.trials[std::size_t(k)];
    auto ready = prepare(std::move(t), *down, (set.folder / t.file).string());
    if (ready)
      recordings[std::size_t(k)] = std::move(*ready);
    else
      wrong[std::size_t(k)] = ready.error().what;
  });
  for (const std::string& what : wrong)
    if (!what.empty()) return Error{Errc::bad_input, what};
  if (progress && !progress(0.6)) return Error{Errc::cancelled, "stopped"};
  auto problem = std::make_unique<PalpationProblem>(std::move(*field), model, options.offered,
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
  for (int round = 0; round < kRounds && !values.empty(); ++round) {
    const Residual residual(*problem, options.threads);
    values = search(residual, {}, values).values;
    problem->focus(values, options.threads);
    if (progress && !progress(0.6 + 0.4 * (round + 1) / kRounds))
      return Error{Errc::cancelled, "stopped"};
  }
  return std::unique_ptr<Problem>(std::move(problem));
}

}  // namespace lab
