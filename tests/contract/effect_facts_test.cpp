/// An effect is complete in its own file: what the lab and the pages need of it is stated, and what
/// it states of itself is so. Over both catalogues.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "effects/catalogues.hpp"
#include "effects/palpation_effect.hpp"
#include "effects/probing_effect.hpp"

namespace tractus {
namespace effects {
namespace {

/// Recordings as they often are: 20 mm of depth, 0.5 to 30 mm/s, 20 s, and a residual that comes
/// back every 2 mm.
ProbingStatistics probing_recordings() {
  ProbingStatistics out{
      .slow_m_s = 5e-4, .fast_m_s = 0.03, .depth_range_m = 0.02, .longest_s = 20.0};
  for (int k = 0; k < 2000; ++k) {
    out.depth_m.push_back(1e-5 * k);
    out.residual.push_back(3.0 * std::sin(2.0 * M_PI * out.depth_m.back() / 0.002));
    out.residual_sd_N.push_back(0.05);
  }
  return out;
}

constexpr PalpationStatistics kPalpationRecordings{.radius_m = 8e-4, .field_per_m = 700.0};

std::vector<double> initial_values(const EffectFacts& facts) {
  std::vector<double> out;
  for (const Param& p : facts.params) out.insert(out.end(), std::size_t(p.components), p.initial);
  return out;
}

/// An entry of either catalogue.
struct Entry {
  std::string rig;
  EffectFacts facts;
  Starts starts;  ///< for usual recordings
  std::size_t sources_of_starts;
  bool measures;             ///< by its stage
  double replaced = kNoOff;  ///< off value of a number that takes the place of one of the base
};

Entry entry_of(const ProbingEffectInfo& info) {
  const ProbingEffect made = info.make(initial_values(info.facts));
  return {.rig = "probing",
          .facts = info.facts,
          .starts = info.starts ? info.starts(probing_recordings()) : info.facts.starts,
          .sources_of_starts = std::size_t(info.starts != nullptr) + !info.facts.starts.empty(),
          .measures = std::holds_alternative<std::unique_ptr<ForceDelay>>(made) ||
                      std::holds_alternative<std::unique_ptr<ForceSensor>>(made) ||
                      std::holds_alternative<std::unique_ptr<TorqueSensor>>(made)};
}

Entry entry_of(const PalpationEffectInfo& info) {
  const PalpationEffect made = info.make(initial_values(info.facts));
  return {.rig = "palpation",
          .facts = info.facts,
          .starts = info.starts ? info.starts(kPalpationRecordings) : info.facts.starts,
          .sources_of_starts = std::size_t(info.starts != nullptr) + !info.facts.starts.empty(),
          .measures = std::holds_alternative<std::unique_ptr<MotionDelay>>(made) ||
                      std::holds_alternative<std::unique_ptr<PosePlacement>>(made) ||
                      std::holds_alternative<std::unique_ptr<SensorOffset>>(made) ||
                      std::holds_alternative<FreePerTrial>(made),
          .replaced = info.replaces ? kPalpationRecordings.radius_m : kNoOff};
}

const std::map<std::string, Entry>& entries() {
  static const auto kAll = [] {
    std::map<std::string, Entry> out;
    for (const auto& info : probing_effects())
      out.emplace("probing_" + info.facts.id, entry_of(info));
    for (const auto& info : palpation_effects())
      out.emplace("palpation_" + info.facts.id, entry_of(info));
    return out;
  }();
  return kAll;
}

class EveryEffectsFacts : public testing::TestWithParam<std::string> {
 protected:
  const Entry& entry_ = entries().at(GetParam());
  const EffectFacts& f_ = entry_.facts;
};

/// A phrase within a sentence: there, and without a sentence's end.
void expect_phrase(const std::string& text, const char* what) {
  EXPECT_FALSE(text.empty()) << "state what is missing: " << what;
  EXPECT_FALSE(text.ends_with('.') || text.ends_with(' ')) << what << ": " << text;
}

TEST_P(EveryEffectsFacts, SayItInWords) {
  expect_phrase(f_.label, "label");
  expect_phrase(f_.summary, "summary");
  expect_phrase(f_.equation, "equation");
  expect_phrase(f_.source, "source");
  expect_phrase(f_.experiment, "experiment");
  EXPECT_THAT(f_.label, testing::Not(testing::HasSubstr("_")));
  EXPECT_EQ(label_of(f_.id), f_.label);
  EXPECT_EQ(find_facts(entry_.rig, f_.id)->summary, f_.summary);
}

TEST_P(EveryEffectsFacts, NameEachParameterWithItsUnit) {
  std::set<std::string> names;
  EXPECT_FALSE(f_.params.empty());
  for (const Param& p : f_.params) {
    EXPECT_TRUE(names.insert(p.name).second) << p.name << " is there twice";
    expect_phrase(p.meaning, p.name.c_str());
    EXPECT_TRUE(!p.unit.empty() || unit_of(p) != "1")
        << p.name
        << " does not end in a unit, as delay_s does; if it has none, state .unit = \"1\"";
    if (p.name.find("_per_") != std::string::npos) {
      EXPECT_NE(unit_of(p).find('/'), std::string::npos) << p.name << " in " << unit_of(p);
    }
    EXPECT_TRUE(p.components >= 1 && p.step >= 0.0 && p.prior_sd > 0.0) << p.name;
    EXPECT_TRUE(p.step < p.high - p.low || p.logarithmic) << p.name;
  }
}

/// From where every strength is off a search learns nothing.
TEST_P(EveryEffectsFacts, SayWhereASearchBegins) {
  EXPECT_LE(entry_.sources_of_starts, 1u) << "constants or a function, not both";
  if (entry_.sources_of_starts > 0) {
    EXPECT_FALSE(entry_.starts.empty());
  }
  Starts all = entry_.starts;
  if (all.empty()) all.push_back(initial_values(f_));
  for (const auto& start : all) {
    ASSERT_EQ(start.size(), value_count(f_));
    EXPECT_TRUE(check(f_, start)) << check(f_, start).error().what;
    std::size_t at = 0;
    for (const Param& p : f_.params)
      for (int c = 0; c < p.components; ++c, ++at) {
        EXPECT_NE(start[at], p.off) << p.name;
        EXPECT_NE(start[at], entry_.replaced) << p.name;
      }
  }
  if (f_.admissible) {
    EXPECT_TRUE(f_.admissible(initial_values(f_)));
  }
}

TEST_P(EveryEffectsFacts, AgreeWithItsStage) {
  EXPECT_EQ(f_.kind == Kind::measurement, entry_.measures);
  EXPECT_TRUE(entry_.measures || !(f_.is_bias || f_.free_per_trial));
  EXPECT_TRUE(f_.kind == Kind::force || !f_.is_dry);
  EXPECT_TRUE(!f_.free_per_trial || value_count(f_) == 1) << "its range alone is reported";
}

std::vector<std::string> names() {
  std::vector<std::string> out;
  for (const auto& [name, entry] : entries()) out.push_back(name);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Effects, EveryEffectsFacts, testing::ValuesIn(names()),
                         [](const auto& one) { return one.param; });

TEST(TheCatalogues, GiveEachEffectALabelOfItsOwn) {
  std::map<std::string, std::string> id_of;
  for (const auto& [name, entry] : entries()) {
    const auto [known, fresh] = id_of.emplace(entry.facts.label, entry.facts.id);
    EXPECT_TRUE(fresh || known->second == entry.facts.id)
        << entry.facts.id << " and " << known->second << " are both " << entry.facts.label;
  }
}

/// On the probing rig, what an effect does at standstill, along the probe or about it.
class EveryProbingEffectsFacts : public testing::TestWithParam<std::string> {
 protected:
  const ProbingEffectInfo& info_ = *find_probing_effect(GetParam());
  const ProbingEffect made_ = info_.make(initial_values(info_.facts));

