#include "palpation/draw.hpp"

#include <algorithm>
#include <set>

#include "palpation/draw_effect.hpp"

namespace blind {
namespace {

bool together(const std::string& a, const std::string& b) {
  static const std::set<std::set<std::string>> kTooClose = {{"sensor_bias", "sensor_drift"},
                                                            {"sensor_bias", "probe_weight"},
                                                            {"sensor_drift", "probe_weight"},
                                                            {"pose_offset", "shank_curvature"}};
  return a != b && !kTooClose.contains({a, b});
}

std::string draw_kind(Random& r) {
  const double u = r.unit();
  return u < 0.58   ? "single"
         : u < 0.68 ? "none"
         : u < 0.73 ? "base_wrong"
         : u < 0.87 ? "pair"
                    : "outside";
}

std::vector<std::string> draw_ids(Random& r, const std::string& kind) {
  const auto pick = [&r](const std::vector<std::string>& from) {
    return from[static_cast<std::size_t>(r.below(static_cast<int>(from.size())))];
  };
  if (kind == "single") return {pick(palpation_catalogue())};
  if (kind == "outside") return {pick(palpation_outside())};
  if (kind != "pair") return {};
  for (;;) {
    const std::string a = pick(palpation_catalogue()), b = pick(palpation_catalogue());
    if (together(a, b)) return {a, b};
  }
}

/// A made-up block of bone or the real scan; the transfer function that suits it.
void draw_volume(PalpationPlan& plan, Random& r) {
  const bool wants_real = r.chance(0.3);
  Random of_volume = r.split(), of_tract = r.split();
  if (wants_real && !plan.request.ct.empty())
    if (auto scan = real_bone(plan.request.ct)) {
      plan.volume = std::move(*scan);
      plan.source = "real scan, tract carved";
    }
  const bool real = !plan.volume.hu.empty();
  if (!real) {
    plan.volume = bone_block(of_volume);
    plan.source = "made up";
  }
  plan.tract = draw_tract(of_tract, plan.volume);
  carve(plan.volume, plan.tract, r.uniform(-60, 20),
        real            ? r.uniform(150, 300)
        : r.chance(0.5) ? r.uniform(50, 300)
                        : 0.0);
  plan.transfer = real ? Transfer{{r.uniform(40, 90), 0}, {r.uniform(380, 600), 1}}
                       : Transfer{{r.uniform(60, 150), 0}, {r.uniform(450, 800), 1}};
}

void draw_probe(PalpationPlan& plan, Random& r) {
  Probe& p = plan.truth;
  p.force_factor_Nm = 0.005 * r.uniform(1.0, 3.0);
  p.force_scale = p.torque_scale = r.chance(0.25) ? 0.3 : r.uniform(0.5, 1.0);
  p.radius_m = r.chance(0.2) ? 0.0007 : r.uniform(0.0008, 0.0013);
  if (r.chance(0.3))
    p.offset_m = Vec3(r.uniform(-2e-3, 2e-3), r.uniform(-2e-3, 2e-3), r.uniform(-2e-3, 2e-3));
}

bool hides(const PalpationPlan& plan, const std::string& id) {
  return std::ranges::any_of(plan.effects, [&](const Hidden& e) { return e.id == id; });
}

void draw_supplied(PalpationPlan& plan, Random& r) {
  plan.supplied = plan.truth;
  plan.fixed = {"youngs_modulus_Pa", "length_m", "point_spacing_m"};
  if (hides(plan, "pose_offset") || r.chance(0.85)) plan.fixed.push_back("pose_offset_m");
  const bool wrong = plan.kind == "base_wrong";
  if (hides(plan, "shank_taper") || r.chance(0.3)) plan.fixed.push_back("radius_m");
  const bool radius_known = plan.fixed.back() == "radius_m";
  if (r.chance(0.5)) plan.fixed.push_back("force_scale");
  const bool scale_known = plan.fixed.back() == "force_scale";
  if (!wrong && r.chance(0.35)) {
    plan.how = "exact";
    return;
  }
  plan.how = "off";
  const double off = wrong ? 0.4 : 0.2;
  plan.supplied.force_factor_Nm *= 1 + r.uniform(-off, off);
  if (!scale_known) plan.supplied.force_scale *= 1 + r.uniform(-0.5 * off, 0.5 * off);
  plan.supplied.torque_scale *= 1 + r.uniform(-0.5 * off, 0.5 * off);
  if (!radius_known) plan.supplied.radius_m *= 1 + r.uniform(-0.2 * off, 0.2 * off);
}

}  // namespace

const std::vector<std::string>& palpation_catalogue() {
  static const std::vector<std::string> kIds = {
      "contact_friction", "contact_damping", "contact_nonlinearity", "contact_hysteresis",
      "shank_taper",      "shank_curvature", "pose_offset",          "tip_ball",
      "probe_weight",     "probe_inertia",   "sensor_bias",          "sensor_drift",
      "time_delay"};
  return kIds;
}

const std::vector<std::string>& palpation_outside() {
  static const std::vector<std::string> kIds = {"bone_compliance", "anisotropic_stiffness",
                                                "porous_stiffness", "contact_relaxation",
                                                "tissue_flap"};
  return kIds;
}

PalpationPlan draw_palpation(const PalpationRequest& request) {
  Random r(request.seed ^ 0x9A1BA7E);
  PalpationPlan plan;
  plan.request = request;
  const std::string drawn = draw_kind(r);
  plan.kind = request.kind.empty() ? drawn : request.kind;
  Random of_ids = r.split(), of_effects = r.split(), of_volume = r.split(), of_probe = r.split(),
         of_supplied = r.split(), of_trials = r.split();
  draw_volume(plan, of_volume);
  draw_probe(plan, of_probe);
  plan.field = of_probe.chance(0.75) ? FieldKind::kPaper : FieldKind::kPotential;
  const auto ids = request.ids.empty() ? draw_ids(of_ids, plan.kind) : request.ids;
  for (const std::string& id : ids) {
    plan.effects.push_back(draw_hidden(of_effects, id, plan.truth, plan.tract));
    plan.strengths.push_back(of_effects.uniform(0.045, 0.095));
  }
  draw_supplied(plan, of_supplied);
  for (int i = 0; i < request.trials; ++i)
    plan.trial_seeds.push_back(static_cast<std::uint64_t>(of_trials.unit() * 1e15));
  const bool brisk = hides(plan, "contact_damping") || hides(plan, "probe_inertia");
  plan.tempo = of_trials.log_uniform(0.8, 2.2) * (brisk ? 1.6 : 1.0);
  plan.jumps_allowed = of_trials.chance(0.15);
  return plan;
}

}  // namespace blind
