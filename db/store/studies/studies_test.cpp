/// The rules of a study's trials: what is handed out to whom, what counts, what is repeated.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/studies/assignments.hpp"
#include "db/store/studies/study_slots.hpp"
#include "db/store/trials/trials.hpp"
#include "db/store/trials/uploads.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const std::string kA(64, 'a'), kB(64, 'b'), kWhole(64, 'w');
const AuditStamp kAda{"ada", 7, "said so"};

class Studies : public test_support::BothDatabases {
 protected:
  Studies() {
    write([](Writing& tx) -> core::Result<void> {
      for (const char* id : {"s1", "s2"})
        TRY(add_station(tx, {id, std::string("station-") + id}, id, 1));
      for (const std::string& id : {kA, kB})
        TRY(add_case(tx, {id, "scenario", "", 1, 0, trial::Rig::probing}, {}, 1));
      return add_case(tx, {kWhole, "whole bone", "", 1, 0, trial::Rig::palpation, false, true}, {},
                      1);
    });
  }
  template <class Work>
  void write(Work work) {
    auto done = store_.write(work);
    ASSERT_TRUE(done) << done.error().what;
  }
  void make(Repetition on_invalid) {
    write([&](Writing& tx) -> core::Result<void> {
      const Study study{.id = "study",
                        .title = "A study",
                        .ordering = CaseOrder::random,
                        .repeats = 2,
                        .seed = 3,
                        .on_invalid = on_invalid};
      TRY(add_study(tx, study, {kA, kB}, kAda));
      return add_participant(tx, find_study(tx, "study").value(), {.name = "P1"}, {kA, kB, kB},
                             kAda);
    });
  }
  /// A trial that drills and one that feels it, then an ordinary one.
  void make_drilling(Repetition on_invalid) {
    write([&](Writing& tx) -> core::Result<void> {
      const Study study{
          .id = "study", .title = "Drill", .ordering = CaseOrder::fixed, .on_invalid = on_invalid};
      TRY(add_study(tx, study, {kWhole, kB}, kAda));
      return add_participant(tx, find_study(tx, "study").value(), {.name = "P1"}, {kWhole, kB},
                             kAda);
    });
  }
  core::Result<Taken> take(const std::string& station, std::int64_t ahead) {
    return store_.write([&](Writing& tx) -> core::Result<Taken> {
      return take_slots(tx, find_study(tx, "study").value(),
                        **participant_of(tx, find_study(tx, "study").value(), "P1"), station, ahead,
                        {"station-" + station, 8});
    });
  }
  /// A whole trial for a slot, as the station's upload brings it.
  void bring(const std::string& trial_id, const Slot& slot, bool complete = true,
             const Tool& tool = {}) {
    write([&](Writing& tx) -> core::Result<void> {
      TRY(add_upload(tx, {trial_id, "s1", slot.case_id, 1, kA, UploadPhase::receiving}, 9));
      TRY(announce_for_slot(tx, trial_id, slot.id, 9));
      return record_for_slot(tx, trial_id, complete, {"station-s1", 10}, tool);
    });
  }
  /// What the next trial of the participant at s1 is to feel.
  std::string drilling() {
    const std::string slot = take("s1", 1).value().slots.at(0).id;
    return store_.read([&](Reading& tx) { return drilling_of(tx, slot); }).value();
  }
  /// State of each slot in the participant's order and its case, a letter each.
  std::string states() {
    std::string out;
    const auto found =
        store_.read([](Reading& tx) { return study_slots(tx, find_study(tx, "study").value()); });
    for (const Slot& slot : found.value()) {
      out += name(slot.state).front();
      out += slot.case_id.front();
      out += ' ';
    }
    return out;
  }
  std::vector<std::string> happened() {
    std::vector<std::string> out;
    const auto found = store_.read(
        [](Reading& tx) { return study_events(tx, find_study(tx, "study").value(), 100); });
    for (const auto& event : found.value()) out.insert(out.begin(), event.who + " " + event.what);
    return out;
  }
  std::string state_of(const std::string& trial_id) {
    const auto found =
        store_.read([](Reading& tx) { return study_trials(tx, find_study(tx, "study").value()); });
    for (const auto& trial : found.value())
      if (trial.trial_id == trial_id) return std::string(name(trial.state));
    return "absent";
  }

