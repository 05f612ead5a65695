/// A user's formula on the palpation rig, against an effect of the catalogue that is the same law.
#include "effects/palpation_expression.hpp"

#include <gtest/gtest.h>

#include "effects/probing_effect.hpp"
#include "volume/force_field.hpp"

namespace tractus {
namespace models {
namespace {

using math::Vec3;

/// Bone of 1000 HU where y < 0, soft tissue elsewhere; 1 mm voxels, V centred.
volume::Volume small_half_space() {
  volume::Volume v{.geometry = {{24, 24, 24},
                                Vec3::Constant(1e-3),
                                Vec3::Constant(-0.0115),
                                volume::Mat3::Identity()},
                   .slope = 1,
                   .intercept = -1024,
                   .counts = {}};
  for (int k = 0; k < 24; ++k)
    for (int j = 0; j < 24; ++j)
      for (int i = 0; i < 24; ++i) v.counts.push_back(v.count_of(j < 12 ? 1000 : 0));
  return v;
}

effects::EffectInstance formula(const char* text, const char* unit) {
  const core::Json c{{"unit", unit}, {"initial", 7}, {"low", 0}, {"high", 100}};
  const auto own = effects::Expression::from_json(core::Json{{"format", "tractus-effect/1"},
                                                             {"id", "expression:own"},
                                                             {"rig", "palpation"},
                                                             {"adds_to", "f_N"},
                                                             {"formula", text},
                                                             {"parameters", {{"c", c}}}},
                                                  "", effects::palpation_expressions());
  EXPECT_TRUE(own) << own.error().what;
  return own->use();
}

laws::ForceSample added(const effects::EffectInstance& use, const Vec3& p_m, const Vec3& v_m_s) {
  static const auto field = volume::ForceField::make(
      small_half_space(), volume::TransferFunction::bone(), volume::FieldKind::paper);
  auto effect = effects::make_palpation_effect(use);
  EXPECT_TRUE(effect) << effect.error().what;
  const auto sample = field->sample(p_m);
  const laws::ForceSample elastic{0.005 * sample.g_per_m, 0.005 * sample.jacobian_per_m2};
  laws::ForceSample total{Vec3::Zero(), math::Mat3::Zero()};
  std::get<std::unique_ptr<effects::PointForce>>(*effect)->add({p_m, v_m_s, &*field}, elastic,
                                                               total);
  return total;
}

const Vec3 kPoint(0.0003, 0.0004, -0.0002);
const Vec3 kSpeed(0.03, -0.04, 0.0);  // 50 mm/s: rounded by (0.1/50)² / 2 = 2e-6

TEST(APalpationFormula, IsContactDampingWhereItSaysSo) {
  const auto own = added(formula("c * opacity * v_m_s", "N*s/m"), kPoint, kSpeed);
  const auto known = added({"contact_damping", {7.0, 1.0}}, kPoint, kSpeed);
  EXPECT_GT(known.force_N.norm(), 0.1);
  EXPECT_LT((own.force_N - known.force_N).norm(), 1e-5 * known.force_N.norm());
  EXPECT_LT((own.jacobian_N_per_m - known.jacobian_N_per_m).norm(),
            1e-3 * known.jacobian_N_per_m.norm());
}

TEST(APalpationFormula, SplitsTheSpeedByTheWall) {
  // The wall's push is along +y: v = (30, −40, 0) mm/s leaves at −40 and slides at 30 mm/s.
  const auto into = added(formula("c * -v_n_m_s", "N*s/m"), kPoint, kSpeed);
  const auto along = added(formula("c * v_t_m_s", "N*s/m"), kPoint, kSpeed);
  EXPECT_NEAR(into.force_N.norm(), 7.0 * 0.04, 1e-5);
  EXPECT_NEAR(along.force_N.norm(), 7.0 * 0.03, 1e-5);
  EXPECT_LT((into.force_N.normalized() + kSpeed.normalized()).norm(), 1e-9);  // against the motion
}

TEST(APalpationFormula, IsRefusedWhatTheRigDoesNotKnow) {
  auto use = formula("c * base_N", "1");
  EXPECT_EQ(effects::palpation_facts(use)->params[0].unit, "1");
  use.values = {101.0};
  EXPECT_EQ(effects::make_palpation_effect(use).error().what,
            "expression:own/c: 101 is outside 0 … 100");
  EXPECT_FALSE(effects::probing_facts(use));  // it is of the other rig
}

}  // namespace
}  // namespace models
}  // namespace tractus
