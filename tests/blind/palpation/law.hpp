#pragma once
/// The palpation physics of this generator, in double precision, written from the design's page
/// alone.
///
///     k δ = Σ φ(z_i) F_i,⊥(p_i)          p_i = o + R (z_i ẑ + φ(z_i) δ + bow)
///     F* = s_f Σ F_i,  τ* = s_t Σ (p_i − o) × F_i           in the handle's frame
///
/// Rest is found by following the damped flow of δ with growing steps until it is a Newton step,
/// from the last rest.
#include <map>
#include <string>
#include <vector>

#include "palpation/field.hpp"

namespace blind {

using Mat3 = Eigen::Matrix3d;
using Vec2 = Eigen::Vector2d;

struct Probe {
  double force_factor_Nm = 0.005, force_scale = 0.3, torque_scale = 0.3;
  int points = 3;
  double point_spacing_m = 0.009, youngs_modulus_Pa = 1.95e11, length_m = 0.13, radius_m = 0.0007;
  Vec3 offset_m{0, 0, 0};
};

struct Pose {
  Mat3 R;
  Vec3 o_m;
};

struct Wrench {
  Vec3 force_N{0, 0, 0}, torque_Nm{0, 0, 0};
  Wrench operator-(const Wrench& b) const { return {force_N - b.force_N, torque_Nm - b.torque_Nm}; }
};

/// A hidden effect; a scalar parameter is a vector of one.
struct Hidden {
  std::string id;
  std::map<std::string, std::vector<double>> parameters;
  double of(const std::string& name, std::size_t i = 0) const { return parameters.at(name).at(i); }
};

/// Tip-loaded cantilever: stiffness at the tip and the shape φ at the points, integrated
/// numerically so that a taper is no special case.
struct Shank {
  double stiffness_N_per_m = 0;
  std::vector<double> z_m, shape;
};
Shank bend(const Probe& probe, double handle_radius_m, double tip_radius_m);

class PalpationPhysics {
 public:
  PalpationPhysics(const Field& field, const Probe& probe, std::vector<Hidden> effects);
  void begin();
  /// Wrench at `now`; its neighbours `dt_s` away give the velocities. Carries states on.
  Wrench step(const Pose& before, const Pose& now, const Pose& after, double dt_s);
  Vec2 deflection() const { return delta_; }
  long unsettled() const { return unsettled_; }

 private:
  struct Point {
    Vec3 at, velocity, force, late;  ///< late: added to the wrench but not to the bending
  };
  const Hidden* find(const std::string& id) const;
  void place(const Pose& pose, const Vec2& delta);
  Vec3 pushed(std::size_t i, const Vec3& p) const;
  void press(std::size_t i);
  void rub(std::size_t i);
  Vec2 residual(const Pose& pose, const Vec2& delta);
  void settle(const Pose& pose);
  void yield();
  void relax(double dt_s);
  Vec3 local(std::size_t i, const Vec2& delta) const;
  void hang(const Pose& before, const Pose& now, const Pose& after, double dt_s, Wrench& out) const;

  const Field& field_;
  Probe probe_;
  std::vector<Hidden> effects_;
  Shank shank_;
  std::vector<Point> points_;
  std::vector<double> tired_;
  Vec2 delta_{0, 0}, bow_{0, 0};
  Vec3 shift_{0, 0, 0}, yielded_{0, 0, 0};
  long unsettled_ = 0;
};

}  // namespace blind