  test_support::TestDatabase database_{GetParam()};
  Store store_ = database_.open();
};
TRACTUS_ON_BOTH_DATABASES(Studies);

TEST_P(Studies, HandOutTheNextTrialAndTheSameOneWhenAskedAgain) {
  make(Repetition::at_end);
  const auto first = take("s1", 1), again = take("s1", 1);
  ASSERT_TRUE(first && again);
  ASSERT_EQ(first->slots.size(), 1u);
  EXPECT_EQ(first->slots[0].id, again->slots[0].id);
  EXPECT_EQ(first->unfinished, 3u);
  EXPECT_EQ(states(), "ta wb wb ");
  bring("t1", first->slots[0]);
  const auto next = take("s1", 1);
  EXPECT_EQ(next->slots[0].position, 1);
  EXPECT_EQ(next->unfinished, 2u);
}

TEST_P(Studies, GiveOneParticipantToOneStationAtATime) {
  make(Repetition::at_end);
  ASSERT_TRUE(take("s1", 2));
  const auto refused = take("s2", 1);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::conflict);
  EXPECT_THAT(refused.error().what, HasSubstr("another station"));
  write([](Writing& tx) -> core::Result<void> {
    auto freed = TRY(release_slots(tx, find_study(tx, "study").value(), "P1", kAda));
    EXPECT_EQ(freed, 2u);
    return {};
  });
  EXPECT_TRUE(take("s2", 1));
}

TEST_P(Studies, AStationWhoseAccessWasRevokedHoldsNobodyBack) {
  make(Repetition::at_end);
  ASSERT_TRUE(take("s1", 2));
  write([](Writing& tx) { return revoke_station(tx, "s1", 7); });
  const auto next = take("s2", 1);
  ASSERT_TRUE(next) << next.error().what;
  EXPECT_EQ(next->slots[0].position, 0);
  EXPECT_EQ(states(), "ta wb wb ");
}

TEST_P(Studies, HandOutNothingWhilePaused) {
  make(Repetition::at_end);
  const auto set = [&](bool whole, StudyState state) {
    write([&](Writing& tx) {
      return whole ? set_study_state(tx, find_study(tx, "study").value(), state, kAda)
                   : set_participant_state(tx, find_study(tx, "study").value(), "P1", state, kAda);
    });
  };
  for (const bool whole : {true, false}) {
    set(whole, StudyState::paused);
    const auto refused = take("s1", 1);
    ASSERT_FALSE(refused);
    EXPECT_THAT(refused.error().what, HasSubstr("paused"));
    set(whole, StudyState::running);
    EXPECT_TRUE(take("s1", 1));
  }
}

TEST_P(Studies, KeepAnInvalidTrialAndRepeatItsSlotAtTheEnd) {
  make(Repetition::at_end);
  bring("t1", take("s1", 1)->slots[0]);
  write([](Writing& tx) {
    return set_trial_invalid(tx, find_study(tx, "study").value(), "t1", kAda);
  });
  EXPECT_EQ(state_of("t1"), "invalid");
  EXPECT_EQ(states(), "ia wb wb wa ");
}

TEST_P(Studies, RepeatAnInvalidTrialAtOnceOrNeverWhenTheStudySaysSo) {
  make(Repetition::at_once);
  bring("t1", take("s1", 1)->slots[0]);
  write([](Writing& tx) {
    return set_trial_invalid(tx, find_study(tx, "study").value(), "t1", kAda);
  });
  EXPECT_EQ(states(), "ia wa wb wb ");
  write([](Writing& tx) {
    return tx.query("update studies set on_invalid = 'never'").value(), core::Result<void>();
  });
  bring("t2", take("s1", 1)->slots[0]);
  write([](Writing& tx) {
    return set_trial_invalid(tx, find_study(tx, "study").value(), "t2", kAda);
  });
  EXPECT_EQ(states(), "ia ia wb wb ");
}

TEST_P(Studies, ATrialCutShortDoesNotCountAndIsRepeated) {
  make(Repetition::at_end);
  bring("t1", take("s1", 1)->slots[0], false);
  EXPECT_EQ(state_of("t1"), "invalid");
  EXPECT_EQ(states(), "ia wb wb wa ");
}

