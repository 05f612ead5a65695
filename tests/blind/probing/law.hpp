#pragma once
/// The probing rig's physics of this generator: layers, rotary stage, hidden effects. Written from
/// the design's equations alone; nothing of the product is included or linked.
///
///     F = K_i (x − x0_i) + D_i v + effects                     resisting force, zero outside the
///     layers τ = b ω + T sin(2π θ / p)                                rotary stage: viscous and
///     detents
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "support/random.hpp"

namespace blind {

struct Layer {
  double start_m, thickness_m, stiffness_N_per_m, damping_Ns_per_m, equilibrium_m;
};

struct Rotary {
  double viscous_Nms_per_rad = 0, detent_Nm = 0, detent_pitch_rad = 1;
};

struct Base {
  std::vector<Layer> layers;
  Rotary rotary;
  /// The layer that holds depth x, or null outside all of them.
  const Layer* at(double x_m) const;
  double end_m() const { return layers.back().start_m + layers.back().thickness_m; }
};

/// What moves, at one instant. x positive into the bone.
struct Moment {
  double t_s = 0, x_m = 0, v_m_s = 0, a_m_s2 = 0, theta_rad = 0, omega_rad_s = 0;
};

/// F = rest + damping v + drag v|v| + friction sgn v + mass a.
struct Resistance {
  double rest_N = 0, damping_Ns_per_m = 0, drag_Ns2_per_m2 = 0, friction_N = 0, mass_kg = 0;
};

using Parameters = std::map<std::string, double>;

/// What a trial is about, for effects that are drawn anew in each or live across trials.
struct TrialContext {
  int index = 0;
  double duration_s = 0, depth_m = 0;  ///< depth_m: end of the layers
  std::uint64_t seed = 0;
};

/// One hidden effect on the force. Every hook has the meaning "nothing" unless an effect overrides
/// it.
class Term {
 public:
  virtual ~Term() = default;
  virtual void begin(const TrialContext&, const Moment&) {}
  /// Depth and speed as the bone sees them.
  virtual Moment seen(const Moment& m) const { return m; }
  /// What the base resistance is multiplied with.
  virtual double base_factor(const Moment&) const { return 1.0; }
  /// Adds to the resistance; `base_N` is the base's force at this moment.
  virtual void add(const Moment&, const Layer*, double /*base_N*/, Resistance&) const {}
  /// Carries own states from one instant to the next.
  virtual void step(const Moment& /*from*/, const Moment& /*to*/) {}
};

struct HiddenEffect {
  std::string id;
  Parameters parameters;
};

/// Null for an effect of the measurement (it acts on the record, not on the force).
std::unique_ptr<Term> make_term(const HiddenEffect& effect, std::uint64_t set_seed);

/// Base and hidden effects with the states of one trial.
class Physics {
 public:
  Physics(Base base, const std::vector<HiddenEffect>& effects, std::uint64_t set_seed);
  void begin(const TrialContext& trial, const Moment& first);
  Resistance at(const Moment& m) const;
  /// Resisting force; at v = 0 friction keeps the sign that it had.
  double force(const Moment& m) const;
  void step(const Moment& from, const Moment& to);
  const Base& base() const { return base_; }

 private:
  Base base_;
  std::vector<std::unique_ptr<Term>> terms_;
  double last_sign_ = 0;
};

double sign_of(double value);

}  // namespace blind
