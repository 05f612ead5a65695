#include "server/api/trials/uploads.hpp"

#include <fstream>
#include <future>

#include "core/try.hpp"
#include "db/store/operations/jobs.hpp"
#include "db/store/trials/trials.hpp"
#include "server/api/api_test_support.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace api {
namespace {
using store::testing::FaultyConnection;
using testing::ApiTest;
using testing::kCase;

const std::string kTrial(32, 'a');
const Caller kOne{Role::station, "s1", "station-1", ""};
const Caller kTwo{Role::station, "s2", "station-2", ""};

class Uploads : public ApiTest {
 protected:
  wire::UploadAnnouncement announcement(const std::string& bytes) const {
    return {kCase, bytes.size(), core::sha256(core::bytes_of(bytes))};
  }
  core::Result<Appended> send(const std::string& bytes, std::uint64_t from, std::uint64_t to) {
    const auto piece = core::bytes_of(std::string_view(bytes).substr(from, to - from));
    return append_upload(backend_, kOne, kTrial, from, core::crc32c(piece), piece);
  }
  /// Announced and sent in two pieces.
  void sent(const std::string& bytes) {
    ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes)));
    ASSERT_TRUE(send(bytes, 0, 100));
    ASSERT_TRUE(send(bytes, 100, bytes.size()));
  }
  std::uint64_t offset() { return upload_state(backend_, kOne, kTrial).value().offset_bytes; }
  std::size_t trials() {
    return store_.read([](store::Reading& tx) { return store::trials_before(tx, INT64_MAX, 9); })
        .value()
        .size();
  }
  const std::string bytes_ = world::trial_bytes(folder_.path(), kTrial, kCase, 250);
};

TEST_F(Uploads, BecomeATrialAJobAndAnObject) {
  sent(bytes_);
  auto state = commit_upload(backend_, kOne, kTrial);
  ASSERT_TRUE(state) << state.error().what;
  EXPECT_EQ(state->state, trial::UploadPhase::complete);
  auto trial = store_.read([](store::Reading& tx) { return store::trial_of(tx, kTrial); });
  ASSERT_TRUE(trial && *trial);
  EXPECT_EQ((*trial)->summary.samples, 250u);
  EXPECT_EQ((*trial)->summary.station, "station-1");
  EXPECT_NEAR((*trial)->summary.duration_s, 0.249, 1e-12);  // 250 samples at 1 kHz
  EXPECT_EQ((*trial)->late_ticks, 2u);                      // ticks 99 and 199
  EXPECT_EQ((*trial)->skipped_ticks, 0u);
  EXPECT_TRUE((*trial)->complete);
  EXPECT_EQ(world::bytes_of(objects_.path_of((*trial)->sha256)), bytes_);
  EXPECT_EQ(partials_.size_of(kTrial), 0u);
  EXPECT_EQ(woken_, 1);
  auto job = store_.write(
      [](store::Writing& tx) { return store::claim_job(tx, {store::JobKind::metrics}, 1); });
  ASSERT_TRUE(job && *job);
  EXPECT_EQ((*job)->subject, kTrial);
}

TEST_F(Uploads, CommittingTwiceIsCommittingOnce) {
  sent(bytes_);
  ASSERT_TRUE(commit_upload(backend_, kOne, kTrial));
  EXPECT_TRUE(commit_upload(backend_, kOne, kTrial));
  EXPECT_EQ(trials(), 1u);
  auto again = announce_upload(backend_, kOne, kTrial, announcement(bytes_));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->state, trial::UploadPhase::complete);
}

TEST_F(Uploads, TheSameAnnouncementIsTheSameUploadAndAnotherAConflict) {
  sent(bytes_);
  auto same = announce_upload(backend_, kOne, kTrial, announcement(bytes_));
  ASSERT_TRUE(same);
  EXPECT_EQ(same->offset_bytes, bytes_.size());
  auto other = announce_upload(backend_, kOne, kTrial, announcement(bytes_ + "x"));
  ASSERT_FALSE(other);
  EXPECT_EQ(other.error().code, core::Errc::conflict);
}

TEST_F(Uploads, AnnounceTogetherNoMoreThanTheDiskHas) {
  constexpr std::uint64_t kMib = 1u << 20;
  // 256 MiB are left free always: two announcements of 400 MiB fit beside them, three do not.
  std::uint64_t free = 1100 * kMib;
  backend_.free_bytes = [&] { return free; };
  const wire::UploadAnnouncement large{kCase, 400 * kMib, std::string(64, 'e')};
  const auto announce = [&](char id) {
    return announce_upload(backend_, id == 'c' ? kTwo : kOne, std::string(32, id), large);
  };
  ASSERT_TRUE(announce('a'));
  ASSERT_TRUE(announce('b'));
  const auto third = announce('c');
  ASSERT_FALSE(third);
  EXPECT_EQ(third.error().code, core::Errc::unavailable);
  EXPECT_TRUE(announce('a')) << "its room is kept";
  EXPECT_TRUE(check_disk(backend_, 0)) << "the disk itself is not full";
  EXPECT_FALSE(check_room(backend_, kTrialToCome_bytes));
  now_ += 3'601'000'000;  // abandoned
  EXPECT_TRUE(announce('c'));
}

