/// Who agreed to what, by the words of consent.hpp.
#include "db/store/people/consent.hpp"

#include "db/store/store_test_support.hpp"

namespace tractus {
namespace store {
namespace {

class ConsentTest : public ::testing::Test {
 protected:
  void say(const Consent& consent) {
    ASSERT_TRUE(store_.write([&](Writing& tx) { return set_consent(tx, consent); }));
  }
  ConsentBook book() {
    return store_.read([](Reading& tx) { return ConsentBook::read(tx); }).value();
  }
  testing::TestFolder folder_;
  Store store_ = std::move(Store::open(folder_.path() / "tractus.db").value());
};

CohortTrial trial_of(const std::string& study, const std::string& participant) {
  CohortTrial out;
  out.study = study;
  out.participant = participant;
  out.summary.operator_name = "Erika";
  return out;
}

TEST_F(ConsentTest, ATrialInNoStudyIsNobodysToHaveUnlessItIsSimulated) {
  CohortTrial trial = trial_of("", "");
  EXPECT_EQ(book().tier_of(trial), Tier::none);
  trial.summary.simulated = true;
  EXPECT_EQ(book().tier_of(trial), Tier::full);
}

TEST_F(ConsentTest, TakingPartInAStudyGivesScoresAndNoSamples) {
  EXPECT_EQ(book().tier_of(trial_of("S", "P1")), Tier::metrics);
  say({"", "S", "P1", Tier::full, "form 12", 1, "ann"});
  EXPECT_EQ(book().tier_of(trial_of("S", "P1")), Tier::full);
  EXPECT_EQ(book().tier_of(trial_of("S", "P2")), Tier::metrics);
  say({"", "S", "P1", Tier::none, "withdrew", 2, "ann"});
  EXPECT_EQ(book().tier_of(trial_of("S", "P1")), Tier::none);
}

TEST_F(ConsentTest, WhatAnAccountSaysOfEverywhereReplacesWhatItSaidOfStudies) {
  say({"tom", "", "", Tier::summary, "own word", 1, "tom"});
  say({"tom", "A", "", Tier::full, "own word", 2, "tom"});
  EXPECT_EQ(book().tier_of("tom", "A"), Tier::full);
  EXPECT_EQ(book().tier_of("tom", "B"), Tier::summary);
  say({"tom", "", "", Tier::none, "own word", 3, "tom"});
  EXPECT_EQ(book().tier_of("tom", "A"), Tier::none);
  EXPECT_EQ(book().tier_of("tia", "A"), Tier::none) << "who said nothing agreed to nothing";
}

TEST_F(ConsentTest, TiersAreNamedBothWays) {
  for (const Tier tier : kTiers) EXPECT_EQ(core::from_name<Tier>(name(tier)), tier);
  EXPECT_FALSE(core::from_name<Tier>("all"));
}

}  // namespace
}  // namespace store
}  // namespace tractus
