/// The palpation law and its effects made ready to run: replay, fit and the live loop step this one
/// object.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/progress.hpp"
#include "effects/palpation_effect.hpp"
#include "laws/palpation_law.hpp"
#include "models/model.hpp"

namespace tractus::models {

/// A recorded motion with its derivatives, one entry per sample.
struct PalpationMotion {
  std::vector<double> t_s;
  std::vector<effects::HandleMotion> handle;

  /// By the spline through the poses (math::PoseSpline). Errors: bad_input.
  static core::Result<PalpationMotion> through(std::span<const double> t_s,
                                               std::span<const math::Pose> X_VH,
                                               const math::Vec3& down = -math::Vec3::UnitZ());
  /// How the handle moved at t, from the sample nearest to it on: exact to the third power of the
  /// time between. Before the first and after the last it rests where it was.
  effects::HandleMotion at(double t_s) const noexcept;
  std::size_t nearest(double t_s) const noexcept;  ///< sample
};

/// What a sensor would have said over a recording, one entry per sample.
struct PalpationAnswer {
  std::vector<math::Wrench> wrench_H;
  std::vector<math::Vec2> deflection_m;  ///< δ of the tip, in H
  std::vector<std::uint8_t> converged;   ///< 1 where the equilibrium was reached

  void resize(std::size_t samples);
  void set(std::size_t k, const laws::PalpationStep& step) noexcept;
};

/// What the field was at the contact points of a model at rest, so that models near it need not ask
/// again where their points are the same.
struct FieldMemo {
  struct Entry {
    math::Vec3 p_m;
    volume::FieldSample at;
  };
  std::vector<Entry> entries;    ///< [sample][point of the field asked for], in their order
  std::size_t entries_each = 0;  ///< per sample
};

/// A model on a volume. Immutable: safe to use from several threads at once.
///
/// The wrench is that of laws::PalpationLaw with the effects at their stages
/// (effects/palpation_effect.hpp). What a hand feels (`step`) has force and structure effects; what
/// a sensor says (`recorded`) has measurement effects too.
class PalpationRuntime {
 public:
  static core::Result<PalpationRuntime> make(const PalpationModel& model,
                                             const volume::Volume& volume,
                                             const core::Progress& progress = {});
  /// On a field that is there already, made with the model's transfer function and kind; it must
  /// outlive this. Microseconds, so a fit makes one for each set of numbers.
  /// Errors: out_of_range, bad_input or not_found naming the parameter or the effect.
  static core::Result<PalpationRuntime> make(const PalpationModel& model,
                                             const volume::ForceField& field);

  /// One tick for a hand: the handle as the device gives it; the model's pose offset is applied
  /// here, measurement effects are left out. No allocation, lock or failure.
  laws::PalpationStep step(const effects::HandleMotion& handle,
                           laws::PalpationState& state) const noexcept;
  /// The same for a handle at rest.
  laws::PalpationStep step(const math::Pose& X_VH, laws::PalpationState& state) const noexcept;
  /// One sample as a sensor would have said it, but for the delay: the handle is that of the motion
  /// `delay_s()` earlier. No allocation, lock or failure.
  laws::PalpationStep recorded(const effects::HandleMotion& handle,
                               laws::PalpationState& state) const noexcept;
  /// How much later than the motion a force is recorded, s.
  double delay_s() const noexcept { return delay_s_; }

  /// A whole recording, delay included. Between two samples the rest of the shank is followed in
  /// steps that move the tip by at most a third of a voxel; the first sample starts from the unbent
  /// shank.
  /// @param from_the_end  as if the motion had run backwards: where the shank can rest in two
  /// places it comes to the other. The velocities stay those of the motion as it ran.
  void predict(const PalpationMotion& motion, PalpationAnswer& out,
               bool from_the_end = false) const;
  /// At some samples alone, one entry of `out` per entry of `samples`.
  /// @param near_m  deflections of a model near this one, one per sample of the motion: where the
  /// search for each rest begins, so that a small change of numbers changes no rest for another.
  void predict_at(const PalpationMotion& motion, std::span<const std::size_t> samples,
                  std::span<const math::Vec2> near_m, PalpationAnswer& out) const;
  /// The same to first order, staying with the rests of a model near this one: one Newton step from
  /// there, at most a fifth of a voxel long, and the forces to first order along it. So a
  /// derivative by differences sees no jump from rest to rest.
  /// @param rest_m  that model's rests, one per entry of `samples`. @param memo  if empty it is
  /// filled with what is asked of the field; else it says what was found near by.
  void respond_at(const PalpationMotion& motion, std::span<const std::size_t> samples,
                  std::span<const math::Vec2> rest_m, PalpationAnswer& out, FieldMemo& memo) const;

  /// Tip of the bent probe in V for that pose, offset applied, m.
  math::Vec3 tip_m(const math::Pose& X_VH, const math::Vec2& deflection_m) const noexcept;
  const laws::PalpationLaw& law() const noexcept { return law_; }
  const volume::ForceField& field() const noexcept { return *field_; }

 private:
  class Contacts;
  /// The effects by stage, each in the catalogue's order.
  struct Stages {
    std::vector<std::unique_ptr<effects::PosePlacement>> placements;
    std::vector<std::unique_ptr<effects::TipSpread>> spreads;
    std::vector<std::unique_ptr<effects::ContactField>> fields;
    std::vector<std::unique_ptr<effects::ContactLoss>> losses;
    std::vector<std::unique_ptr<effects::PointForce>> forces;
    std::vector<std::unique_ptr<effects::HandleWrench>> wrenches;
    std::vector<std::unique_ptr<effects::SensorOffset>> offsets;

    bool touch_contact() const noexcept {
      return !(spreads.empty() && fields.empty() && losses.empty() && forces.empty());
    }
  };
  PalpationRuntime(const volume::ForceField& field, laws::PalpationLaw law)
      : field_(&field), law_(std::move(law)) {}
  core::Result<void> add(const effects::EffectInstance& use);
  /// What is felt and does not bend the shank, on top of a step.
  void add_unbending(const Contacts& contacts, const math::Pose& X_VH,
                     laws::PalpationStep& step) const noexcept;
  laws::PalpationStep placed_step(effects::HandleMotion handle,
                                  laws::PalpationState& state) const noexcept;
  laws::PalpationStep response(const math::Pose& X_VH, const Contacts& contacts,
                               const math::Vec2& rest_m) const noexcept;
  effects::HandleMotion moment(const PalpationMotion& motion, std::size_t sample) const noexcept;
  void follow(const effects::HandleMotion& from, const effects::HandleMotion& to,
              laws::PalpationState& state) const noexcept;

  std::unique_ptr<volume::ForceField> owned_;
  const volume::ForceField* field_;
  laws::PalpationLaw law_;
  Stages stages_;
  double delay_s_ = 0.0;
  bool felt_without_bending_ = false;
  std::size_t field_samples() const noexcept;  ///< asked for in one evaluation of all points
};

}  // namespace tractus::models
