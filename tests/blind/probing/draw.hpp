#pragma once
/// What a set is: everything random about it, drawn from its seed.
#include <cstdint>
#include <string>
#include <vector>

#include "probing/law.hpp"
#include "probing/motion.hpp"

namespace blind {

/// What the command line asks for; an empty `kind` is drawn from the seed.
struct Request {
  std::uint64_t seed = 0;
  std::string kind;              ///< "", "single", "pair", "none", "base_wrong" or "outside"
  std::vector<std::string> ids;  ///< of the effects, when they are not to be drawn
  int trials = 10;
  double duration_s = 8.0, rate_Hz = 1000.0;
};

struct Recording {
  bool averaging = true;  ///< a sample is the mean over its interval, else the value at its time
  double force_noise_N = 0.05, force_step_N = 0, position_noise_m = 5e-7, position_step_m = 0;
  double angle_noise_rad = 2e-4, angle_step_rad = 0, torque_noise_Nm = 2e-4, torque_step_Nm = 0;
  bool rotation_channels = true;
};

/// The model that the lab is given: the base alone, perhaps wrong in its numbers.
struct SuppliedBase {
  Base base;
  std::vector<std::string> fixed;  ///< JSON pointers
  std::string how;
};

struct SetPlan {
  Request request;
  std::string kind;
  Base truth;
  SuppliedBase supplied;
  std::vector<HiddenEffect> effects;
  std::vector<double> strengths;  ///< wanted, share of the force's RMS
  std::vector<TrialPlan> trials;
  Recording recording;
  bool sticking = false;  ///< friction may hold the hand still in closed loop
};

const std::vector<std::string>& catalogue();
const std::vector<std::string>& outside_kinds();

SetPlan draw_plan(const Request& request);

/// Forces of the base alone brought to a person's size: stiffness and damping scaled to `rms_N`.
void scale_base(SetPlan& plan, double factor);

/// The supplied model drawn about the truth (call when the truth is final).
void draw_supplied(SetPlan& plan);

HiddenEffect draw_effect(Random& random, const std::string& id, const Base& base);
/// The parameters that set an effect's size; the others are its shape.
std::vector<std::string> amplitudes_of(const std::string& id);
/// Whether the amplitudes are of a size that such a rig can have.
bool plausible(const HiddenEffect& effect);
bool on_record_only(const std::string& id);  ///< an effect of the measurement

}  // namespace blind
