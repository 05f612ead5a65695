#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "trial/frames.hpp"
#include "trial/signals.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace trial {
namespace {
namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;

Header probing_header() {
  Header h;
  h.id = std::string(32, 'a');
  h.case_id = std::string(64, 'b');
  h.rig = Rig::probing;
  h.rate_Hz = 1000.0;
  return h;
}

/// Sample number i: every field tells i, so that a wrong one cannot pass for it.
ProbingSample probing_sample(std::uint32_t i) {
  ProbingSample s;
  const auto f = float(i);
  s.t_s = double(i) / 1000.0;
  s.x_m = 1e-5 * double(i);
  s.theta_rad = 8e-4 * double(i);
  s.speed_m_s = f + 0.25f, s.turning_rad_s = -f, s.fz_N = 2.0f * f, s.tz_Nm = 0.5f * f;
  s.command_m_s = f + 3.0f, s.command_Nm = f + 4.0f, s.law_m_s = f + 5.0f;
  s.round_trip_s = 1e-6f * f;
  s.tick = i;
  s.flags = std::uint16_t(i % 128);
  s.mode = ProbingMode(i % kProbingModes);
  s.fault = std::uint8_t(i % 6);
  return s;
}

std::vector<ProbingSample> probing_samples(std::uint32_t from, std::uint32_t count) {
  std::vector<ProbingSample> out;
  for (std::uint32_t i = from; i < from + count; ++i) out.push_back(probing_sample(i));
  return out;
}

bool same(const std::vector<ProbingSample>& a, const std::vector<ProbingSample>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

class ProbingFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::temp_directory_path() / ("tractus_probing_" + core::new_id());
  const fs::path path_ = folder_ / "a.trial";
  const fs::path golden_ = fs::path(checkout::kSource) / "tests/golden/trial-format-1-probing";
};

TEST_F(ProbingFile, GivesBackWhatWasWrittenInFramesOfItsOwnSize) {
  const std::uint32_t many = std::uint32_t(max_frame_samples(sizeof(ProbingSample))) + 7;
  {
    auto writer = TrialWriter::create(path_, probing_header());
    ASSERT_TRUE(writer) << writer.error().what;
    ASSERT_TRUE(writer->append(Event{0.0, "start"}));
    ASSERT_TRUE(writer->append(probing_samples(0, many)));
    ASSERT_TRUE(writer->append(Event{1e3, "end"}));
    ASSERT_TRUE(writer->finish());
  }
  const auto trial = read_trial(path_);
  ASSERT_TRUE(trial) << trial.error().what;
  EXPECT_EQ(trial->header.to_json(), probing_header().to_json());
  EXPECT_TRUE(same(trial->probing, probing_samples(0, many)));
  EXPECT_TRUE(trial->samples.empty());
  EXPECT_TRUE(trial->complete);
}

TEST_F(ProbingFile, TakesSamplesOfItsOwnRigAlone) {
  auto writer = TrialWriter::create(path_, probing_header());
  ASSERT_TRUE(writer);
  const auto refused = writer->append(std::vector{Sample{}});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("samples of palpation in a trial of probing"));
  EXPECT_EQ(writer->samples_written(), 0u);
}

TEST_F(ProbingFile, RefusesWhatNoSampleMayBe) {
  auto writer = TrialWriter::create(path_, probing_header());
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->append(probing_samples(0, 3)));
  auto bad = probing_sample(3);
  bad.fz_N = std::numeric_limits<float>::quiet_NaN();
  EXPECT_FALSE(writer->append(std::vector{bad}));
  bad = probing_sample(3);
  bad.mode = ProbingMode(9);
  EXPECT_THAT(writer->append(std::vector{bad}).error().what, HasSubstr("mode 9"));
  bad = probing_sample(2);  // the tick stands still
  EXPECT_FALSE(writer->append(std::vector{bad}));
  bad = probing_sample(3);
  bad.t_s = 0.0;
  EXPECT_FALSE(writer->append(std::vector{bad}));
  EXPECT_EQ(writer->samples_written(), 3u);
}

TEST_F(ProbingFile, AnUnknownRigIsRefusedByName) {
  auto json = probing_header().to_json();
  json["rig"] = "cutting";
  const auto refused = Header::from_json(json, "header");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, HasSubstr("/rig"));
}

class ReleasedProbingFile : public ProbingFile, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Formats, ReleasedProbingFile,
                         testing::Values("trial-format-1-probing/small.trial",
                                         "trial-format-2/probing.trial"),
                         [](const auto& format) { return format.index == 0 ? "One" : "Two"; });

