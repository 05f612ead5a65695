#include "probing/draw.hpp"

#include <algorithm>
#include <set>

namespace blind {
namespace {

Base draw_base(Random& r) {
  Base base;
  const int count = r.chance(0.3) ? 1 : 2 + r.below(3);
  double start = 0;
  for (int i = 0; i < count; ++i) {
    Layer layer{};
    layer.start_m = start;
    layer.thickness_m = count == 1 ? r.uniform(0.010, 0.028) : r.uniform(0.0035, 0.009);
    layer.stiffness_N_per_m = r.log_uniform(1500, 7000);
    layer.damping_Ns_per_m = r.log_uniform(500, 3000);
    layer.equilibrium_m = start - (i == 0 ? r.uniform(-3e-4, 1e-3) : r.uniform(0.0, 4e-3));
    start += layer.thickness_m;
    base.layers.push_back(layer);
  }
  base.rotary = {r.uniform(0.02, 0.06), r.uniform(0.008, 0.03), r.uniform(0.2, 0.6)};
  return base;
}

bool together(const std::string& a, const std::string& b) {
  static const std::set<std::set<std::string>> kTooClose = {
      {"coulomb_friction", "stribeck_friction"},
      {"hysteresis", "coulomb_friction"},
      {"hysteresis", "stribeck_friction"},
      {"hysteresis", "backlash"},
      {"sensor_bias", "sensor_drift"}};
  return a != b && !kTooClose.contains({a, b});
}

std::string draw_kind(Random& r) {
  const double u = r.unit();
  return u < 0.60   ? "single"
         : u < 0.70 ? "none"
         : u < 0.75 ? "base_wrong"
         : u < 0.88 ? "pair"
                    : "outside";
}

std::vector<std::string> draw_ids(Random& r, const std::string& kind) {
  const auto pick = [&r](const std::vector<std::string>& from) {
    return from[static_cast<std::size_t>(r.below(static_cast<int>(from.size())))];
  };
  if (kind == "single") return {pick(catalogue())};
  if (kind == "outside") return {pick(outside_kinds())};
  if (kind != "pair") return {};
  for (;;) {
    const std::string a = pick(catalogue()), b = pick(catalogue());
    if (together(a, b)) return {a, b};
  }
}

/// Effects that a hand can feel in closed loop without an impact or a snap of the massless stage.
bool felt_in_loop(const std::string& id, bool sticking) {
  static const std::set<std::string> kSmooth = {"inertia",
                                                "quadratic_drag",
                                                "viscoelastic_relaxation",
                                                "hysteresis",
                                                "rotation_coupling",
                                                "force_ripple",
                                                "bone_texture",
                                                "tract_wear",
                                                "stiffness_nonlinearity",
                                                "lateral_load",
                                                "two_branch_relaxation",
                                                "fracture",
                                                "sensor_bias",
                                                "sensor_drift",
                                                "time_delay",
                                                "torque_crosstalk"};
  if (kSmooth.contains(id)) return true;
  return sticking && (id == "coulomb_friction" || id == "depth_friction");
}

bool meets_air(const std::string& id) {
  static const std::set<std::string> kClear = {"inertia",        "coulomb_friction",
                                               "quadratic_drag", "sensor_bias",
                                               "sensor_drift",   "torque_crosstalk"};
  return kClear.contains(id);
}

bool every(const std::vector<HiddenEffect>& effects, const auto& test) {
  return std::ranges::all_of(effects, [&](const HiddenEffect& e) { return test(e.id); });
}

bool has(const std::vector<HiddenEffect>& effects, const std::string& id) {
  return std::ranges::any_of(effects, [&](const HiddenEffect& e) { return e.id == id; });
}

void draw_trials(SetPlan& plan, Random& r) {
  const bool loop =
      every(plan.effects, [&](const std::string& id) { return felt_in_loop(id, plan.sticking); }) &&
      !(plan.sticking && has(plan.effects, "inertia"));
  const double hands = r.uniform(0.2, 1.0);  // share of trials by a person
  const bool air =
      every(plan.effects, meets_air) && r.chance(has(plan.effects, "sensor_bias") ? 0.5 : 0.15);
  const double end = plan.truth.end_m();
  const double stiffness = r.uniform(10e3, 25e3), shake = r.log_uniform(2.5e-5, 1.2e-4);
  for (int i = 0; i < plan.request.trials; ++i) {
    TrialPlan trial;
    trial.mode = r.chance(hands) ? (loop ? Mode::kHand : Mode::kPlayedHand) : Mode::kProgrammed;
    trial.duration_s = plan.request.duration_s;
    trial.low_m = r.uniform(8e-4, 2e-3);
    trial.high_m = end - r.uniform(1.5e-3, 2.5e-3);
    trial.hand_N_per_m = stiffness * r.uniform(0.85, 1.15);
    trial.tremor_m = shake * r.uniform(0.8, 1.25);
    trial.smoothing_Hz = r.uniform(14, 24);
    if (air && trial.mode == Mode::kProgrammed) trial.air_s = r.uniform(0.5, 1.5);
    trial.seed = static_cast<std::uint64_t>(r.unit() * 1e15);
    plan.trials.push_back(trial);
  }
  if (air && std::ranges::none_of(plan.trials, [](const TrialPlan& t) { return t.air_s > 0; })) {
    plan.trials.front().mode = Mode::kProgrammed;
    plan.trials.front().air_s = 1.0;
  }
}

Recording draw_recording(Random& r, const SetPlan& plan) {
  Recording out;
  out.averaging = r.chance(0.5);
  out.force_step_N = r.chance(0.7) ? r.log_uniform(1e-3, 2e-2) : 0.0;
  out.position_step_m = r.chance(0.7) ? r.log_uniform(2e-8, 4e-7) : 0.0;
  out.angle_step_rad = r.chance(0.7) ? r.log_uniform(5e-5, 5e-4) : 0.0;
  out.torque_step_Nm = r.chance(0.7) ? r.log_uniform(2e-5, 2e-4) : 0.0;
  const bool turns =
      has(plan.effects, "rotation_coupling") || has(plan.effects, "torque_crosstalk");
  out.rotation_channels = turns || r.chance(0.9);
  return out;
}

}  // namespace

SetPlan draw_plan(const Request& request) {
  Random r(request.seed);
  SetPlan plan;
  plan.request = request;
  const std::string drawn = draw_kind(r);
  plan.kind = request.kind.empty() ? drawn : request.kind;
  Random of_ids = r.split(), of_effects = r.split(), of_base = r.split(), of_trials = r.split(),
         of_record = r.split();
  plan.truth = draw_base(of_base);
  const auto ids = request.ids.empty() ? draw_ids(of_ids, plan.kind) : request.ids;
  for (const std::string& id : ids) {
    plan.effects.push_back(draw_effect(of_effects, id, plan.truth));
    plan.strengths.push_back(of_effects.uniform(0.045, 0.095));
  }
  plan.sticking = r.chance(0.3);
  draw_trials(plan, of_trials);
  plan.recording = draw_recording(of_record, plan);
  return plan;
}

void scale_base(SetPlan& plan, double factor) {
  for (Layer& layer : plan.truth.layers) {
    layer.stiffness_N_per_m *= factor;
    layer.damping_Ns_per_m *= factor;
  }
}

void draw_supplied(SetPlan& plan) {
  Random r(plan.request.seed ^ 0xBA5E);
  SuppliedBase& out = plan.supplied;
  out.base = plan.truth;
  const bool wrong = plan.kind == "base_wrong";
  const double choice = wrong ? 1.0 : r.unit();
  const bool starts_exact = !wrong && r.chance(0.6);
  const double off = wrong ? 0.5 : 0.2;
  if (choice < 0.35) {
    out.how = "exact";
    if (choice < 0.12)
      out.fixed = {"/base/layers/*/stiffness_N_per_m", "/base/layers/*/damping_Ns_per_m"};
  } else {
    out.how = starts_exact ? "off, starts exact" : "off, starts too";
    for (Layer& layer : out.base.layers) {
      layer.stiffness_N_per_m *= 1 + r.uniform(-off, off);
      layer.damping_Ns_per_m *= 1 + r.uniform(-off, off);
      layer.equilibrium_m += off * r.uniform(-1.5e-3, 1.5e-3);
    }
    out.base.rotary.viscous_Nms_per_rad *= 1 + r.uniform(-off, off);
    out.base.rotary.detent_Nm *= 1 + r.uniform(-off, off);
    for (std::size_t i = 1; i < out.base.layers.size() && !starts_exact; ++i) {
      const double shift = r.uniform(-4e-4, 4e-4);
      out.base.layers[i - 1].thickness_m += shift;
      out.base.layers[i].start_m += shift;
      out.base.layers[i].thickness_m -= shift;
    }
  }
  if ((starts_exact || out.how == "exact") && r.chance(0.5)) {
    out.fixed.push_back("/base/layers/*/start_m");
    out.fixed.push_back("/base/layers/*/thickness_m");
  }
  // Where every layer may move its equilibrium a constant force is nobody's: known places make it
  // seen.
  if (has(plan.effects, "sensor_bias") ? r.chance(0.7) : r.chance(0.15)) {
    for (std::size_t i = 0; i < plan.truth.layers.size(); ++i)
      out.base.layers[i].equilibrium_m = plan.truth.layers[i].equilibrium_m;
    out.fixed.push_back("/base/layers/*/equilibrium_m");
  }
}

}  // namespace blind
