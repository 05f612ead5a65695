#include "scenarios/version.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace tractus {
namespace scenarios {
namespace {

using testing::StartsWith;

constexpr std::int64_t kNoon_us =
    1772366400000000;  // 2026-03-01T12:00:00Z by `date -d @1772366400`

std::string refusal(const std::string& text) {
  const auto change = parse_change(text);
  if (!change) return change.error().what;
  const auto next = next_version(*tuned(Kind::in_out_in), {{*change}}, "R. Z.", kNoon_us);
  return next ? "taken" : next.error().what;
}

TEST(NextVersion, HoldsTheChangeAndSaysWhoWhenAndFromWhat) {
  const auto parent = *tuned(Kind::in_out_in);
  const std::vector<Change> changes{*parse_change("bone/stiffness_N_per_m=9000"),
                                    *parse_change("walls_m=[0.016]"),
                                    *parse_change("name=\"steeper\"")};
  const auto next = next_version(parent, changes, "R. Z.", kNoon_us);
  ASSERT_TRUE(next) << next.error().what;
  EXPECT_EQ(next->bone.stiffness_N_per_m, 9000.0);
  EXPECT_EQ(next->walls_m, std::vector<double>{0.016});
  EXPECT_EQ(next->name, "steeper");
  EXPECT_EQ(next->bone.damping_Ns_per_m, parent.bone.damping_Ns_per_m);
  EXPECT_EQ(next->origin.who, "R. Z.");
  EXPECT_EQ(next->origin.when, "2026-03-01T12:00:00.000000Z");
  EXPECT_EQ(next->origin.parent, parent.id());
  EXPECT_NE(next->id(), parent.id());
}

TEST(NextVersion, KeepsTheLineOfVersions) {
  const auto first = *next_version(*tuned(Kind::soft), {}, "R. Z.", kNoon_us);
  const auto second = *next_version(first, {}, "J. O'S.", kNoon_us + 1);
  EXPECT_EQ(second.origin.parent, first.id());
}

TEST(NextVersion, RefusesWhatIsNoFieldAndWhatCannotBe) {
  EXPECT_THAT(refusal("bone/mass_kg=1"), StartsWith("/bone/mass_kg: names no field"));
  EXPECT_THAT(refusal("~=1"), StartsWith("/~: names no field"));
  EXPECT_THAT(refusal("layers/-=1"), StartsWith("/layers/-: names no field"));
  EXPECT_THAT(refusal("walls_m/7=0.02"), StartsWith("/walls_m/7: names no field"));
  EXPECT_THAT(refusal("origin/who=\"me\""), StartsWith("/origin/who: is written"));
  EXPECT_THAT(refusal("format=1"), StartsWith("/format: is written"));
  EXPECT_THAT(refusal("bone=3"), StartsWith("/bone: a JSON object"));
  EXPECT_THAT(refusal("bone/stiffness_N_per_m=-1"), StartsWith("/bone/stiffness_N_per_m: -1"));
  EXPECT_THAT(refusal("bone/stiffness_N_per_m=NaN"), StartsWith("'bone/stiffness_N_per_m=NaN'"));
  EXPECT_THAT(refusal("density"), StartsWith("'density': FIELD=VALUE"));
  EXPECT_THAT(refusal("=3"), StartsWith("'=3': FIELD=VALUE"));
}

}  // namespace
}  // namespace scenarios
}  // namespace tractus