// Written by make.py of tests/golden/trial-format-1-probing and -2, which share no code with the
// reader.
TEST_P(ReleasedProbingFile, IsReadForEver) {
  const auto expected = core::read_json(golden_ / "expected.json").value();
  const auto trial = read_trial(golden_.parent_path() / GetParam());
  ASSERT_TRUE(trial) << trial.error().what;
  auto header = trial->header.to_json();
  header["format"] = "tractus-trial/1";  // written anew it would be a later one
  EXPECT_EQ(header, expected["header"]);
  ASSERT_EQ(trial->probing.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    const ProbingSample& s = trial->probing[i];
    const core::Json found{{"t_s", s.t_s},
                           {"x_m", s.x_m},
                           {"theta_rad", s.theta_rad},
                           {"speed_m_s", s.speed_m_s},
                           {"turning_rad_s", s.turning_rad_s},
                           {"fz_N", s.fz_N},
                           {"tz_Nm", s.tz_Nm},
                           {"command_m_s", s.command_m_s},
                           {"command_Nm", s.command_Nm},
                           {"law_m_s", s.law_m_s},
                           {"round_trip_s", s.round_trip_s},
                           {"tick", s.tick},
                           {"flags", s.flags},
                           {"mode", int(s.mode)},
                           {"fault", s.fault}};
    EXPECT_EQ(found, expected["samples"][i]) << i;
  }
  EXPECT_EQ(trial->answer()->wall, "lateral");
  const auto ticks = count_ticks(trial->block());
  EXPECT_EQ(ticks.samples, 12u);
  EXPECT_EQ(ticks.late, 1u);
  EXPECT_EQ(ticks.missed, 1u);
  EXPECT_EQ(ticks.bus_lost, 1u);
  EXPECT_EQ(ticks.stale, 1u);
  EXPECT_EQ(ticks.skipped, 2u);
}

TEST_F(ProbingFile, ACutOneIsReadToItsLastWholeFrameAndCanBeEnded) {
  fs::copy_file(golden_ / "torn.trial", path_);
  const auto torn = read_trial(path_);
  ASSERT_TRUE(torn) << torn.error().what;
  EXPECT_EQ(torn->probing.size(), 5u);
  EXPECT_FALSE(torn->sealed);
  EXPECT_EQ(recover_trial(path_).value(), 5u);
  const auto ended = read_trial(path_);
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->events.back().kind, "interrupted");
  EXPECT_DOUBLE_EQ(ended->events.back().t_s, 0.004 + 1e-7);  // of the last whole sample
}

TEST(ProbingSignals, ShowTheSamplesChannelsOverTime) {
  Signals signals(probing_header(), {});
  signals.add({{}, probing_samples(0, 3)});
  EXPECT_THAT(signals.channels(), ElementsAre("force_N", "depth_m", "speed_m_s", "angle_rad",
                                              "torque_Nm", "mode", "round_trip_s"));
  const auto view = signals.view(signals.channels(), 0, 1, 10);
  ASSERT_TRUE(view) << view.error().what;
  const float expected[] = {4.0f, 2e-5f, 2.25f, 1.6e-3f, 1.0f, 2.0f, 2e-6f};  // of sample 2
  for (std::size_t c = 0; c < 7; ++c)
    EXPECT_FLOAT_EQ(view->channels[c].second.max[2], expected[c]) << view->channels[c].first;
  const std::vector<std::string> of_palpation{"force_xy_N"};
  EXPECT_THAT(signals.view(of_palpation, 0, 1, 10).error().what, HasSubstr("force_xy_N"));
  EXPECT_TRUE(signals.path(10).t_s.empty());
}

TEST(ProbingSignals, ForceAgainstDepthKeepsThePeaksOfEveryStretch) {
  // Ten samples, one stretch of five each: 90 N at 3, -7 N at 1; 50 N at 5, -1 N at 9.
  auto block = probing_samples(0, 10);
  for (auto& s : block) s.fz_N = 1.0f, s.mode = ProbingMode::bone;
  block[3].fz_N = 90.0f, block[3].mode = ProbingMode::breach;
  block[1].fz_N = -7.0f, block[5].fz_N = 50.0f, block[9].fz_N = -1.0f;
  Signals signals(probing_header(), {});
  signals.add({{}, block});
  const auto curve = signals.force_against_depth(5);  // two pairs
  EXPECT_THAT(curve.force_N, ElementsAre(-7, 90, 50, -1));
  EXPECT_THAT(curve.depth_m, ElementsAre(1e-5f, 3e-5f, 5e-5f, 9e-5f));
  EXPECT_THAT(curve.mode, ElementsAre(ProbingMode::bone, ProbingMode::breach, ProbingMode::bone,
                                      ProbingMode::bone));
  EXPECT_EQ(signals.force_against_depth(100).t_s.size(), 10u);
}

}  // namespace
}  // namespace trial
}  // namespace tractus
