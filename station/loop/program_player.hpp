/// Plays a motion on the probing rig by itself and records what its sensors say: no hand, no law.
#pragma once

#include <atomic>
#include <vector>

#include "core/result.hpp"
#include "station/devices/rig_device.hpp"
#include "station/loop/periodic_loop.hpp"
#include "station/loop/probing_guard.hpp"
#include "trial/motion_program.hpp"
#include "trial/probing_set.hpp"

namespace tractus::loop {

/// What another thread sees and asks while a program is played.
struct Playing {
  std::atomic<double> share = 0.0;  ///< that is done, 0 … 1
  std::atomic<bool> stop = false;   ///< ends the recording
};

/// Speed commands follow the program's own and lead back what is left of the position:
///
///     v = v_program + k (x_program − x),   k = kFollow_per_s
///
/// and a torque turns the probe likewise. What the guard forbids is not done: the recording then ends with an error.
class ProgramPlayer {
 public:
  struct Parts {
    core::Clock& clock;
    devices::RigDevice& device;
    ProbingGuard& guard;  ///< armed and new
  };
  ProgramPlayer(Parts parts, double rate_Hz);

  /// Moves from depth 0, where the stage stands, to the program's start, plays it, and so on as often as asked; each time a trial.
  /// Errors: unavailable naming what the guard or the machine stopped it for; cancelled.
  core::Result<std::vector<trial::ProbingMeasurement>> play(const trial::MotionProgram& program,
                                                            int repetitions, Playing& playing);

  static constexpr double kFollow_per_s = 20.0;
  static constexpr double kApproach_m_s = 0.01;  ///< to the start
  static constexpr double kTurnStiffness_Nm_per_rad = 0.02, kTurnDamping_Nms_per_rad = 0.004;

 private:
  /// One moment of what is played. `trial` is −1 on the way to the start.
  struct Moment {
    double x_m, v_m_s, theta_rad, omega_rad_s;
    int trial;
  };
  std::vector<Moment> schedule(const trial::MotionProgram& program, int repetitions) const;
  void follow_angle(std::int32_t angle_urad) noexcept;

  Parts parts_;
  double rate_Hz_;
  std::int32_t last_urad_ = 0;
  double theta_rad_ = 0.0;
  bool angle_known_ = false;
};

}  // namespace tractus::loop
