#include "palpation/generate.hpp"

#include <algorithm>
#include <cmath>

#include "palpation/simulate.hpp"

namespace blind {
namespace {

constexpr double kForceNoise_N = 0.01, kTorqueNoise_Nm = 5e-4, kPoseNoise_m = 5e-6,
                 kAngleNoise_rad = 2e-5;
using Poses = std::vector<std::vector<Pose>>;

double mean_square(const std::vector<Wrenches>& a, const std::vector<Wrenches>* b) {
  double sum = 0, count = 0;
  for (std::size_t t = 0; t < a.size(); ++t)
    for (std::size_t i = 0; i < a[t].size(); ++i) {
      const Vec3 f = b != nullptr ? Vec3(a[t][i].force_N - (*b)[t][i].force_N) : a[t][i].force_N;
      sum += f.squaredNorm();
      count += 1;
    }
  return sum / std::max(1.0, count);
}

std::vector<Hidden> without(std::vector<Hidden> effects, std::size_t which) {
  if (which == effects.size()) return {};
  effects.erase(effects.begin() + static_cast<std::ptrdiff_t>(which));
  return effects;
}

/// Everything about a set that the many simulations of it share.
struct Bench {
  const PalpationPlan& plan;
  Field field;
  std::vector<Palpation> hands;
  double coarse_s;
  Poses coarse;

