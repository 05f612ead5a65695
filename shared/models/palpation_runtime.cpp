#include "models/palpation_runtime.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/try.hpp"
#include "math/spline.hpp"

namespace tractus {
namespace models {
namespace {

using effects::HandleMotion;
using math::Vec3;

constexpr double kFollowed_voxels = 1.0 / 3.0;  // most that the tip moves in a step
constexpr double kMostSubsteps = 64;
constexpr double kFarthestResponse_voxels = 0.2;

/// Small rotations as a vector, left of q.
math::Quat turned(const math::Quat& q, const Vec3& by_V_rad) {
  const double angle = by_V_rad.norm();
  if (!(angle > 1e-15)) return q;
  return (math::Quat(Eigen::AngleAxisd(angle, by_V_rad / angle)) * q).normalized();
}

HandleMotion later(const HandleMotion& from, double dt_s) {
  HandleMotion out = from;
  const double half = 0.5 * dt_s * dt_s;
  out.X_VH.p += dt_s * from.v_m_s + half * from.a_m_s2;
  out.X_VH.q = turned(from.X_VH.q, dt_s * from.omega_rad_s + half * from.alpha_rad_s2);
  out.v_m_s += dt_s * from.a_m_s2;
  out.omega_rad_s += dt_s * from.alpha_rad_s2;
  return out;
}

}  // namespace

core::Result<PalpationMotion> PalpationMotion::through(std::span<const double> t_s,
                                                       std::span<const math::Pose> X_VH,
                                                       const Vec3& down) {
  const auto spline = TRY(math::PoseSpline::make(t_s, X_VH));
  PalpationMotion out;
  out.t_s.assign(t_s.begin(), t_s.end());
  out.handle.reserve(t_s.size());
  for (std::size_t k = 0; k < t_s.size(); ++k)
    out.handle.push_back({X_VH[k], spline.velocity_m_s(t_s[k]),
                          spline.angular_velocity_rad_s(t_s[k]), spline.acceleration_m_s2(t_s[k]),
                          spline.angular_acceleration_rad_s2(t_s[k]), down});
  return out;
}

std::size_t PalpationMotion::nearest(double t) const noexcept {
  const auto after = std::ranges::lower_bound(t_s, t);
  auto k = std::size_t(after - t_s.begin());
  if (k == t_s.size() || (k > 0 && t - t_s[k - 1] < t_s[k] - t)) --k;
  return k;
}

HandleMotion PalpationMotion::at(double t) const noexcept {
  t = std::clamp(t, t_s.front(), t_s.back());
  const std::size_t k = nearest(t);
  return later(handle[k], t - t_s[k]);
}

/// The forces on the contact points of a moving handle, through the stages from spread to point.
class PalpationRuntime::Contacts final : public laws::ContactForces {
 public:
  /// One sample's part of a memo, to be filled or to be read.
  struct Recall {
    std::span<FieldMemo::Entry> entries;
    bool fill = false;
    std::size_t next = 0;
  };
  Contacts(const PalpationRuntime& runtime, const HandleMotion& handle, Recall* recall = nullptr)
      : runtime_(runtime),
        force_factor_Nm_(runtime.law_.parameters().force_factor_Nm),
        recall_(recall) {
    const laws::Shank& shank = runtime.law_.shank();
    for (std::size_t i = 0; i < std::size_t(shank.points); ++i) {
      const Vec3 unbent_H(shank.rest_m[i].x(), shank.rest_m[i].y(), shank.z_m[i]);
      v_m_s_[i] = handle.v_m_s + handle.omega_rad_s.cross(handle.X_VH.q * unbent_H);
    }
  }

  laws::ForceSample at(std::size_t i, const Vec3& p_V_m) const noexcept override {
    return bending_at(i, p_V_m, elastic_at(i, p_V_m));
  }

  /// What of the force on point i is felt and does not bend the shank, in V.
  Vec3 unbending_N(std::size_t i, const Vec3& p_V_m) const noexcept {
    laws::ForceSample total{Vec3::Zero(), math::Mat3::Zero()};
    add_unbending(i, p_V_m, elastic_at(i, p_V_m), total);
    return total.force_N;
  }

  /// What bends and what does not, of one evaluation.
  void both_at(std::size_t i, const Vec3& p_V_m, laws::ForceSample& bending,
               laws::ForceSample& unbending) const noexcept {
    const laws::ForceSample elastic = elastic_at(i, p_V_m);
    bending = bending_at(i, p_V_m, elastic);
    unbending = {Vec3::Zero(), math::Mat3::Zero()};
    add_unbending(i, p_V_m, elastic, unbending);
  }