  template <class Stage>
  const Stage* stage() const {
    const auto* held = std::get_if<std::unique_ptr<Stage>>(&made_);
    return held ? held->get() : nullptr;
  }
  /// Force or torque 10 mm deep at a speed.
  double at(double speed) const {
    const ProbingTick tick{.x_m = 0.01, .v_m_s = speed, .omega_rad_s = speed};
    ProbingMemory memory{.depth_m = 0.01};
    if (const auto* force = stage<ProbeForce>()) return force->force_N(tick, 0.0, memory);
    if (const auto* torque = stage<ProbeTorque>()) return torque->torque_Nm(tick);
    return 0.0;
  }
  /// What a sensor says of no force at all.
  std::array<double, 3> recorded() const {
    const ProbingMotion still{.t_s = {0.0, 1.0, 2.0}, .x_m = {0.0, 0.0, 0.0}};
    std::array<double, 3> out{};
    if (const auto* sensor = stage<ForceSensor>()) sensor->record(still, out);
    if (const auto* sensor = stage<TorqueSensor>()) sensor->record(still, out);
    return out;
  }
};

TEST_P(EveryProbingEffectsFacts, NameTheChannelOfItsStage) {
  EXPECT_EQ(info_.facts.channel == Channel::torque,
            stage<ProbeTorque>() != nullptr || stage<TorqueSensor>() != nullptr);
}

TEST_P(EveryProbingEffectsFacts, AreOfDryFrictionWhereItJumpsAsTheMotionTurnsBack) {
  EXPECT_EQ(info_.facts.is_dry, at(1e-12) - at(-1e-12) > 1e-6)
      << "at a speed of 1e-12 m/s forwards it exerts " << at(1e-12) << ", backwards " << at(-1e-12)
      << "; is_dry states whether it jumps up there. Friction opposes the motion: its force is "
         "positive while the probe advances";
}

TEST_P(EveryProbingEffectsFacts, AreOfABiasWhereTheSensorAddsAConstant) {
  const auto said = recorded();
  EXPECT_EQ(info_.facts.is_bias, said[0] != 0.0 && said[1] == said[0] && said[2] == said[0]);
}

std::vector<std::string> probing_ids() {
  std::vector<std::string> out;
  for (const auto& info : probing_effects()) out.push_back(info.facts.id);
  return out;
}
INSTANTIATE_TEST_SUITE_P(Effects, EveryProbingEffectsFacts, testing::ValuesIn(probing_ids()),
                         [](const auto& one) { return one.param; });

}  // namespace
}  // namespace effects
}  // namespace tractus