  explicit Bench(const PalpationPlan& p)
      : plan(p),
        field(p.volume, p.transfer, p.field),
        hands(hands_of(p)),
        coarse_s(1.0 / p.request.rate_Hz) {
    coarse = poses(coarse_s);
  }
  Poses poses(double dt_s) const {
    Poses out;
    const auto count = static_cast<std::size_t>(std::lround(plan.request.duration_s / dt_s));
    for (const Palpation& hand : hands) out.push_back(poses_of(hand, dt_s, count));
    return out;
  }
  std::vector<Wrenches> run(const Probe& probe, const std::vector<Hidden>& effects) const {
    return simulate(plan, field, probe, effects, coarse, coarse_s).trials;
  }
};

/// Brings every effect to its wanted share of the force. False when one had to leave its plausible
/// range.
bool tune(PalpationPlan& plan, const Bench& bench) {
  for (int i = 0; i < 6 && !plan.effects.empty(); ++i) {
    const auto full = bench.run(plan.truth, plan.effects);
    const double force = mean_square(full, nullptr);
    double worst = 0;
    std::vector<double> factors;
    for (std::size_t e = 0; e < plan.effects.size(); ++e) {
      const auto less = bench.run(plan.truth, without(plan.effects, e));
      const double ratio =
          plan.strengths[e] / std::sqrt(std::max(1e-12, mean_square(full, &less) / force));
      worst = std::max(worst, std::abs(std::log(ratio)));
      factors.push_back(std::clamp(ratio, 0.3, 3.0));
    }
    if (worst < 0.04) break;
    for (std::size_t e = 0; e < factors.size(); ++e)
      enlarge(plan.effects[e], factors[e], plan.truth);
  }
  return std::ranges::all_of(plan.effects,
                             [&](const Hidden& e) { return plausible(e, plan.truth); });
}

/// The free base parameters moved by a little: (probe, step) for each.
std::vector<Probe> moved(const PalpationPlan& plan) {
  std::vector<Probe> out;
  const auto free = [&](const char* name) {
    return std::ranges::find(plan.fixed, name) == plan.fixed.end();
  };
  const auto add = [&](const char* name, auto change) {
    if (!free(name)) return;
    out.push_back(plan.truth);
    change(out.back());
  };
  add("force_factor_Nm", [](Probe& p) { p.force_factor_Nm *= 1.002; });
  add("force_scale", [](Probe& p) { p.force_scale *= 1.002; });
  add("torque_scale", [](Probe& p) { p.torque_scale *= 1.002; });
  add("radius_m", [](Probe& p) { p.radius_m *= 1.001; });
  for (int axis = 0; axis < 3; ++axis)
    add("pose_offset_m", [axis](Probe& p) { p.offset_m[axis] += 2e-6; });
  return out;
}

/// Force and torque differences of two runs, each over its noise, as one column.
Eigen::VectorXd column(const std::vector<Wrenches>& a, const std::vector<Wrenches>& b) {
  std::vector<double> out;
  for (std::size_t t = 0; t < a.size(); ++t)
    for (std::size_t i = 0; i < a[t].size(); ++i) {
      const Wrench d = a[t][i] - b[t][i];
      for (int k = 0; k < 3; ++k) out.push_back(d.force_N[k] / kForceNoise_N);
      for (int k = 0; k < 3; ++k) out.push_back(d.torque_Nm[k] / kTorqueNoise_Nm);
    }
  return Eigen::Map<Eigen::VectorXd>(out.data(), static_cast<Eigen::Index>(out.size()));
}

/// RMS of the force's norm in what is left of a column.
double left_N(const Eigen::VectorXd& left) {
  double sum = 0;
  for (Eigen::Index i = 0; i < left.size(); i += 6) sum += left.segment<3>(i).squaredNorm();
  return kForceNoise_N * std::sqrt(sum / static_cast<double>(left.size() / 6));
}

void judge(PalpationSet& set, const Bench& bench) {
  const PalpationPlan& plan = set.plan;
  const auto full = bench.run(plan.truth, plan.effects);
  const double force = mean_square(full, nullptr);
  const auto bare = bench.run(plan.truth, {});
  Eigen::MatrixXd base(column(bare, bare).size(), 0);
  for (const Probe& probe : moved(plan)) {
    base.conservativeResize(Eigen::NoChange, base.cols() + 1);
    base.rightCols<1>() = column(bench.run(probe, {}), bare).normalized();
  }
  const auto solver = base.colPivHouseholderQr();
  for (std::size_t e = 0; e <= plan.effects.size() && !plan.effects.empty(); ++e) {
    const auto less = bench.run(plan.truth, without(plan.effects, e));
    Eigen::VectorXd rest = column(full, less);
    if (base.cols() > 0) rest -= base * solver.solve(rest).eval();
    const double left = left_N(rest);
    const double rms = std::sqrt(mean_square(full, &less));
    if (e < plan.effects.size())
      set.outcomes.push_back({rms, rms / std::sqrt(force), left});
    else
      set.hidden_projected_N = left;
  }
}

Pose shaken(const Pose& pose, Random& random) {
  Pose out = pose;
  for (int axis = 0; axis < 3; ++axis) out.o_m[axis] += kPoseNoise_m * random.normal();
  const double x = random.normal(), y = random.normal(), z = random.normal();
  const Vec3 turn = kAngleNoise_rad * Vec3(x, y, z);
  if (turn.norm() > 0)
    out.R = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix() * pose.R;
  return out;
}

/// Noise and sampling of the fine run; fills trials, floors and the force's size.
void sample(PalpationSet& set, const Simulated& fine, std::size_t stride, const Poses& fine_poses,
            const Bench& bench) {
  Random random(set.plan.request.seed ^ 0x5A3);
  double noise = 0, force = 0, count = 0;
  Poses shaky = bench.coarse;
  for (std::size_t t = 0; t < fine.trials.size(); ++t) {
    auto& out = set.trials.emplace_back();
    for (std::size_t i = 0; i < fine.trials[t].size(); i += stride) {
      const Pose pose = shaken(fine_poses[t][i + 1], random);
      if (i / stride + 1 < shaky[t].size()) shaky[t][i / stride + 1] = pose;
      Wrench w = fine.trials[t][i];
      force += w.force_N.squaredNorm();
      set.peak_N = std::max(set.peak_N, w.force_N.norm());
      Vec3 f, m;
      for (int k = 0; k < 3; ++k)
        f[k] = kForceNoise_N * random.normal(), m[k] = kTorqueNoise_Nm * random.normal();
      noise += f.squaredNorm();
      count += 1;
      w.force_N += f;
      w.torque_Nm += m;
      out.push_back({static_cast<double>(i / stride) / set.plan.request.rate_Hz, pose.o_m,
                     Eigen::Quaterniond(pose.R), w});
    }
  }
  set.force_rms_N = std::sqrt(force / count);
  set.sensor_floor_N = std::sqrt(noise / count);
  const auto clean =
      simulate(set.plan, bench.field, set.plan.truth, {}, bench.coarse, bench.coarse_s).trials;
  const auto seen =
      simulate(set.plan, bench.field, set.plan.truth, {}, shaky, bench.coarse_s).trials;
  set.pose_floor_N = std::sqrt(mean_square(clean, &seen));
}

bool acceptable(const PalpationSet& set, bool tuned) {
  if (!tuned || set.force_rms_N < 0.3) return false;
  if (set.jump_share > 0.004 && !set.plan.jumps_allowed) return false;
  return std::ranges::all_of(set.outcomes, [](const PalpationOutcome& o) {
    return o.strength > 0.04 && o.strength < 0.10;
  });
}

}  // namespace

PalpationSet generate_palpation(const PalpationRequest& request) {
  PalpationRequest drawn = request;
  if (drawn.kind.empty()) {  // the kind stays what the first draw said
    const PalpationPlan first = draw_palpation(request);
    drawn.kind = first.kind;
    for (const Hidden& effect : first.effects) drawn.ids.push_back(effect.id);
  }
  PalpationSet set;
  constexpr int kAttempts = 10;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    PalpationRequest again = drawn;
    again.seed = request.seed + 1000003ULL * static_cast<std::uint64_t>(attempt);
    set = {};
    set.plan = draw_palpation(again);
    const Bench bench(set.plan);
    const bool tuned = tune(set.plan, bench);
    if (!tuned && attempt + 1 < kAttempts) continue;
    judge(set, bench);
    const auto stride = static_cast<std::size_t>(std::max(1L, std::lround(1e3 / request.rate_Hz)));
    const double fine_s = 1.0 / (request.rate_Hz * static_cast<double>(stride));
    const Poses fine_poses = bench.poses(fine_s);
    const Simulated fine =
        simulate(set.plan, bench.field, set.plan.truth, set.plan.effects, fine_poses, fine_s);
    set.jump_share = fine.jump_share;
    sample(set, fine, stride, fine_poses, bench);
    set.accepted = acceptable(set, tuned);
    if (set.accepted) break;
  }
  set.plan.request.seed = request.seed;
  return set;
}

}  // namespace blind