 private:
  laws::ForceSample bending_at(std::size_t i, const Vec3& p_V_m,
                               const laws::ForceSample& elastic) const noexcept {
    laws::ForceSample total = elastic;
    for (const auto& force : runtime_.stages_.forces) {
      const double share = force->bending_share();
      if (share == 1.0)
        force->add(point(i, p_V_m), elastic, total);
      else if (share > 0.0)
        add(share, *force, i, p_V_m, elastic, total);
    }
    return total;
  }
  void add_unbending(std::size_t i, const Vec3& p_V_m, const laws::ForceSample& elastic,
                     laws::ForceSample& total) const noexcept {
    for (const auto& force : runtime_.stages_.forces)
      if (const double share = force->bending_share(); share < 1.0)
        add(1.0 - share, *force, i, p_V_m, elastic, total);
  }
  effects::PointContact point(std::size_t i, const Vec3& p_V_m) const noexcept {
    return {p_V_m, v_m_s_[i], runtime_.field_};
  }
  void add(double share, const effects::PointForce& force, std::size_t i, const Vec3& p_V_m,
           const laws::ForceSample& elastic, laws::ForceSample& total) const noexcept {
    laws::ForceSample own{Vec3::Zero(), math::Mat3::Zero()};
    force.add(point(i, p_V_m), elastic, own);
    total.force_N += share * own.force_N;
    total.jacobian_N_per_m += share * own.jacobian_N_per_m;
  }

  /// c_f g through the stages spread, field and loss.
  laws::ForceSample elastic_at(std::size_t i, const Vec3& p_V_m) const noexcept {
    const Stages& stages = runtime_.stages_;
    volume::FieldSample field;
    if (i == 0 && !stages.spreads.empty()) {
      field = {Vec3::Zero(), math::Mat3::Zero()};
      for (const auto& node : stages.spreads.front()->nodes()) {
        const volume::FieldSample there = changed(p_V_m + node.offset_m);
        field.g_per_m += node.weight * there.g_per_m;
        field.jacobian_per_m2 += node.weight * there.jacobian_per_m2;
      }
    } else {
      field = changed(p_V_m);
    }
    laws::ForceSample elastic{force_factor_Nm_ * field.g_per_m,
                              force_factor_Nm_ * field.jacobian_per_m2};
    for (const auto& loss : stages.losses) loss->change(point(i, p_V_m), elastic);
    return elastic;
  }

  volume::FieldSample changed(const Vec3& p_V_m) const noexcept {
    volume::FieldSample field = sample(p_V_m);
    for (const auto& change : runtime_.stages_.fields) change->change(field);
    return field;
  }

  volume::FieldSample sample(const Vec3& p_V_m) const noexcept {
    if (!recall_ || recall_->next >= recall_->entries.size()) return runtime_.field_->sample(p_V_m);
    FieldMemo::Entry& entry = recall_->entries[recall_->next++];
    if (!recall_->fill) return entry.p_m == p_V_m ? entry.at : runtime_.field_->sample(p_V_m);
    entry = {p_V_m, runtime_.field_->sample(p_V_m)};
    return entry.at;
  }

