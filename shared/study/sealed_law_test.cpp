#include "study/sealed_law.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/bytes.hpp"
#include "scenarios/scenario.hpp"

namespace tractus {
namespace study {
namespace {

const std::string kTrial(64, 'a');
const StationKey kKey(std::string(64, '1')), kOther(std::string(64, '2'));

laws::ProbingParameters law(scenarios::Kind kind) {
  return scenarios::tuned(kind).value().expanded().value();
}

TEST(SealedLaw, OpensToTheSameNumbersToTheBit) {
  for (const auto kind : {scenarios::Kind::hard, scenarios::Kind::in_out_in}) {
    const auto given = law(kind);
    const auto back = opened_law(sealed_law(given, kTrial, kKey).value(), kTrial, kKey);
    ASSERT_TRUE(back) << back.error().what;
    const auto made = laws::ProbingLaw::make(*back), meant = laws::ProbingLaw::make(given);
    ASSERT_TRUE(made && meant);
    for (double x_m = 0.0; x_m < 0.05; x_m += 0.00037)
      EXPECT_EQ(made->force_N(x_m, 0.006), meant->force_N(x_m, 0.006)) << x_m;
    EXPECT_EQ(back->travel_m, given.travel_m);
    EXPECT_EQ(back->walls.size(), given.walls.size());
    EXPECT_EQ(back->rotary.detent_pitch_rad, given.rotary.detent_pitch_rad);
  }
}

TEST(SealedLaw, HasOneSizeAndNoTwoSealingsAlike) {
  std::set<std::string> seen;
  for (const auto kind : {scenarios::Kind::hard, scenarios::Kind::soft,
                          scenarios::Kind::lateral_breach, scenarios::Kind::in_out_in})
    for (int again = 0; again < 3; ++again) {
      const auto sealed = sealed_law(law(kind), kTrial, kKey);
      ASSERT_TRUE(sealed);
      EXPECT_EQ(sealed->size(), kSealed_characters);
      seen.insert(sealed->substr(0, 64));
    }
  EXPECT_EQ(seen.size(), 12u);
}

TEST(SealedLaw, OpensForNoOtherTrialAndNoOtherStation) {
  const auto sealed = sealed_law(law(scenarios::Kind::hard), kTrial, kKey).value();
  EXPECT_FALSE(opened_law(sealed, std::string(64, 'b'), kKey));
  EXPECT_FALSE(opened_law(sealed, kTrial, kOther));
  ASSERT_TRUE(opened_law(sealed, kTrial, kKey));
}

TEST(SealedLaw, IsRefusedWhenAnyPartOfItChanged) {
  const auto sealed = sealed_law(law(scenarios::Kind::hard), kTrial, kKey).value();
  for (std::size_t at = 0; at < sealed.size(); at += 997) {
    auto changed = sealed;
    changed[at] = changed[at] == 'A' ? 'B' : 'A';
    const auto opened = opened_law(changed, kTrial, kKey);
    ASSERT_FALSE(opened) << at;
    EXPECT_EQ(opened.error().code, core::Errc::corrupt);
  }
  for (const std::string& rubbish :
       {std::string(), std::string("rubbish"), sealed + "AAAA", sealed.substr(0, 100)})
    EXPECT_FALSE(opened_law(rubbish, kTrial, kKey));
}

TEST(SealedLaw, RefusesMoreLayersThanItsSizeHolds) {
  laws::ProbingParameters many;
  for (int i = 0; i < 1000; ++i) many.layers.push_back({i * 1e-4, 1e-4, 1.0 / 3, 2.0 / 3, 0.1});
  const auto refused = sealed_law(many, kTrial, kKey);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::too_large);
}

}  // namespace
}  // namespace study
}  // namespace tractus
