/// Parameters of the effects: ranges of the literature for the shapes, a first guess for the sizes.
#include "probing/draw.hpp"
#include "support/angle.hpp"

namespace blind {
namespace {

using Draw = Parameters (*)(Random&, const Base&);

struct Entry {
  Draw draw;
  std::vector<std::string> amplitudes;
  double low, high;  ///< of the first amplitude
};

Parameters stribeck(Random& r, const Base&) {
  return {{"friction_N", 2.0},
          {"breakaway_N", 2.0 * r.uniform(1.35, 2.2)},
          {"stribeck_velocity_m_s", r.log_uniform(1e-3, 8e-3)}};
}
Parameters relaxation(Random& r, const Base&) {
  return {{"stiffness_N_per_m", 1000.0}, {"time_constant_s", r.log_uniform(0.08, 3.0)}};
}
Parameters hysteresis(Random& r, const Base&) {
  const double yield = r.log_uniform(1.5e-4, 1.5e-3);
  return {{"stiffness_N_per_m", 2.0 / yield}, {"yield_displacement_m", yield}};
}
Parameters ripple(Random& r, const Base&) {
  return {{"amplitude_N", 2.0},
          {"period_m", r.log_uniform(5e-4, 3e-3)},
          {"phase_rad", r.uniform(0, kTwoPi)}};
}
Parameters two_branch(Random& r, const Base&) {
  return {{"fast_stiffness_N_per_m", 4000.0 * r.uniform(0.6, 1.6)},
          {"fast_time_s", r.log_uniform(0.04, 0.12)},
          {"slow_stiffness_N_per_m", 800.0 * r.uniform(0.6, 1.6)},
          {"slow_time_s", r.log_uniform(2.0, 6.0)}};
}
Parameters fracture(Random& r, const Base& base) {
  return {{"rise_N_per_m", 8000.0}, {"spacing_m", base.end_m() * r.uniform(0.05, 0.15)}};
}

const std::map<std::string, Entry>& entries() {
  static const std::map<std::string, Entry> kEntries = {
      {"inertia",
       {[](Random&, const Base&) {
          return Parameters{{"mass_kg", 10.0}};
        },
        {"mass_kg"},
        0.2,
        50}},
      {"coulomb_friction",
       {[](Random&, const Base&) {
          return Parameters{{"friction_N", 2.0}};
        },
        {"friction_N"},
        0.2,
        10}},
      {"stribeck_friction", {stribeck, {"friction_N", "breakaway_N"}, 0.2, 10}},
      {"quadratic_drag",
       {[](Random&, const Base&) {
          return Parameters{{"coefficient_Ns2_per_m2", 2e4}};
        },
        {"coefficient_Ns2_per_m2"},
        1e2,
        1e6}},
      {"viscoelastic_relaxation", {relaxation, {"stiffness_N_per_m"}, 30, 2e4}},
      {"hysteresis", {hysteresis, {"stiffness_N_per_m"}, 100, 1e5}},
      {"backlash",
       {[](Random& r, const Base&) {
          return Parameters{{"gap_m", 4e-4}, {"of_hand", r.chance(0.5) ? 1.0 : 0.0}};
        },
        {"gap_m"},
        2e-5,
        2e-3}},
      {"depth_friction",
       {[](Random&, const Base&) {
          return Parameters{{"slope_N_per_m", 150.0}};
        },
        {"slope_N_per_m"},
        5,
        800}},
      {"rotation_coupling",
       {[](Random&, const Base&) {
          return Parameters{{"coefficient_s_per_rad", 0.06}};
        },
        {"coefficient_s_per_rad"},
        0.005,
        1.0}},
      {"force_ripple", {ripple, {"amplitude_N"}, 0.2, 10}},
      {"sensor_bias",
       {[](Random& r, const Base&) {
          return Parameters{{"force_N", 2.0 * r.sign()}};
        },
        {"force_N"},
        0.1,
        10}},
      {"sensor_drift",
       {[](Random&, const Base&) {
          return Parameters{{"range_N", 3.0}};
        },
        {"range_N"},
        0.1,
        20}},
      {"time_delay",
       {[](Random&, const Base&) {
          return Parameters{{"delay_s", 0.02}};
        },
        {"delay_s"},
        0.001,
        0.12}},
      {"torque_crosstalk",
       {[](Random& r, const Base&) {
          return Parameters{{"coefficient_per_m", 40.0 * r.sign()}};
        },
        {"coefficient_per_m"},
        1,
        500}},
      {"direction_damping",
       {[](Random&, const Base&) {
          return Parameters{{"asymmetry", 0.2}};
        },
        {"asymmetry"},
        0.02,
        0.9}},
      {"load_friction",
       {[](Random&, const Base&) {
          return Parameters{{"coefficient", 0.07}};
        },
        {"coefficient"},
        0.01,
        0.3}},
      {"bone_texture",
       {[](Random& r, const Base&) {
          return Parameters{{"amplitude_N", 2.0}, {"length_m", r.log_uniform(4e-4, 2e-3)}};
        },
        {"amplitude_N"},
        0.1,
        10}},
      {"tract_wear",
       {[](Random&, const Base&) {
          return Parameters{{"loss_per_pass", 0.01}};
        },
        {"loss_per_pass"},
        5e-4,
        0.2}},
      {"stiffness_nonlinearity",
       {[](Random&, const Base&) {
          return Parameters{{"curvature_per_m", 30.0}};
        },
        {"curvature_per_m"},
        1,
        1000}},
      {"lateral_load",
       {[](Random&, const Base&) {
          return Parameters{{"amplitude_N", 2.0}};
        },
        {"amplitude_N"},
        0.1,
        20}},
      {"two_branch_relaxation",
       {two_branch, {"fast_stiffness_N_per_m", "slow_stiffness_N_per_m"}, 30, 5e4}},
      {"fracture", {fracture, {"rise_N_per_m"}, 100, 1e5}}};
  return kEntries;
}

}  // namespace

const std::vector<std::string>& catalogue() {
  static const std::vector<std::string> kIds = {"inertia",
                                                "coulomb_friction",
                                                "stribeck_friction",
                                                "quadratic_drag",
                                                "viscoelastic_relaxation",
                                                "hysteresis",
                                                "backlash",
                                                "depth_friction",
                                                "rotation_coupling",
                                                "force_ripple",
                                                "sensor_bias",
                                                "sensor_drift",
                                                "time_delay",
                                                "torque_crosstalk"};
  return kIds;
}

const std::vector<std::string>& outside_kinds() {
  static const std::vector<std::string> kIds = {
      "direction_damping",      "load_friction", "bone_texture",          "tract_wear",
      "stiffness_nonlinearity", "lateral_load",  "two_branch_relaxation", "fracture"};
  return kIds;
}

HiddenEffect draw_effect(Random& random, const std::string& id, const Base& base) {
  return {id, entries().at(id).draw(random, base)};
}

std::vector<std::string> amplitudes_of(const std::string& id) {
  return entries().at(id).amplitudes;
}

bool plausible(const HiddenEffect& effect) {
  const Entry& entry = entries().at(effect.id);
  const double size = std::abs(effect.parameters.at(entry.amplitudes.front()));
  return size >= entry.low && size <= entry.high;
}

bool on_record_only(const std::string& id) {
  return id.starts_with("sensor_") || id == "time_delay" || id == "torque_crosstalk";
}

}  // namespace blind