  const PalpationRuntime& runtime_;
  double force_factor_Nm_;
  Recall* recall_;
  std::array<Vec3, laws::kMaxPoints> v_m_s_;
};

core::Result<PalpationRuntime> PalpationRuntime::make(const PalpationModel& model,
                                                      const volume::Volume& volume,
                                                      const core::Progress& progress) {
  auto made = TRY(volume::ForceField::make(volume, model.transfer, model.field, progress));
  auto field = std::make_unique<volume::ForceField>(std::move(made));
  auto runtime = make(model, *field);
  if (runtime) runtime->owned_ = std::move(field);
  return runtime;
}

core::Result<PalpationRuntime> PalpationRuntime::make(const PalpationModel& model,
                                                      const volume::ForceField& field) {
  auto law = TRY(laws::PalpationLaw::make(model.base, field));
  PalpationRuntime runtime(field, std::move(law));
  std::vector<effects::EffectInstance> uses = model.effects;
  std::ranges::sort(uses, {}, &effects::EffectInstance::id);  // the catalogue's order
  for (const effects::EffectInstance& use : uses) TRY(runtime.add(use));
  return runtime;
}

core::Result<void> PalpationRuntime::add(const effects::EffectInstance& use) {
  auto effect = TRY(effects::make_palpation_effect(use));
  const auto keep = [this]<class Stage>(Stage stage) {
    using effects::PalpationEffect;
    if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::MotionDelay>>) {
      delay_s_ += stage->delay_s();
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::ShankForm>>) {
      laws::Shank shank = law_.shank();
      stage->form(shank);
      law_.replace_shank(shank);
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::PosePlacement>>) {
      stages_.placements.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::TipSpread>>) {
      stages_.spreads.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::ContactField>>) {
      stages_.fields.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::ContactLoss>>) {
      stages_.losses.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::PointForce>>) {
      felt_without_bending_ = felt_without_bending_ || stage->bending_share() < 1.0;
      stages_.forces.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::HandleWrench>>) {
      stages_.wrenches.push_back(std::move(stage));
    } else if constexpr (std::is_same_v<Stage, std::unique_ptr<effects::SensorOffset>>) {
      stages_.offsets.push_back(std::move(stage));
    } else {
      static_assert(std::is_same_v<Stage, effects::FreePerTrial>);
    }
  };
  std::visit([&](auto& stage) { keep(std::move(stage)); }, effect);
  return {};
}

void PalpationRuntime::add_unbending(const Contacts& contacts, const math::Pose& X_VH,
                                     laws::PalpationStep& step) const noexcept {
  const laws::PalpationParameters& base = law_.parameters();
  for (std::size_t i = 0; i < std::size_t(base.points); ++i) {
    const Vec3 p_H = law_.point_H_m(int(i), step.deflection_m);
    const Vec3 F = X_VH.q.conjugate() * contacts.unbending_N(i, X_VH * p_H);
    step.force_H_N[i] += F;
    laws::add_to_wrench(p_H, F, base.force_scale, base.torque_scale, step.wrench_H);
  }
}

laws::PalpationStep PalpationRuntime::placed_step(HandleMotion handle,
                                                  laws::PalpationState& state) const noexcept {
  handle.X_VH.p += law_.parameters().pose_offset_m;
  laws::PalpationStep out;
  if (stages_.touch_contact()) {
    const Contacts contacts(*this, handle);
    out = law_.step(handle.X_VH, state, &contacts);
    if (felt_without_bending_) add_unbending(contacts, handle.X_VH, out);
  } else {
    out = law_.step(handle.X_VH, state);
  }
  for (const auto& wrench : stages_.wrenches) wrench->add(handle, out.wrench_H);
  return out;
}

laws::PalpationStep PalpationRuntime::step(const HandleMotion& handle,
                                           laws::PalpationState& state) const noexcept {
  return placed_step(handle, state);
}

laws::PalpationStep PalpationRuntime::step(const math::Pose& X_VH,
                                           laws::PalpationState& state) const noexcept {
  return placed_step({.X_VH = X_VH}, state);
}

laws::PalpationStep PalpationRuntime::recorded(const HandleMotion& handle,
                                               laws::PalpationState& state) const noexcept {
  HandleMotion there = handle;
  for (const auto& placement : stages_.placements) placement->place(there.X_VH);
  laws::PalpationStep out = placed_step(there, state);
  for (const auto& offset : stages_.offsets) offset->add(out.wrench_H);
  return out;
}

void PalpationRuntime::follow(const HandleMotion& from, const HandleMotion& to,
                              laws::PalpationState& state) const noexcept {
  const double step_m = kFollowed_voxels * field_->geometry().spacing_m.minCoeff();
  const double way_m =
      (law_.tip_m(to.X_VH, state.deflection_m) - law_.tip_m(from.X_VH, state.deflection_m)).norm();
  const double substeps = std::min(std::ceil(way_m / step_m), kMostSubsteps);
  for (double s = 1.0; s < substeps; ++s) {
    HandleMotion between = to;
    const double share = s / substeps;
    between.X_VH.p = from.X_VH.p + share * (to.X_VH.p - from.X_VH.p);
    between.X_VH.q = from.X_VH.q.slerp(share, to.X_VH.q);
    recorded(between, state);
  }
}

HandleMotion PalpationRuntime::moment(const PalpationMotion& motion,
                                      std::size_t sample) const noexcept {
  return delay_s_ != 0.0 ? motion.at(motion.t_s[sample] - delay_s_) : motion.handle[sample];
}

void PalpationAnswer::resize(std::size_t samples) {
  wrench_H.resize(samples);
  deflection_m.resize(samples);
  converged.resize(samples);
}

void PalpationAnswer::set(std::size_t k, const laws::PalpationStep& step) noexcept {
  wrench_H[k] = step.wrench_H;
  deflection_m[k] = step.deflection_m;
  converged[k] = step.converged;
}

void PalpationRuntime::predict(const PalpationMotion& motion, PalpationAnswer& out,
                               bool from_the_end) const {
  const std::size_t n = motion.t_s.size();
  out.resize(n);
  laws::PalpationState state;
  HandleMotion last;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t k = from_the_end ? n - 1 - i : i;
    const HandleMotion now = moment(motion, k);
    if (i > 0) follow(last, now, state);
    out.set(k, recorded(now, state));
    last = now;
  }
}

