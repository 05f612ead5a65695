/// What every effect of palpation keeps to, whatever it is; over the whole catalogue.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "models/palpation_runtime.hpp"
#include "station/loop/allocation_guard.hpp"

namespace tractus {
namespace {

using effects::Kind;
using effects::PalpationEffectInfo;
using effects::Param;
using math::Vec3;
using models::PalpationAnswer;
using models::PalpationModel;
using models::PalpationMotion;
using models::PalpationRuntime;

const PalpationEffectInfo& palpation_entry(const std::string& id) {
  return *std::ranges::find(effects::palpation_effects(), id,
                            [](const auto& info) { return info.facts.id; });
}

enum class PalpationAt { off, some, low, high };

/// The effect with all its numbers at one place of their ranges. Off, those of shape stay initial;
/// a taper is off where both radii are the base's. `some` is initial, or a little off zero.
effects::EffectInstance use_of(const PalpationEffectInfo& info, PalpationAt at) {
  effects::EffectInstance use{info.facts.id, {}};
  for (const Param& p : info.facts.params) {
    double value = p.initial;
    if (at == PalpationAt::low) value = p.low;
    if (at == PalpationAt::high) value = p.high;
    if (at == PalpationAt::off && !std::isnan(p.off)) value = p.off;
    if (at == PalpationAt::off && info.facts.id == "shank_taper")
      value = laws::PalpationParameters{}.radius_m;
    if (at == PalpationAt::some && value == p.off) value += 0.02 * (p.high - p.low);
    use.values.insert(use.values.end(), std::size_t(p.components), value);
  }
  return use;
}

/// A floor of bone below z = 10 mm, 24 × 24 × 20 mm.
const volume::Volume& block() {
  static const volume::Volume kBlock = [] {
    volume::Volume v;
    v.geometry.dims = {24, 24, 40};
    v.geometry.spacing_m = Vec3::Constant(0.5e-3);
    v.counts.assign(v.geometry.voxel_count(), 0);
    for (int k = 0; k < 20; ++k)
      for (int j = 0; j < 24; ++j)
        for (int i = 0; i < 24; ++i) v.counts[v.offset(i, j, k)] = 1000;
    return v;
  }();
  return kBlock;
}

const volume::ForceField& field() {
  static const auto kField =
      volume::ForceField::make(block(), PalpationModel{}.transfer, volume::FieldKind::potential);
  return *kField;
}

PalpationRuntime runtime_of(std::vector<effects::EffectInstance> uses) {
  PalpationModel model;
  model.field = volume::FieldKind::potential;
  model.effects = std::move(uses);
  auto runtime = PalpationRuntime::make(model, field());
  EXPECT_TRUE(runtime) << runtime.error().what;
  return std::move(*runtime);
}

/// Down into the floor, along it and up again, twice, tip first and tilted both ways.
PalpationMotion strokes() {
  const math::Quat down(Eigen::AngleAxisd(M_PI - 0.15, Vec3::UnitX()) *
                        Eigen::AngleAxisd(0.1, Vec3::UnitY()));
  std::vector<double> t_s;
  std::vector<math::Pose> poses;
  for (int k = 0; k <= 800; ++k) {
    const double t = k / 200.0, w = M_PI * t;
    const Vec3 tip(6e-3 + 1e-3 * std::sin(w), 6e-3 + 1e-3 * std::cos(w),
                   10.6e-3 + 0.8e-3 * std::cos(w));
    t_s.push_back(t);
    poses.push_back({tip - 0.13 * (down * Vec3::UnitZ()), down});
  }
  return std::move(*PalpationMotion::through(t_s, poses));
}

PalpationAnswer predicted(const PalpationRuntime& runtime, const PalpationMotion& motion) {
  PalpationAnswer out;
  runtime.predict(motion, out);
  return out;
}

double greatest_difference(const PalpationAnswer& a, const PalpationAnswer& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.wrench_H.size(); ++k)
    most = std::max({most, (a.wrench_H[k].force_N - b.wrench_H[k].force_N).norm(),
                     (a.wrench_H[k].torque_Nm - b.wrench_H[k].torque_Nm).norm()});
  return most;
}

/// The live answer to the same motion, force alone.
std::vector<Vec3> live(const PalpationRuntime& runtime, const PalpationMotion& motion) {
  laws::PalpationState state;
  std::vector<Vec3> out;
  for (const auto& handle : motion.handle)
    out.push_back(runtime.step(handle, state).wrench_H.force_N);
  return out;
}

class EveryPalpationEffect : public testing::TestWithParam<std::string> {
 protected:
  const PalpationEffectInfo& info_ = palpation_entry(GetParam());
};

TEST_P(EveryPalpationEffect, SaysWhatItIs) {
  const auto& f = info_.facts;
  EXPECT_FALSE(f.summary.empty() || f.equation.empty() || f.source.empty());
  EXPECT_FALSE(f.params.empty());
  for (const Param& p : f.params) {
    EXPECT_FALSE(p.meaning.empty()) << p.name;
    EXPECT_TRUE(p.low < p.high && p.low <= p.initial && p.initial <= p.high) << p.name;
    EXPECT_TRUE(std::isnan(p.off) || (p.off >= p.low && p.off <= p.high)) << p.name;
    EXPECT_TRUE(!p.logarithmic || p.low > 0.0) << p.name;
  }
  for (const std::string& parent : f.parents) EXPECT_EQ(palpation_entry(parent).facts.id, parent);
}

TEST_P(EveryPalpationEffect, IsNothingWhenOff) {
  const auto motion = strokes();
  EXPECT_LT(greatest_difference(predicted(runtime_of({}), motion),
                                predicted(runtime_of({use_of(info_, PalpationAt::off)}), motion)),
            1e-6);  // N: the shank's rest is sought to 1e-3 N, so two ways to it part a little
}

TEST_P(EveryPalpationEffect, IsSomethingElsewhereUnlessItsCourseIsFree) {
  const auto motion = strokes();
  const double most =
      greatest_difference(predicted(runtime_of({}), motion),
                          predicted(runtime_of({use_of(info_, PalpationAt::some)}), motion));
  if (info_.facts.free_per_trial)
    EXPECT_EQ(most, 0.0);
  else
    EXPECT_GT(most, 1e-4);
}

TEST_P(EveryPalpationEffect, IsFiniteOverItsWholeRange) {
  const auto motion = strokes();
  for (const PalpationAt at : {PalpationAt::some, PalpationAt::low, PalpationAt::high})
    for (const auto& wrench : predicted(runtime_of({use_of(info_, at)}), motion).wrench_H)
      ASSERT_TRUE(wrench.force_N.norm() < 1e5 && wrench.torque_Nm.norm() < 1e5) << int(at);
}

TEST_P(EveryPalpationEffect, AllocatesNothingInATick) {
  const auto motion = strokes();
  for (const PalpationAt at : {PalpationAt::some, PalpationAt::low, PalpationAt::high}) {
    const auto runtime = runtime_of({use_of(info_, at)});
    laws::PalpationState state;
    const loop::AllocationGuard guard;
    for (const auto& handle : motion.handle) runtime.step(handle, state);
    EXPECT_EQ(guard.allocations(), 0u);
  }
}

TEST_P(EveryPalpationEffect, GivesTheSameBitsAgain) {
  const auto motion = strokes();
  const auto one = runtime_of({use_of(info_, PalpationAt::some)});
  EXPECT_EQ(greatest_difference(predicted(one, motion), predicted(one, motion)), 0.0);
  EXPECT_EQ(live(one, motion), live(runtime_of({use_of(info_, PalpationAt::some)}), motion));
}

TEST_P(EveryPalpationEffect, IsFeltLiveUnlessItBelongsToTheSensor) {
  const auto motion = strokes();
  const auto base = live(runtime_of({}), motion);
  const auto with = live(runtime_of({use_of(info_, PalpationAt::some)}), motion);
  if (info_.facts.kind == Kind::measurement)
    EXPECT_EQ(with, base);
  else
    EXPECT_NE(with, base);
}

/// Work of the hand on a round way, J: what it pushes against is −F, in V.
double work_J(const PalpationRuntime& runtime) {
  const auto motion = strokes();
  laws::PalpationState state;
  double work = 0.0;
  for (std::size_t k = 0; k < motion.handle.size(); ++k) {
    const auto& handle = motion.handle[k];
    const Vec3 F_V = handle.X_VH.q * runtime.step(handle, state).wrench_H.force_N;
    if (k >= 400) work -= F_V.dot(handle.v_m_s) / 200.0;  // the second round: 2 s, 400 samples
  }
  return work;
}

TEST_P(EveryPalpationEffect, GivesBackNoMoreWorkThanItGotUnlessItSaysSo) {
  if (info_.facts.kind == Kind::measurement || !info_.facts.passive) return;
  const double base = work_J(runtime_of({}));
  EXPECT_GT(work_J(runtime_of({use_of(info_, PalpationAt::some)})) - base, -2e-6)
      << "of " << base << " J on a conservative field";
}

std::vector<std::string> palpation_ids() {
  std::vector<std::string> out;
  for (const auto& info : effects::palpation_effects()) out.push_back(info.facts.id);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Palpation, EveryPalpationEffect, testing::ValuesIn(palpation_ids()),
                         [](const auto& one) { return one.param; });

TEST(TheCatalogueOfPalpation, HoldsTheThirteenEffectsOfTheDesign) {
  EXPECT_THAT(palpation_ids(),
              testing::IsSupersetOf({"contact_friction", "contact_damping", "contact_nonlinearity",
                                     "contact_hysteresis", "shank_taper", "shank_curvature",
                                     "pose_offset", "tip_ball", "probe_weight", "probe_inertia",
                                     "sensor_bias", "sensor_drift", "time_delay"}));
}

}  // namespace
}  // namespace tractus
