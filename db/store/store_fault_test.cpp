/// Every write with its 1st, 2nd, … step failing until it succeeds: before that, nothing of it is
/// there.
#include <gtest/gtest.h>

#include <functional>

#include "core/try.hpp"
#include "db/store/cases/cases.hpp"
#include "db/store/database/migrations.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/people/accounts.hpp"
#include "db/store/people/sign_ins.hpp"
#include "db/store/store_test_support.hpp"
#include "db/store/studies/study_slots.hpp"
#include "db/store/trials/trials.hpp"
#include "db/store/trials/uploads.hpp"
#include "tests/support/database/database.hpp"

namespace tractus {
namespace store {
namespace {
using test_support::Content;
using test_support::DatabaseKind;
using test_support::TestDatabase;
using testing::FaultyConnection;

class StoreFaults : public test_support::BothDatabases {};
TRACTUS_ON_BOTH_DATABASES(StoreFaults);

const std::string kTrial(32, 'a');
const std::string kSha(64, 'b');
const std::string kCase(64, 'c');

using Work = std::function<core::Result<void>(Writing&)>;

/// A database in which a station has uploaded all bytes of a trial of a published case.
core::Result<void> furnish(Writing& tx) {
  TRY(add_account(tx, {"1", "ada", Role::admin, "hash"}, 1));
  TRY(add_station(tx, {"s", "station-1"}, "token", 1));
  TRY(add_case(tx, {kCase, "L3", "made", 1, 0}, {{"case.json", kCase, 9, false}}, 1));
  return add_upload(tx, {kTrial, "s", kCase, 10, kSha, UploadPhase::receiving}, 1);
}

TrialRecord trial() {
  TrialRecord out;
  out.summary.id = kTrial;
  out.summary.case_id = kCase;
  out.station_id = "s";
  out.sha256 = kSha;
  out.header = out.events = "{}";
  return out;
}

/// Everything that is in the database, as text.
std::string contents(Store& store) {
  std::string out;
  auto read = store.read([&](Reading& tx) -> core::Result<void> {
    for (const char* table :
         {"accounts", "sessions", "sign_in_failures", "known_origins", "stations", "objects",
          "cases", "case_parts", "uploads", "trials", "trial_metrics", "jobs", "studies",
          "study_scenarios", "study_participants", "study_slots", "study_trials", "study_events"}) {
      auto rows = TRY(tx.query(std::string("select * from ") + table));
      out += std::string(table) + ":" + std::to_string(rows.size()) + "\n";
      for (const Row& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i)
          if (const auto* text = std::get_if<std::string>(&row.value(i))) out += *text + ",";
    }
    return {};
  });
  EXPECT_TRUE(read);
  return out;
}

/// @returns how many steps the work takes when none fails.
int fails_cleanly_at_every_step(DatabaseKind kind, const Work& work) {
  for (int n = 1; n < 100; ++n) {
    const TestDatabase database(kind);
    EXPECT_TRUE(database.open().write(furnish));
    int fails_at = 0;
    Store store(database.connection(Access::read),
                std::make_unique<FaultyConnection>(database.connection(Access::write), fails_at));
    const std::string before = contents(store);
    fails_at = n;
    if (store.write(work)) {
      EXPECT_NE(contents(store), before) << "the work changes nothing: the test shows nothing";
      return n - 1;
    }
    EXPECT_EQ(contents(store), before) << "half written when step " << n << " failed";
    fails_at = 0;
    EXPECT_TRUE(store.write(work)) << "cannot be done again after step " << n << " failed";
  }
  ADD_FAILURE() << "never succeeded";
  return 0;
}

TEST_P(StoreFaults, ACommittedTrialIsWholeOrAbsent) {
  const int steps = fails_cleanly_at_every_step(GetParam(), [](Writing& tx) -> core::Result<void> {
    TRY(add_object(tx, kSha, 10, 2));
    TRY(add_trial(tx, trial(), 2));
    TRY(complete_upload(tx, kTrial));
    return queue_job(tx, JobKind::metrics, kTrial, 2);
  });
  // begin, five statements, the trial's row read for its digest, the trail's end, its new row,
  // commit
  EXPECT_EQ(steps, 10);
}

TEST_P(StoreFaults, APublishedCaseIsWholeOrAbsent) {
  const std::string id(64, 'd');
  EXPECT_GE(fails_cleanly_at_every_step(
                GetParam(),
                [&](Writing& tx) {
                  return add_case(tx, {id, "L4", "made", 1, 0},
                                  {{"case.json", id, 9, false}, {"truth.json", kSha, 4, true}}, 2);
                }),
            7);
}

/// A study of which a station has a trial, all of whose bytes are here.
core::Result<void> furnish_study(Writing& tx) {
  const Study study{.id = "study", .title = "", .ordering = CaseOrder::random};
  auto id = TRY(add_study(tx, study, {kCase}, {"ada", 1}));
  TRY(add_participant(tx, id, {.name = "P1"}, {kCase, kCase}, {"ada", 1}));
  auto slots = TRY(study_slots(tx, id));
  return announce_for_slot(tx, kTrial, slots.front().id, 1);
}

TEST_P(StoreFaults, ATrialOfAStudyAndItsPlaceInTheStudyAreThereTogetherOrNot) {
  for (const bool complete : {true, false}) {
    const int steps =
        fails_cleanly_at_every_step(GetParam(), [&](Writing& tx) -> core::Result<void> {
          TRY(furnish_study(tx));
          TRY(add_object(tx, kSha, 10, 2));
          TRY(add_trial(tx, trial(), 2));
          return record_for_slot(tx, kTrial, complete, {"station-1", 2});
        });
    EXPECT_GE(steps, 17);  // begin, 15 statements, commit; more when it is repeated
  }
}

TEST_P(StoreFaults, AnAssessmentIsWholeOrAbsent) {
  EXPECT_GE(fails_cleanly_at_every_step(
                GetParam(),
                [](Writing& tx) -> core::Result<void> {
                  TRY(add_object(tx, kSha, 10, 2));
                  TRY(add_trial(tx, trial(), 2));
                  return set_assessment(
                      tx, kTrial, {{"a", 1.5, ""}, {"b", std::nullopt, "no contact"}}, true, "{}");
                }),
            8);
}

TEST_P(StoreFaults, ASignInIsWholeOrAbsent) {
  EXPECT_GE(
      fails_cleanly_at_every_step(GetParam(),
                                  [](Writing& tx) -> core::Result<void> {
                                    const Attempt from{Secret::account_password, "ada", "peer"};
                                    TRY(clear_failures(tx, from));
                                    TRY(note_origin(tx, "1", from, 2, 1));
                                    return add_session(tx, "token", "1", 2);
                                  }),
      4);
}

TEST_P(StoreFaults, MigratingIsDoneAgainFromWhereItFailed) {
  for (int n = 1; n < 200; ++n) {
    const TestDatabase database(GetParam(), Content::nothing);
    int fails_at = n;
    FaultyConnection faulty(database.connection(Access::write), fails_at);
    const bool first = bool(migrate(faulty, migrations()));
    fails_at = 0;
    ASSERT_TRUE(migrate(faulty, migrations())) << "after step " << n << " failed";
    if (first) return;
  }
  FAIL() << "never succeeded";
}

}  // namespace
}  // namespace store
}  // namespace tractus
