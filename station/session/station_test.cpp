#include "station/session/station.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>

#include "core/file.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace session {
namespace {
namespace fs = std::filesystem;

/// A station's folder and a small signed case: a block of bone of 1000 HU, drilled along +z.
class Sessions : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "station-XXXXXX";
    root_ = ::mkdtemp(name.data());
    volume::Volume volume;
    volume.geometry.dims = {80, 80, 120};
    volume.geometry.spacing_m = volume::Vec3::Constant(3.5e-4);
    volume.geometry.origin_m = volume::Vec3(-0.014, -0.014, 0.0);
    volume.intercept = -1024.0;
    volume.counts.assign(volume.geometry.voxel_count(), 2024);
    for (int k = 0; k < 86; ++k)  // 30 mm deep, 2.5 mm wide
      for (int j = 0; j < 80; ++j)
        for (int i = 0; i < 80; ++i) {
          const volume::Vec3 p = volume.geometry.position_of({double(i), double(j), double(k)});
          if (std::hypot(p.x(), p.y()) < 0.0025) volume.counts[volume.offset(i, j, k)] = 0;
        }
    cases::NewCase made{.definition = {}, .truth = {}, .volume = volume, .meta = {}, .draw = {}};
    made.definition.title = "block";
    made.definition.source = "made by this test";
    made.definition.tract.length_m = 0.03;
    made.definition.tract.radius_m = 0.0025;
    auto opened = cases::write_case(root_ / "case", made, key_);
    ASSERT_TRUE(opened) << opened.error().what;
  }
  void TearDown() override { fs::remove_all(root_); }
  StationFolder folder() {
    auto opened = StationFolder::open(root_ / "st");
    EXPECT_TRUE(opened) << opened.error().what;
    return std::move(*opened);
  }
  std::shared_ptr<const PreparedCase> prepared(StationFolder& folder) {
    EXPECT_TRUE(folder.trust(key_.public_hex));
    auto made = prepare_case(folder, root_ / "case", {});
    EXPECT_TRUE(made) << made.error().what;
    return std::move(*made);
  }
  static TrialSetup fast(double duration_s = 8.0) {
    return {.device = "sim-lambda6", .seed = 1, .duration_s = duration_s, .speed = Speed::fast};
  }
  TrialReport trial_of(StationFolder& where, std::uint64_t seed, double duration_s = 8.0) {
    Station station(where, fast(duration_s));
    EXPECT_TRUE(station.prepare(prepared(where), seed));
    EXPECT_TRUE(station.run());
    auto report = station.answer(station.simulated_answer());
    EXPECT_TRUE(report);
    return *report;
  }

  fs::path root_;
  core::KeyPair key_ = core::KeyPair::generate();
};

TEST_F(Sessions, AFolderThatOthersCouldReadIsMadePrivate) {
  const fs::path root = root_ / "st";
  folder();
  std::ofstream(root / "trials" / "left.ttrial") << "samples";
  fs::permissions(root, fs::perms(0755));
  fs::permissions(root / "trials", fs::perms(0755));
  fs::permissions(root / "trials" / "left.ttrial", fs::perms(0644));
  folder();
  EXPECT_EQ(fs::status(root).permissions(), fs::perms(0700));
  for (const auto& entry : fs::recursive_directory_iterator(root))
    EXPECT_EQ(entry.status().permissions() & fs::perms(077), fs::perms::none) << entry.path();
}

TEST_F(Sessions, GoesFromIdleToDoneAndRefusesWhatDoesNotFit) {
  StationFolder where = folder();
  const auto ready = prepared(where);
  Station station(where, fast());
  EXPECT_FALSE(station.run());
  EXPECT_FALSE(station.answer({}));
  EXPECT_EQ(station.state(), State::idle);
  ASSERT_TRUE(station.prepare(ready, 1));
  EXPECT_EQ(station.state(), State::ready);
  EXPECT_FALSE(station.prepare(ready, 1));
  EXPECT_FALSE(station.answer({}));
  ASSERT_TRUE(station.run());
  EXPECT_EQ(station.state(), State::answering);
  EXPECT_FALSE(station.run());
  EXPECT_FALSE(station.prepare(ready, 1));
  ASSERT_TRUE(station.answer(trial::Answer{}));
  EXPECT_EQ(station.state(), State::done);
  EXPECT_TRUE(station.prepare(ready, 2));
}

