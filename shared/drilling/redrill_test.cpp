#include "drilling/redrill.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include "core/file.hpp"
#include "drilling/drilling_test_support.hpp"

namespace tractus {
namespace drilling {
namespace {
namespace fs = std::filesystem;
using math::Vec3;

class Redrilling : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "redrill-XXXXXX";
    folder_ = ::mkdtemp(name.data());
    header_.id = core::new_id();
    header_.case_id = std::string(64, 'a');
    header_.device = "sim-lambda6";
    header_.probe = {{"length_m", kLength_m}, {"pose_offset_m", {0.0, 0.0, 0.0}}};
    header_.extra["drilling"] = drilling::Setup{burr_}.to_json();
  }
  void TearDown() override { fs::remove_all(folder_); }

  /// A trial of `samples`, with the word of `said` when it has one.
  fs::path trial_of(const std::vector<trial::Sample>& samples, const core::Json& said) {
    const fs::path path = folder_ / "a.ttrial";
    auto writer = trial::TrialWriter::create(path, header_);
    EXPECT_TRUE(writer) << (writer ? "" : writer.error().what);
    EXPECT_TRUE(writer->append(samples));
    if (said.is_object()) {
      EXPECT_TRUE(writer->append({samples.back().t_s, "drilled", said}));
      EXPECT_TRUE(writer->finish());
    }
    return path;
  }

  const Burr burr_;
  const volume::Volume bone_ = block(41, 0.00035);
  const std::vector<trial::Sample> samples_ =
      stroke(0, Vec3(0, 0, -0.008), Vec3(0.001, 0, 0.002), 4000, 0.8f);
  trial::Header header_;
  fs::path folder_;
};

TEST_F(Redrilling, OfARecordedTrialComesToTheSameVoxels) {
  const auto live = eroded(bone_, burr_, samples_);
  ASSERT_TRUE(live);
  const auto again = redrill(trial_of(samples_, drilled_of(*live).to_json()), bone_);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->erosion.volume().counts, live->volume().counts);
  EXPECT_NE(again->erosion.volume().counts, bone_.counts);
  EXPECT_EQ(again->agrees(), true);
}

TEST_F(Redrilling, OnAnotherBoneDoesNotAgree) {
  const auto live = eroded(bone_, burr_, samples_);
  volume::Volume other = bone_;
  for (auto& count : other.counts) count = std::uint16_t(count + 1);
  const auto again = redrill(trial_of(samples_, drilled_of(*live).to_json()), other);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->agrees(), false);
}

TEST_F(Redrilling, OfATrialThatWasCutShortGoesUpToItsLastSample) {
  const std::vector<trial::Sample> kept(samples_.begin(), samples_.begin() + 2507);
  const auto again = redrill(trial_of(kept, {}), bone_);
  ASSERT_TRUE(again) << again.error().what;
  EXPECT_EQ(again->erosion.volume().counts, eroded(bone_, burr_, kept)->volume().counts);
  EXPECT_EQ(again->agrees(), std::nullopt);
}

TEST_F(Redrilling, RefusesATrialOfPalpationAndALawItDoesNotKnow) {
  header_.extra["drilling"]["law"] = "tractus-drilling/2";
  const auto unknown = redrill(trial_of(samples_, {}), bone_);
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().what.find("law"), std::string::npos) << unknown.error().what;
  fs::remove(folder_ / "a.ttrial");
  header_.extra.erase("drilling");
  const auto palpation = redrill(trial_of(samples_, {}), bone_);
  ASSERT_FALSE(palpation);
  EXPECT_EQ(palpation.error().code, core::Errc::bad_input);
}

TEST_F(Redrilling, WhatWasDrilledIsKeptInAFileAndComesBack) {
  const auto live = eroded(bone_, burr_, samples_);
  const Drilled drilled = drilled_of(*live);
  const fs::path path = folder_ / "a.tdrill";
  ASSERT_TRUE(write_drilled(path, drilled, header_.id, header_.case_id));
  const auto read = read_drilled(path, header_.id, header_.case_id, bone_.geometry.dims);
  ASSERT_TRUE(read) << read.error().what;
  volume::Volume again = bone_;
  read->put_into(again);
  EXPECT_EQ(again.counts, live->volume().counts);
  EXPECT_EQ(read->removed_m3, live->removed_m3());
  EXPECT_LT(fs::file_size(path), drilled.counts.size() * 2);

  EXPECT_FALSE(read_drilled(path, header_.id, std::string(64, 'b'), bone_.geometry.dims));
  EXPECT_FALSE(read_drilled(path, header_.id, header_.case_id, {41, 41, 40}));
}

// Every length to which the file may be cut, and every byte changed: never taken, never a crash.
TEST_F(Redrilling, ADamagedFileIsRefused) {
  const auto live = eroded(bone_, burr_, samples_);
  const fs::path path = folder_ / "a.tdrill";
  ASSERT_TRUE(write_drilled(path, drilled_of(*live), header_.id, header_.case_id));
  const auto whole = core::read_file(path);
  ASSERT_TRUE(whole);
  const auto taken = [&](const core::Bytes& bytes) {
    EXPECT_TRUE(core::write_file(path, bytes));
    const auto read = read_drilled(path, header_.id, header_.case_id, bone_.geometry.dims);
    return read && read->sha256() != drilled_of(*live).sha256();
  };
  for (std::size_t at = 0; at < whole->size(); at += 1 + at / 16) {
    EXPECT_FALSE(taken(core::Bytes(whole->begin(), whole->begin() + std::ptrdiff_t(at)))) << at;
    core::Bytes changed = *whole;
    changed[at] ^= std::byte{0x15};
    EXPECT_FALSE(taken(changed)) << at;
  }
}

}  // namespace
}  // namespace drilling
}  // namespace tractus