TEST_F(Uploads, NeedNoRoomForWhatIsHereAlready) {
  ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes_)));
  ASSERT_TRUE(send(bytes_, 0, bytes_.size()));
  backend_.free_bytes = [] { return std::uint64_t{256} << 20; };
  EXPECT_TRUE(check_room(backend_, 0));
  EXPECT_FALSE(check_room(backend_, 1));
}

TEST_F(Uploads, OfAnotherStationDoNotExist) {
  sent(bytes_);
  EXPECT_EQ(upload_state(backend_, kTwo, kTrial).error().code, core::Errc::not_found);
  EXPECT_EQ(announce_upload(backend_, kTwo, kTrial, announcement(bytes_)).error().code,
            core::Errc::not_found);
  EXPECT_EQ(commit_upload(backend_, kTwo, kTrial).error().code, core::Errc::not_found);
  EXPECT_EQ(append_upload(backend_, kTwo, kTrial, 0, 0, {}).error().code, core::Errc::not_found);
}

TEST_F(Uploads, WhoAsksForThoseOfAnotherDoesNotWaitForTheirLock) {
  sent(bytes_);
  auto held = store_.hold("upload " + std::string(kTrial));
  ASSERT_TRUE(held) << held.error().what;
  auto asked = std::async(std::launch::async, [&] {
    return std::array{upload_state(backend_, kTwo, kTrial).error().code,
                      append_upload(backend_, kTwo, kTrial, 0, 0, {}).error().code,
                      commit_upload(backend_, kTwo, kTrial).error().code};
  });
  const bool answered = asked.wait_for(std::chrono::seconds(5)) == std::future_status::ready;
  held->reset();
  EXPECT_TRUE(answered);
  for (const core::Errc code : asked.get()) EXPECT_EQ(code, core::Errc::not_found);
}

TEST_F(Uploads, APieceElsewhereIsNotTakenAndToldWhereItStands) {
  sent(bytes_.substr(0, 200));
  auto again = send(bytes_, 0, 100);
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->taken);
  EXPECT_EQ(again->state.offset_bytes, 200u);
}

TEST_F(Uploads, AWrongChecksumTooMuchAndNothingAreRefusedAndLeaveTheOffset) {
  ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes_)));
  const auto piece = core::bytes_of(bytes_);
  EXPECT_EQ(append_upload(backend_, kOne, kTrial, 0, core::crc32c(piece) + 1, piece).error().code,
            core::Errc::corrupt);
  const std::string more = bytes_ + "x";
  EXPECT_EQ(send(more, 0, more.size()).error().code, core::Errc::out_of_range);
  EXPECT_EQ(send(bytes_, 0, 0).error().code, core::Errc::bad_input);
  EXPECT_EQ(offset(), 0u);
  EXPECT_EQ(partials_.size_of(kTrial), 0u);
}

TEST_F(Uploads, BytesThatAreNotTheAnnouncedOnesBeginAgain) {
  std::string other = bytes_;
  other[500] = static_cast<char>(other[500] ^ 1);
  ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes_)));
  ASSERT_TRUE(send(other, 0, other.size()));
  auto refused = commit_upload(backend_, kOne, kTrial);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::corrupt);
  EXPECT_EQ(offset(), 0u);
  ASSERT_TRUE(send(bytes_, 0, bytes_.size()));
  EXPECT_TRUE(commit_upload(backend_, kOne, kTrial));
}

TEST_F(Uploads, WhatIsNotAWholeTrialOfThisIdAndCaseIsRefused) {
  const std::string other_id(32, 'b'), other_case(64, 'd');
  std::string damaged = bytes_;
  damaged[bytes_.size() / 2] = static_cast<char>(damaged[bytes_.size() / 2] ^ 1);
  for (const std::string& bad :
       {world::trial_bytes(folder_.path(), other_id, kCase, 250),
        world::trial_bytes(folder_.path(), kTrial, other_case, 250),
        world::trial_bytes(folder_.path(), kTrial, kCase, 250, world::Ending::torn),
        world::trial_bytes(folder_.path(), kTrial, kCase, 0), bytes_.substr(0, 900), damaged,
        std::string(1000, 'x')}) {
    ASSERT_TRUE(store_.write([](store::Writing& tx) { return tx.query("delete from uploads"); }));
    sent(bad);
    auto refused = commit_upload(backend_, kOne, kTrial);
    ASSERT_FALSE(refused) << bad.size();
    EXPECT_EQ(status_of(refused.error().code), 400) << refused.error().what;
    EXPECT_EQ(refused.error().what.find(folder_.path().string()), std::string::npos)
        << "a station is told nothing of our disk: " << refused.error().what;
    EXPECT_EQ(trials(), 0u);
    EXPECT_EQ(partials_.size_of(kTrial), 0u);
  }
}

