/// Effects of the palpation law: the stages at which one may act, and the catalogue of them.
///
/// A stage is a class with one function; an effect is one stage's object, made once from its
/// numbers. In the order in which a wrench comes about:
///
///     time       MotionDelay     when the motion was that a force recorded at t belongs to
///     pose       PosePlacement   where the handle is in the volume
///     shank      ShankForm       stiffness, shape, unloaded bow (once, when the model is made)
///     spread     TipSpread       where about the tip the field is taken
///     field      ContactField    the force factor c_f g(p) and its Jacobian at a point
///     loss       ContactLoss     the share of it that remains, given how the point moves
///     point      PointForce      what adds to the force at a point (friction, damping)
///     handle     HandleWrench    what adds to the wrench at the handle (weight, inertia)
///     recording  SensorOffset    what the sensor says on top
///
/// Spread, field, loss and point act in F_i, and so in the equilibrium of the shank and in F* and
/// τ*. The velocity of a point is that of the unbent shank: it does not change while the shank
/// finds its rest. Two effects of one stage act in the order of the catalogue.
///
/// All are const and free of state, never allocate and never fail: the same objects serve replay,
/// fit and the live tick. Everything is in V unless a name says otherwise.
#pragma once

#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "core/result.hpp"
#include "effects/effect.hpp"
#include "laws/equilibrium.hpp"
#include "laws/shank.hpp"
#include "math/geometry.hpp"
#include "volume/force_field.hpp"

namespace tractus::effects {

using math::Mat3;
using math::Vec3;

class MotionDelay {
 public:
  virtual ~MotionDelay() = default;
  /// How long after the motion its force is recorded, s.
  virtual double delay_s() const noexcept = 0;
};

class PosePlacement {
 public:
  virtual ~PosePlacement() = default;
  virtual void place(math::Pose& X_VH) const noexcept = 0;
};

class ShankForm {
 public:
  virtual ~ShankForm() = default;
  /// Changes the uniform straight shank of the base.
  virtual void form(laws::Shank& shank) const noexcept = 0;
};

class TipSpread {
 public:
  virtual ~TipSpread() = default;
  /// Points about the tip, in any frame's directions, and weights that sum to 1; lives as long as
  /// this. The tip's force is the weighted mean of theirs.
  struct Node {
    Vec3 offset_m;
    double weight;
  };
  virtual std::span<const Node> nodes() const noexcept = 0;
};

class ContactField {
 public:
  virtual ~ContactField() = default;
  /// Changes g and its Jacobian; the force is c_f g.
  virtual void change(volume::FieldSample& at) const noexcept = 0;
};

/// A contact point as the later stages see it.
struct PointContact {
  Vec3 p_m;                         ///< of the bent shank
  Vec3 v_m_s;                       ///< of the unbent shank
  const volume::ForceField* field;  ///< for (ω∗α)(p)
};

class ContactLoss {
 public:
  virtual ~ContactLoss() = default;
  /// Changes a point's elastic force, and its derivative with p, by how the point moves.
  virtual void change(const PointContact& point, laws::ForceSample& elastic) const noexcept = 0;
};

class PointForce {
 public:
  virtual ~PointForce() = default;
  /// Adds to `total`, a point's force and its derivative with p, given the elastic part of it.
  virtual void add(const PointContact& point, const laws::ForceSample& elastic,
                   laws::ForceSample& total) const noexcept = 0;
  /// How much of it takes part in the rest of the shank, 0 … 1; all of it is felt at the handle.
  virtual double bending_share() const noexcept { return 1.0; }
};

/// How the handle moves.
struct HandleMotion {
  math::Pose X_VH;                   ///< placed
  Vec3 v_m_s = Vec3::Zero();         ///< of the handle's origin
  Vec3 omega_rad_s = Vec3::Zero();   ///< of the handle
  Vec3 a_m_s2 = Vec3::Zero();        ///< of the handle's origin
  Vec3 alpha_rad_s2 = Vec3::Zero();  ///< of the handle
  Vec3 down = -Vec3::UnitZ();        ///< unit vector along gravity
};

/// Of the forces that act at points besides the elastic one: the law's sums let them bend the shank
/// (1, which is meant where a file does not say), a force that was added to a finished simulation
/// does not (0).
inline Param bends_shank() {
  return {.name = "bends_shank",
          .meaning = "how much of the force takes part in the rest of the shank",
          .initial = 1.0,
          .low = 0.0,
          .high = 1.0,
          .off = kNoOff,
          .if_missing = 1.0,
          .unit = "1",
          .step = 0.05};
}

class HandleWrench {
 public:
  virtual ~HandleWrench() = default;
  /// Adds to the wrench on the probe at the handle's origin, in H.
  virtual void add(const HandleMotion& motion, math::Wrench& wrench_H) const noexcept = 0;
};

class SensorOffset {
 public:
  virtual ~SensorOffset() = default;
  /// Adds to what the sensor says at the origin of H, in H.
  virtual void add(math::Wrench& wrench_H) const noexcept = 0;
};

/// An effect: the object of the stage that it acts at. The last alternative is an effect without a
/// stage: its course is free in each trial (sensor_drift), and a model cannot know it.
struct FreePerTrial {};
using PalpationEffect = std::variant<std::unique_ptr<MotionDelay>, std::unique_ptr<PosePlacement>,
                                     std::unique_ptr<ShankForm>, std::unique_ptr<TipSpread>,
                                     std::unique_ptr<ContactField>, std::unique_ptr<ContactLoss>,
                                     std::unique_ptr<PointForce>, std::unique_ptr<HandleWrench>,
                                     std::unique_ptr<SensorOffset>, FreePerTrial>;

/// What base and recordings show before an effect is added, for the numbers that its search begins
/// with.
struct PalpationStatistics {
  double radius_m = 0.0;     ///< of the base's shank
  double field_per_m = 0.0;  ///< |g| where the recordings touch bone, median
};

struct PalpationEffectInfo {
  EffectFacts facts;
  /// @param values  in the order of facts.params, components flattened, already within their ranges
  PalpationEffect (*make)(std::span<const double> values);
  /// Starts that depend on base and recordings. Null: facts.starts.
  Starts (*starts)(const PalpationStatistics& known) = nullptr;
  /// A parameter of the base that the effect's numbers take the place of: where all of them equal
  /// it, nothing is changed, and a fit moves it no longer in a model that has the effect. Null: none.
  double laws::PalpationParameters::*replaces = nullptr;
};

/// The catalogue of palpation, in the order of the ids; made from the files of palpation/.
const std::vector<PalpationEffectInfo>& palpation_effects();
/// The entry of an id; null where the catalogue has none.
const PalpationEffectInfo* find_palpation_effect(std::string_view id);

/// What is known of an effect in a model, of the catalogue or a user's own; its numbers do not
/// matter. Errors: not_found naming the id; bad_input naming what is wrong in a definition.
core::Result<EffectFacts> palpation_facts(const EffectInstance& use);

/// The effect of an id with its numbers. Errors: not_found naming the id; bad_input or out_of_range
/// naming the parameter, its value and its range.
core::Result<PalpationEffect> make_palpation_effect(const EffectInstance& use);

}  // namespace tractus::effects