TEST_F(Sessions, RecordsEveryTickOfATrialAndSaysThatItIsSimulated) {
  StationFolder where = folder();
  const TrialReport report = trial_of(where, 3);
  const auto read = trial::read_trial(report.file);
  ASSERT_TRUE(read) << read.error().what;
  EXPECT_TRUE(read->complete);
  EXPECT_EQ(read->samples.size(), report.counts.samples);
  EXPECT_NEAR(double(read->samples.size()), 8.0 * 4000.0, 10.0);  // 8 s at 4 kHz
  EXPECT_TRUE(read->header.simulated);
  EXPECT_EQ(read->header.operator_name, "simulated hand, seed 3");
  EXPECT_NE(read->header.extra["clock"].get<std::string>().find("simulated time"),
            std::string::npos);
  EXPECT_TRUE(read->answer().has_value());
  EXPECT_EQ(read->events.front().kind, "start");
  EXPECT_EQ(read->events.back().kind, "end");
}

TEST_F(Sessions, TheBoneStopsTheHandAtTheChannelsEnd) {
  StationFolder where = folder();
  const TrialReport report = trial_of(where, 1, 30.0);  // unhurried: a fast tap goes through
  const auto read = trial::read_trial(report.file);
  ASSERT_TRUE(read);
  double deepest_m = -1.0, hardest_N = 0.0;
  for (const auto& sample : read->samples) {
    // The channel runs along +z from the origin: the tip's z is its depth.
    deepest_m = std::max(deepest_m, (sample.pose() * math::Vec3(0, 0, 0.13)).z());
    hardest_N = std::max(hardest_N, -double(sample.rendered_force_N[2]));
  }
  EXPECT_GT(deepest_m, 0.029);
  EXPECT_LT(deepest_m, 0.0315);  // aimed at 33 mm
  EXPECT_GT(hardest_N, 0.5);     // 350 N/m over the 1.5 mm that are missing
}

TEST_F(Sessions, RepeatsATrialBitForBitUnderTheManualClock) {
  StationFolder where = folder();
  const auto a = trial::read_trial(trial_of(where, 5).file),
             b = trial::read_trial(trial_of(where, 5).file);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->samples.size(), b->samples.size());
  EXPECT_EQ(
      std::memcmp(a->samples.data(), b->samples.data(), a->samples.size() * sizeof(trial::Sample)),
      0);
}

TEST_F(Sessions, RefusesACaseWhoseSignerIsNotTrusted) {
  const StationFolder where = folder();
  const auto made = prepare_case(where, root_ / "case", {});
  ASSERT_FALSE(made);
  EXPECT_EQ(made.error().code, core::Errc::forbidden);
}

TEST_F(Sessions, AFaultEndsTheTrialWithoutAnAnswerAndItIsKept) {
  StationFolder where = folder();
  // A speed guard of 5 cm/s: the approach of 28 mm in about half a second is faster.
  ASSERT_TRUE(
      core::write_json(root_ / "st" / "config.json",
                       {{"format", "tractus-station/1"}, {"limits", {{"max_speed_m_s", 0.05}}}}));
  where = folder();
  Station station(where, fast(4.0));
  ASSERT_TRUE(station.prepare(prepared(where), 1));
  ASSERT_TRUE(station.run());
  EXPECT_EQ(station.state(), State::fault);
  const auto report =
      station.answer(trial::Answer{.breach = true, .wall = "medial", .confidence = 1.0});
  ASSERT_TRUE(report);
  EXPECT_FALSE(report->complete);
  const auto read = trial::read_trial(report->file);
  ASSERT_TRUE(read);
  EXPECT_FALSE(read->answer().has_value());
  EXPECT_EQ(read->events.back().kind, "fault");
  EXPECT_TRUE(where.outbox().holds(report->trial_id));
}

TEST_F(Sessions, AnInterruptedTrialIsSealedAndQueuedAtTheNextStart) {
  StationFolder where = folder();
  const auto ready = prepared(where);
  {
    auto trial = palpation_trial(where, *ready, fast());
    ASSERT_TRUE(trial);
    ASSERT_TRUE(trial->runner->run());
  }  // gone without an end
  const auto recovered = where.recover();
  ASSERT_TRUE(recovered);
  ASSERT_EQ(recovered->trials.size(), 1u);
  EXPECT_GT(recovered->trials[0].samples, 30000u);
  const auto read = trial::read_trial(where.trial_file(recovered->trials[0].trial_id));
  ASSERT_TRUE(read);
  EXPECT_TRUE(read->sealed);
  EXPECT_FALSE(read->complete);
  EXPECT_TRUE(where.outbox().holds(recovered->trials[0].trial_id));
  EXPECT_TRUE(where.recover()->trials.empty());
}