TEST_P(Studies, ASecondTrialForASlotIsKeptAndDoesNotCount) {
  make(Repetition::at_end);
  const auto slot = take("s1", 1)->slots[0];
  bring("t1", slot);
  bring("t2", slot);
  EXPECT_EQ(state_of("t1"), "counts");
  EXPECT_EQ(state_of("t2"), "surplus");
  EXPECT_EQ(states(), "ra wb wb ");
}

TEST_P(Studies, OnlyATrialThatCountsOfThisStudyCanBeMarkedInvalid) {
  make(Repetition::at_end);
  bring("t1", take("s1", 1)->slots[0]);
  write([](Writing& tx) -> core::Result<void> {
    auto other =
        add_study(tx, {.id = "other", .title = "", .ordering = CaseOrder::random}, {kA}, kAda);
    return other ? core::Result<void>() : other.error();
  });
  const auto mark = [&](const char* study, const char* trial) {
    return store_.write([&](Writing& tx) {
      return set_trial_invalid(tx, find_study(tx, study).value(), trial, kAda);
    });
  };
  EXPECT_EQ(mark("other", "t1").error().code, core::Errc::not_found);
  EXPECT_EQ(mark("study", "t9").error().code, core::Errc::not_found);
  ASSERT_TRUE(mark("study", "t1"));
  EXPECT_EQ(mark("study", "t1").error().code, core::Errc::conflict);
}

/// The row's kind decides, whatever the id looks like.
TEST_P(Studies, AStudyAndAnAssignmentAreNotFoundAsEachOther) {
  write([](Writing& tx) -> core::Result<void> {
    TRY(add_account(tx, {"fay", "fay", Role::faculty, "x"}, 0));
    const Study like_an_assignment{.id = "a-study", .title = "", .ordering = CaseOrder::random};
    TRY(add_study(tx, like_an_assignment, {kA}, kAda));
    const Assignment assignment{
        .study = {.id = "spine", .title = "", .ordering = CaseOrder::random}, .made_by_id = "fay"};
    auto added = add_assignment(tx, assignment, {kA}, kAda);
    return added ? core::Result<void>() : added.error();
  });
  write([](Writing& tx) -> core::Result<void> {
    EXPECT_TRUE(find_study(tx, "a-study"));
    EXPECT_TRUE(find_assignment(tx, "spine"));
    EXPECT_EQ(find_study(tx, "spine").error().code, core::Errc::not_found);
    EXPECT_EQ(find_assignment(tx, "a-study").error().code, core::Errc::not_found);
    const auto studies = all_studies(tx);
    EXPECT_EQ(studies->size(), 1u);
    EXPECT_EQ(studies->front().study.id, "a-study");
    return {};
  });
}
static_assert(!std::is_convertible_v<AssignmentId, StudyId>);
static_assert(!std::is_constructible_v<StudyId, AssignmentId>);
static_assert(!std::is_constructible_v<StudyId, std::string>);

TEST_P(Studies, NoteEveryChangeWithWhoDidIt) {
  make(Repetition::at_end);
  bring("t1", take("s1", 1)->slots[0]);
  write([](Writing& tx) {
    return set_trial_invalid(tx, find_study(tx, "study").value(), "t1", kAda);
  });
  write([](Writing& tx) {
    return set_study_state(tx, find_study(tx, "study").value(), StudyState::paused, kAda);
  });
  EXPECT_THAT(happened(),
              ElementsAre("ada made", "ada enrolled", "station-s1 taken", "station-s1 recorded",
                          "ada invalid", "ada repeated", "ada paused"));
}

const Tool kBurr{.burr = true};
Tool feeling(const std::string& drilled) { return {.burr = false, .drilled = drilled}; }

TEST_P(Studies, WholeBoneIsDoneWhenItsChannelWasDrilledAndThatVeryChannelFelt) {
  make_drilling(Repetition::at_end);
  const Slot slot = take("s1", 1)->slots[0];
  EXPECT_EQ(drilling(), "");
  bring("t1", slot, true, kBurr);
  EXPECT_EQ(states(), "tw wb ");
  EXPECT_EQ(take("s1", 1)->slots[0].id, slot.id);
  EXPECT_EQ(take("s1", 1)->unfinished, 2u);
  EXPECT_EQ(drilling(), "t1");
  EXPECT_FALSE(take("s2", 1)) << "the channel is on the first station's disk";
  bring("t2", slot, true, feeling("t1"));
  EXPECT_EQ(states(), "rw wb ");
  EXPECT_EQ(state_of("t1") + " " + state_of("t2"), "counts counts");
  EXPECT_EQ(take("s1", 1)->unfinished, 1u);
}

