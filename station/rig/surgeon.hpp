/// A SIMULATED surgeon's hand on the probe, for work without a person. Not a measurement of anyone.
#pragma once

#include <cstdint>
#include <random>

namespace tractus::rig {

/// Plausible choices of ours. `of_skill` varies them; a seed varies each attempt by a tenth.
struct SurgeonParameters {
  double stiffness_N_per_m = 3000.0;  ///< of hand and arm along the probe
  double damping_Ns_per_m = 150.0;
  double speed_goal_m_s = 0.006;  ///< that the hand wants to advance at
  double most_push_N = 150.0;
  double reaction_s = 0.2;      ///< from a jump in speed to letting go
  double startle_factor = 4.0;  ///< a jump is a speed above so many times the goal
  double pause_s = 0.5;         ///< of letting go, before going on
  double turning_rad_s = 0.8;   ///< that the wrist wants
  double wrist_Nms_per_rad = 0.05;
  double tremor_N = 1.0;  ///< amplitude at 9 Hz

  /// @param skill  0 … 1: reacts sooner, trembles less, advances more slowly.
  static SurgeonParameters of_skill(double skill);
  /// Skill that a simulated surgeon of so many years has: 0.25 with none, halfway to 0.95 after
  /// two. A choice of ours, so that a simulated study has something to find; the published one
  /// found no significant dependence of recognition on experience.
  static double skill_of_experience(double years);
};

/// Pushes while the drive is enabled: spring and damper to a point that advances at the speed goal.
/// What it perceives of the stage's speed reaches it only after its reaction time. A hand that is
/// off a stage which returns to the entry stays off until the stage is there.
class Surgeon {
 public:
  Surgeon(const SurgeonParameters& parameters, std::uint64_t seed);
  /// One step; the drive's state is what a person sees on the panel, its reaction time later.
  void step(double x_m, double v_m_s, double omega_rad_s, bool enabled, double dt_s);
  double push_N() const noexcept { return push_N_; }
  double turn_Nm() const noexcept { return turn_Nm_; }

 private:
  void begin(double x_m);
  SurgeonParameters typical_, p_;
  std::mt19937_64 random_;
  bool at_work_ = false;
  double off_s_ = 0.0;  // since the drive went off
  double goal_m_ = 0.0, time_s_ = 0.0, phase_rad_ = 0.0;
  double startled_at_s_ = -1.0;  // when it will react; below 0: nothing has startled it
  double resting_until_s_ = -1.0;
  double push_N_ = 0.0, turn_Nm_ = 0.0;
};

}  // namespace tractus::rig