TEST_F(Uploads, ACommitBeforeAllIsHereIsAConflict) {
  ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes_)));
  ASSERT_TRUE(send(bytes_, 0, 100));
  EXPECT_EQ(commit_upload(backend_, kOne, kTrial).error().code, core::Errc::conflict);
  EXPECT_EQ(offset(), 100u);
}

TEST_F(Uploads, AnUnknownCaseAnOversizeAndAnEvilNameAreRefused) {
  EXPECT_EQ(announce_upload(backend_, kOne, kTrial, {std::string(64, 'e'), 10, kCase}).error().code,
            core::Errc::not_found);
  EXPECT_EQ(
      announce_upload(backend_, kOne, kTrial, {kCase, kMaxTrial_bytes + 1, kCase}).error().code,
      core::Errc::too_large);
  EXPECT_EQ(announce_upload(backend_, kOne, "../../etc/passwd", {kCase, 10, kCase}).error().code,
            core::Errc::bad_input);
  EXPECT_EQ(upload_state(backend_, kOne, "../../etc/passwd").error().code, core::Errc::not_found);
}

// A process that dies within a piece leaves the beginning of it; the station goes on from there.
TEST_F(Uploads, AfterACrashItGoesOnFromWhatTheFileHolds) {
  ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes_)));
  ASSERT_TRUE(send(bytes_, 0, 100));
  ASSERT_TRUE(partials_.append(kTrial, 100, core::bytes_of(bytes_.substr(100, 7))));
  ASSERT_TRUE(reconcile_uploads(backend_));
  EXPECT_EQ(offset(), 107u);
  ASSERT_TRUE(send(bytes_, 107, bytes_.size()));
  EXPECT_TRUE(commit_upload(backend_, kOne, kTrial));
}

TEST_F(Uploads, BytesThatChangedOnTheDiskAreFoundAtTheEndAndBeginAgain) {
  ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes_)));
  ASSERT_TRUE(send(bytes_, 0, 100));
  std::fstream file(partials_.path_of(kTrial), std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(10);
  file.put('\xff').flush();
  ASSERT_TRUE(reconcile_uploads(backend_));
  ASSERT_TRUE(send(bytes_, 100, bytes_.size()));
  EXPECT_EQ(commit_upload(backend_, kOne, kTrial).error().code, core::Errc::corrupt);
  EXPECT_EQ(offset(), 0u);
  ASSERT_TRUE(send(bytes_, 0, bytes_.size()));
  EXPECT_TRUE(commit_upload(backend_, kOne, kTrial));
}

TEST_F(Uploads, AFileThatIsGoneBeginsAgain) {
  ASSERT_TRUE(announce_upload(backend_, kOne, kTrial, announcement(bytes_)));
  ASSERT_TRUE(send(bytes_, 0, 100));
  partials_.remove(kTrial);
  auto lost = send(bytes_, 100, bytes_.size());
  ASSERT_TRUE(lost);
  EXPECT_FALSE(lost->taken);
  EXPECT_EQ(lost->state.offset_bytes, 0u);
}

TEST_F(Uploads, PartialFilesThatBelongToNoOpenUploadGo) {
  ASSERT_TRUE(partials_.append(std::string(32, 'f'), 0, core::bytes_of("orphan")));
  ASSERT_TRUE(reconcile_uploads(backend_));
  EXPECT_TRUE(partials_.ids().empty());
}

/// The 1st, 2nd, … step of the database fails during the commit, then the process starts anew: no
/// trial, or all of it.
TEST_F(Uploads, ACommitThatFailsAtAnyStepCanBeDoneAgain) {
  for (int n = 1; n < 100; ++n) {
    ASSERT_TRUE(store_.write([](store::Writing& tx) -> core::Result<void> {
      for (const char* table : {"jobs", "trial_entries", "trials", "uploads", "objects"})
        TRY(tx.query(std::string("delete from ") + table));
      return {};
    }));
    sent(bytes_);
    int fails_at = n;
    store::Store faulty(
        database_.connection(store::Access::read),
        std::make_unique<FaultyConnection>(database_.connection(store::Access::write), fails_at));
    Backend backend{.store = faulty,
                    .objects = objects_,
                    .partials = partials_,
                    .now_utc_us = [] { return std::int64_t{1}; },
                    .work_waits = [] {}};
    const bool done = bool(commit_upload(backend, kOne, kTrial));
    EXPECT_EQ(trials(), done ? 1u : 0u) << n;
    ASSERT_TRUE(reconcile_uploads(backend_));
    ASSERT_TRUE(commit_upload(backend_, kOne, kTrial)) << n;
    EXPECT_EQ(trials(), 1u) << n;
    if (done) {
      EXPECT_GT(n, 5) << "begin, four statements and the commit can fail";
      return;
    }
  }
  FAIL() << "never succeeded";
}

}  // namespace
}  // namespace api
}  // namespace tractus
