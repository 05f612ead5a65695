/// Parameters of the palpation effects, and how their size grows.
#include "palpation/draw_effect.hpp"

#include <algorithm>
#include <cmath>

#include "support/angle.hpp"

namespace blind {
namespace {

using Values = std::map<std::string, std::vector<double>>;

std::vector<double> scaled(const Vec3& way, double size) {
  const Vec3 v = size * way.normalized();
  return {v[0], v[1], v[2]};
}

Vec3 any_way(Random& r) {
  const double x = r.normal(), y = r.normal(), z = r.normal();
  return {x, y, z};
}

Values drag(Random& r, const std::string& name, double size) {
  return {{name, {size}}, {"bends_shank", {r.chance(0.5) ? 1.0 : 0.0}}};
}

Values values(Random& r, const std::string& id, const Probe& probe, const Tract& tract) {
  if (id == "contact_friction") return drag(r, "coefficient", 0.15);
  if (id == "contact_damping") return drag(r, "damping_Ns_per_m", 5.0);
  if (id == "contact_nonlinearity")
    return {{"exponent", {1.0 + 0.15 * (r.chance(0.7) ? 1 : -1)}},
            {"reference_gradient_per_m", {r.uniform(150, 400)}}};
  if (id == "contact_hysteresis") return {{"loss", {0.12}}};
  if (id == "shank_taper")
    return {{"handle_radius_m", {1.12 * probe.radius_m}}, {"tip_radius_m", {0.9 * probe.radius_m}}};
  if (id == "shank_curvature")
    return {{"bow_m", {4e-4}}, {"direction_rad", {r.uniform(0, kTwoPi)}}};
  if (id == "pose_offset") return {{"offset_m", scaled(any_way(r), 1e-4)}};
  if (id == "tip_ball") return {{"radius_m", {8e-4}}};
  if (id == "probe_weight") return {{"mass_kg", {0.006}}, {"centre_m", {r.uniform(0.02, 0.09)}}};
  if (id == "probe_inertia") return {{"mass_kg", {0.08}}, {"centre_m", {r.uniform(0.02, 0.09)}}};
  if (id == "sensor_bias")
    return {{"force_N", scaled(any_way(r), 0.05)},
            {"torque_Nm", scaled(any_way(r), 0.05 * r.uniform(0.02, 0.1))}};
  if (id == "sensor_drift") return {{"range_N", {0.08}}};
  if (id == "time_delay") return {{"delay_s", {0.01}}};
  if (id == "bone_compliance") return {{"compliance_m_per_N", {5e-5}}};
  if (id == "anisotropic_stiffness") return {{"anisotropy", {0.15}}};
  if (id == "porous_stiffness") return {{"exponent", {0.25}}};
  if (id == "contact_relaxation") return {{"share", {0.2}}, {"time_s", {r.log_uniform(0.3, 2.0)}}};
  const Vec3 centre = tract.entry_m + r.uniform(0.45, 0.8) * tract.depth_m * tract.along +
                      0.6 * tract.radius_m * (r.sign() * tract.across);
  return {{"force_N", {0.5}},
          {"reach_m", {r.uniform(0.002, 0.004)}},
          {"centre_m", {centre[0], centre[1], centre[2]}},
          {"along", {tract.along[0], tract.along[1], tract.along[2]}}};
}

struct Size {
  const char* name;
  double low, high, order;  ///< order: the effect grows as size to this power
};

Size size_of(const std::string& id) {
  if (id == "contact_friction") return {"coefficient", 0.01, 0.9, 1};
  if (id == "contact_damping") return {"damping_Ns_per_m", 0.02, 80, 1};
  if (id == "contact_hysteresis") return {"loss", 0.01, 0.7, 1};
  if (id == "shank_curvature") return {"bow_m", 2e-5, 4e-3, 1};
  if (id == "tip_ball") return {"radius_m", 1e-4, 3e-3, 2};
  if (id.starts_with("probe_")) return {"mass_kg", 5e-4, 0.35, 1};
  if (id == "sensor_drift") return {"range_N", 0.003, 3, 1};
  if (id == "time_delay") return {"delay_s", 0.0005, 0.1, 1};
  if (id == "bone_compliance") return {"compliance_m_per_N", 1e-6, 1e-3, 1};
  if (id == "anisotropic_stiffness") return {"anisotropy", 0.01, 0.8, 1};
  if (id == "porous_stiffness") return {"exponent", 0.01, 3, 1};
  if (id == "contact_relaxation") return {"share", 0.01, 0.9, 1};
  if (id == "pose_offset") return {"offset_m", 1e-6, 2e-3, 1};
  return {"force_N", 0.003, 20, 1};
}

}  // namespace

Hidden draw_hidden(Random& random, const std::string& id, const Probe& probe, const Tract& tract) {
  return {id, values(random, id, probe, tract)};
}

void enlarge(Hidden& effect, double factor, const Probe& probe) {
  auto& p = effect.parameters;
  if (effect.id == "contact_nonlinearity") {
    double& exponent = p["exponent"][0];
    exponent = 1.0 + factor * (exponent - 1.0);
    return;
  }
  if (effect.id == "shank_taper") {
    for (const char* end : {"handle_radius_m", "tip_radius_m"})
      p[end][0] = probe.radius_m + factor * (p[end][0] - probe.radius_m);
    return;
  }
  const Size size = size_of(effect.id);
  const double step = std::pow(factor, 1.0 / size.order);
  for (double& v : p[size.name]) v *= step;
  if (effect.id == "sensor_bias")
    for (double& v : p["torque_Nm"]) v *= step;
}

bool plausible(const Hidden& effect, const Probe& probe) {
  if (effect.id == "contact_nonlinearity")
    return effect.of("exponent") > 0.35 && effect.of("exponent") < 3.0;
  if (effect.id == "shank_taper")
    return effect.of("tip_radius_m") > 0.3 * probe.radius_m &&
           effect.of("handle_radius_m") < 2.0 * probe.radius_m;
  const Size size = size_of(effect.id);
  double sum = 0;
  for (const double v : effect.parameters.at(size.name)) sum += v * v;
  return std::sqrt(sum) > size.low && std::sqrt(sum) < size.high;
}

}  // namespace blind