void PalpationRuntime::predict_at(const PalpationMotion& motion,
                                  std::span<const std::size_t> samples,
                                  std::span<const math::Vec2> near_m, PalpationAnswer& out) const {
  out.resize(samples.size());
  for (std::size_t j = 0; j < samples.size(); ++j) {
    const std::size_t k = samples[j];
    const std::size_t then = delay_s_ != 0.0 ? motion.nearest(motion.t_s[k] - delay_s_) : k;
    laws::PalpationState state{near_m[then]};
    out.set(j, recorded(moment(motion, k), state));
  }
}

std::size_t PalpationRuntime::field_samples() const noexcept {
  const auto points = std::size_t(law_.parameters().points);
  return stages_.spreads.empty() ? points : points - 1 + stages_.spreads.front()->nodes().size();
}

laws::PalpationStep PalpationRuntime::response(const math::Pose& X_VH, const Contacts& contacts,
                                               const math::Vec2& rest_m) const noexcept {
  const laws::PalpationParameters& base = law_.parameters();
  const laws::Shank& shank = law_.shank();
  const auto n = std::size_t(shank.points);
  const math::Mat3 R = X_VH.q.toRotationMatrix();
  const Eigen::Matrix<double, 3, 2> lateral = R.leftCols<2>();
  math::Vec2 r = shank.stiffness_N_per_m * rest_m;
  math::Mat2 A = shank.stiffness_N_per_m * math::Mat2::Identity();
  std::array<Vec3, laws::kMaxPoints> force_N;
  std::array<Eigen::Matrix<double, 3, 2>, laws::kMaxPoints> slope_N_per_m;
  for (std::size_t i = 0; i < n; ++i) {
    laws::ForceSample bending, unbending;
    contacts.both_at(i, X_VH.p + R * law_.point_H_m(int(i), rest_m), bending, unbending);
    const double shape = shank.shape[i];
    const Eigen::Matrix<double, 3, 2> slope = shape * (bending.jacobian_N_per_m * lateral);
    r -= shape * (lateral.transpose() * bending.force_N);
    A -= shape * (lateral.transpose() * slope);
    force_N[i] = bending.force_N + unbending.force_N;
    slope_N_per_m[i] = slope + shape * (unbending.jacobian_N_per_m * lateral);
  }
  math::Vec2 s = -A.inverse() * r;
  const double most_m = kFarthestResponse_voxels * field_->geometry().spacing_m.minCoeff();
  if (!s.allFinite())
    s.setZero();
  else if (s.norm() > most_m)
    s *= most_m / s.norm();
  laws::PalpationStep out;
  out.deflection_m = rest_m + s;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 F = R.transpose() * (force_N[i] + slope_N_per_m[i] * s);
    out.force_H_N[i] = F;
    laws::add_to_wrench(law_.point_H_m(int(i), out.deflection_m), F, base.force_scale,
                        base.torque_scale, out.wrench_H);
  }
  return out;
}

void PalpationRuntime::respond_at(const PalpationMotion& motion,
                                  std::span<const std::size_t> samples,
                                  std::span<const math::Vec2> rest_m, PalpationAnswer& out,
                                  FieldMemo& memo) const {
  out.resize(samples.size());
  const bool fill = memo.entries.empty();
  if (fill) {
    memo.entries_each = field_samples();
    memo.entries.resize(memo.entries_each * samples.size());
  }
  for (std::size_t j = 0; j < samples.size(); ++j) {
    HandleMotion handle = moment(motion, samples[j]);
    for (const auto& placement : stages_.placements) placement->place(handle.X_VH);
    handle.X_VH.p += law_.parameters().pose_offset_m;
    Contacts::Recall recall{
        std::span(memo.entries).subspan(j * memo.entries_each, memo.entries_each), fill};
    const Contacts contacts(*this, handle, &recall);
    laws::PalpationStep step = response(handle.X_VH, contacts, rest_m[j]);
    for (const auto& wrench : stages_.wrenches) wrench->add(handle, step.wrench_H);
    for (const auto& offset : stages_.offsets) offset->add(step.wrench_H);
    out.set(j, step);
  }
}

math::Vec3 PalpationRuntime::tip_m(const math::Pose& X_VH,
                                   const math::Vec2& deflection_m) const noexcept {
  math::Pose placed = X_VH;
  placed.p += law_.parameters().pose_offset_m;
  return law_.tip_m(placed, deflection_m);
}

}  // namespace models
}  // namespace tractus
