#include "station/rig/surgeon.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tractus {
namespace rig {

namespace {
constexpr double kTremor_Hz = 9.0;
constexpr double kMostTurn_Nm = 1.0;
constexpr double kEntry_m = 5e-4;  // nearer than this a person takes the stage to be at the entry
constexpr double kNovice = 0.25, kMaster = 0.95, kHalfway_years = 2.0;
}  // namespace

SurgeonParameters SurgeonParameters::of_skill(double skill) {
  const double s = std::clamp(skill, 0.0, 1.0);
  SurgeonParameters p;
  p.reaction_s = std::lerp(0.30, 0.15, s);
  p.tremor_N = std::lerp(2.0, 0.5, s);
  p.speed_goal_m_s = std::lerp(0.008, 0.005, s);
  return p;
}

double SurgeonParameters::skill_of_experience(double years) {
  return std::lerp(kNovice, kMaster, 1.0 - std::exp2(-std::max(years, 0.0) / kHalfway_years));
}

Surgeon::Surgeon(const SurgeonParameters& parameters, std::uint64_t seed)
    : typical_(parameters), p_(parameters), random_(seed) {}

void Surgeon::begin(double x_m) {
  std::uniform_real_distribution<double> about(0.9, 1.1);
  p_ = typical_;
  p_.speed_goal_m_s *= about(random_);
  p_.reaction_s *= about(random_);
  p_.turning_rad_s *= about(random_);
  phase_rad_ = 2.0 * std::numbers::pi * about(random_);
  goal_m_ = x_m;
  time_s_ = 0.0;
  startled_at_s_ = -1.0;
  // A stage that is enabled away from the entry may be on its way back: a person looks first.
  resting_until_s_ = x_m > kEntry_m ? p_.reaction_s : -1.0;
}

void Surgeon::step(double x_m, double v_m_s, double omega_rad_s, bool enabled, double dt_s) {
  if (enabled && !at_work_) begin(x_m);
  off_s_ = enabled ? 0.0 : off_s_ + dt_s;
  at_work_ = enabled || (at_work_ && off_s_ < p_.reaction_s);
  if (!at_work_) {
    push_N_ = turn_Nm_ = 0.0;
    return;
  }
  time_s_ += dt_s;
  turn_Nm_ = std::clamp(p_.wrist_Nms_per_rad * (p_.turning_rad_s - omega_rad_s), -kMostTurn_Nm,
                        kMostTurn_Nm);
  if (startled_at_s_ < 0.0 && time_s_ >= resting_until_s_ &&
      v_m_s > p_.startle_factor * p_.speed_goal_m_s)
    startled_at_s_ = time_s_ + p_.reaction_s;
  if (startled_at_s_ >= 0.0 && time_s_ >= startled_at_s_) {
    resting_until_s_ = time_s_ + p_.pause_s;
    startled_at_s_ = -1.0;
  }
  const bool hands_off = push_N_ == 0.0 && x_m > kEntry_m;
  const bool returning = v_m_s < -p_.speed_goal_m_s;
  if (time_s_ < resting_until_s_ || (hands_off && returning)) {
    goal_m_ = x_m;
    push_N_ = 0.0;
    return;
  }
  const double lead_m = p_.most_push_N / p_.stiffness_N_per_m;
  goal_m_ = std::min(goal_m_ + p_.speed_goal_m_s * dt_s, x_m + lead_m);
  const double tremor =
      p_.tremor_N * std::sin(2.0 * std::numbers::pi * kTremor_Hz * time_s_ + phase_rad_);
  push_N_ = std::clamp(p_.stiffness_N_per_m * (goal_m_ - x_m) +
                           p_.damping_Ns_per_m * (p_.speed_goal_m_s - v_m_s) + tremor,
                       0.0, p_.most_push_N);
}

}  // namespace rig
}  // namespace tractus