/// A drilling in simulated time under a blind name, ended when `watch` says so.
TrialReport drilled(const StationFolder& where, const PreparedCase& bone, double duration_s,
                    const Watch& watch = {}) {
  TrialSetup setup{.device = "sim-lambda6", .seed = 1, .duration_s = duration_s};
  setup.speed = Speed::fast;
  setup.burr = drilling::Burr{};
  setup.case_known_as = std::string(64, 'b');
  auto trial = palpation_trial(where, bone, setup);
  EXPECT_TRUE(trial && trial->runner->run(watch));
  auto report = trial->runner->finish({});
  EXPECT_TRUE(report) << report.error().what;
  return *report;
}

TEST_F(Sessions, AnAssignedDrillingIsMadeAgainFromItsFileInItsOwnBoneAlone) {
  StationFolder where = folder();
  const auto block = prepared(where);
  const auto case_of = [&](const char* name, volume::Volume volume) {
    cases::NewCase made{.definition = block->opened.definition,
                        .truth = {},
                        .volume = volume,
                        .meta = {},
                        .draw = {}};
    EXPECT_TRUE(cases::write_case(root_ / name, made, key_));
  };
  volume::Volume solid = block->volume;
  std::ranges::fill(solid.counts, std::uint16_t{2024});
  std::fill_n(solid.counts.begin(), 80 * 80 * 10, std::uint16_t{0});  // its face is 3.5 mm deep
  case_of("whole", solid);
  const auto whole = prepare_case(where, root_ / "whole", {});
  ASSERT_TRUE(whole) << whole.error().what;
  const std::string id = drilled(where, **whole, 8.0).trial_id;
  const auto kept = prepare_case(where, root_ / "whole", {}, {}, id);
  ASSERT_TRUE(kept) << kept.error().what;
  EXPECT_NE((*kept)->volume.counts, solid.counts);
  ASSERT_TRUE(fs::remove(where.drilled_file(id)));
  const auto again = prepare_case(where, root_ / "whole", {}, {}, id);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ((*again)->volume.counts, (*kept)->volume.counts);

  case_of("other", (*kept)->volume);
  const auto refused = prepare_case(where, root_ / "other", {}, {}, id);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::bad_input);
}

TEST_F(Sessions, ADrillingThatTookNothingAwayIsFeltAsWholeBone) {
  StationFolder where = folder();
  const auto bone = prepared(where);
  // Ended in the first seconds of ten minutes, on the way to the bone.
  const TrialReport nothing =
      drilled(where, *bone, 600.0, [](const TrialSnapshot&) { return false; });
  ASSERT_EQ(nothing.drilled->detail["changes"], 0);
  const auto felt = prepare_case(where, root_ / "case", {}, {}, nothing.trial_id);
  ASSERT_TRUE(felt) << felt.error().what;
  EXPECT_EQ((*felt)->volume.counts, bone->volume.counts);
}

TEST_F(Sessions, ATrialWithoutASampleIsSetAside) {
  StationFolder where = folder();
  const auto ready = prepared(where);
  { ASSERT_TRUE(palpation_trial(where, *ready, fast())); }
  ASSERT_TRUE(where.recover());
  for (const auto& entry : fs::directory_iterator(where.trials()))
    EXPECT_EQ(entry.path().extension(), ".empty");
}

TEST_F(Sessions, RefusesToStartWithoutRoomOnTheDisk) {
  const StationFolder where = folder();
  EXPECT_TRUE(where.check_room(1));
  EXPECT_FALSE(where.check_room(1ull << 60));
}

TEST_F(Sessions, OneStationAtATimeWorksOnAFolder) {
  const StationFolder where = folder();
  auto first = where.lock();
  ASSERT_TRUE(first);
  EXPECT_FALSE(where.lock());
  { auto moved = std::move(*first); }
  EXPECT_TRUE(where.lock());
}

TEST_F(Sessions, NamesTheFieldThatIsWrongInItsConfiguration) {
  folder();
  ASSERT_TRUE(
      core::write_json(root_ / "st" / "config.json",
                       {{"format", "tractus-station/1"}, {"limits", {{"max_force_N", 500.0}}}}));
  const auto refused = StationFolder::open(root_ / "st");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("config.json: /limits/max_force_N"), std::string::npos)
      << refused.error().what;
}

}  // namespace
}  // namespace session
}  // namespace tractus