TEST_P(Studies, WholeBoneIsNotDoneByAPalpationOfAnotherChannelOrOfNone) {
  make_drilling(Repetition::at_end);
  const Slot slot = take("s1", 1)->slots[0];
  bring("t1", slot);
  EXPECT_EQ(state_of("t1"), "surplus");
  bring("t2", slot, true, kBurr);
  bring("t3", slot, true, feeling("t9"));
  bring("t4", slot, true, kBurr);
  EXPECT_EQ(state_of("t3") + " " + state_of("t4"), "surplus surplus");
  EXPECT_EQ(states(), "tw wb ");
  EXPECT_EQ(drilling(), "t2");
}

TEST_P(Studies, ADrillingCutShortIsRepeatedAsAnyTrial) {
  make_drilling(Repetition::at_once);
  bring("t1", take("s1", 1)->slots[0], false, kBurr);
  EXPECT_EQ(states(), "iw ww wb ");
  EXPECT_EQ(drilling(), "");
}

TEST_P(Studies, APalpationCutShortOrInvalidIsDoneAgainOnTheChannelThatIsThere) {
  make_drilling(Repetition::at_end);
  const Slot slot = take("s1", 1)->slots[0];
  bring("t1", slot, true, kBurr);
  bring("t2", slot, false, feeling("t1"));
  EXPECT_EQ(state_of("t2"), "invalid");
  EXPECT_EQ(drilling(), "t1");
  bring("t3", slot, true, feeling("t1"));
  EXPECT_EQ(states(), "rw wb ");
  write([](Writing& tx) {
    return set_trial_invalid(tx, find_study(tx, "study").value(), "t3", kAda);
  });
  EXPECT_EQ(states(), "tw wb ");
  EXPECT_EQ(drilling(), "t1");
}

TEST_P(Studies, APalpationThatDoesNotCountEndsWholeBoneWhereNothingIsRepeated) {
  make_drilling(Repetition::never);
  const Slot slot = take("s1", 1)->slots[0];
  bring("t1", slot, true, kBurr);
  bring("t2", slot, false, feeling("t1"));
  EXPECT_EQ(states(), "iw wb ");
}

TEST_P(Studies, WithADrillingThatDoesNotCountGoesThePalpationOfItsChannel) {
  make_drilling(Repetition::at_end);
  const Slot slot = take("s1", 1)->slots[0];
  bring("t1", slot, true, kBurr);
  bring("t2", slot, true, feeling("t1"));
  write([](Writing& tx) {
    return set_trial_invalid(tx, find_study(tx, "study").value(), "t1", kAda);
  });
  EXPECT_EQ(state_of("t1") + " " + state_of("t2"), "invalid invalid");
  EXPECT_EQ(states(), "iw wb ww ");
}

TEST_P(Studies, AFreedChannelThatWasNotFeltIsDrilledAnewWherever) {
  make_drilling(Repetition::at_end);
  bring("t1", take("s1", 1)->slots[0], true, kBurr);
  write([](Writing& tx) -> core::Result<void> {
    auto freed = release_slots(tx, find_study(tx, "study").value(), "P1", kAda);
    return freed ? core::Result<void>() : freed.error();
  });
  EXPECT_EQ(state_of("t1"), "invalid");
  EXPECT_EQ(drilling(), "");
  EXPECT_EQ(states(), "tw wb ");
}

TEST_P(Studies, ACaseNotedBeforeWasKnownToBePlannedIsPutRightByPublishingItAgain) {
  write([](Writing& tx) {
    return add_case(tx, {kA, "", "", 1, 0, trial::Rig::palpation, false, true}, {}, 2);
  });
  const auto known = store_.read([](Reading& tx) { return case_of(tx, kA); });
  EXPECT_TRUE((*known)->planned);
  EXPECT_EQ((*known)->title, "scenario");
}

}  // namespace
}  // namespace store
}  // namespace tractus
