#include "trial/trial_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <checkout.hpp>
#include <cmath>
#include <csignal>
#include <cstring>
#include <fstream>
#include <limits>
#include <random>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "trial/frames.hpp"

namespace tractus {
namespace trial {
namespace {
namespace fs = std::filesystem;
using testing::HasSubstr;

Header header() {
  Header h;
  h.id = std::string(32, 'a');
  h.case_id = std::string(64, 'b');
  h.station = "bench 1";
  h.operator_name = "simulated hand, seed 7";
  h.simulated = true;
  h.device = "sim-lambda6";
  h.started_utc_us = 1'700'000'000'000'000;
  h.probe = {{"length_m", 0.13}};
  return h;
}

/// Sample number i: every field tells i, so that a wrong one cannot pass for it.
Sample sample(std::uint32_t i) {
  Sample s;
  const double x = i;
  s.t_s = x / 4000.0;
  s.p_VH_m = {x, -x, 0.5 * x};
  s.q_VH = {std::cos(x), std::sin(x), 0.0, 0.0};
  s.force_N = {float(i), float(i) + 0.25f, -float(i)};
  s.torque_Nm = {float(i) * 0.125f, 1.0f, 2.0f};
  s.rendered_force_N = {float(i) + 3.0f, 0.0f, 1.0f};
  s.deflection_m = {float(i) * 1e-6f, 0.0f};
  s.tick = i;
  s.iterations = std::uint16_t(i % 7);
  s.flags = std::uint16_t(i % 32);
  return s;
}

std::vector<Sample> samples(std::uint32_t from, std::uint32_t count) {
  std::vector<Sample> out;
  for (std::uint32_t i = from; i < from + count; ++i) out.push_back(sample(i));
  return out;
}

bool same(const Sample& a, const Sample& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

class TrialFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  /// `frames` frames of `per_frame` samples, a "start" event first and, when sealed, an "end" event
  /// last.
  void write(std::uint32_t frames, std::uint32_t per_frame, bool sealed) {
    auto writer = TrialWriter::create(path_, header());
    ASSERT_TRUE(writer) << writer.error().what;
    ASSERT_TRUE(writer->append(Event{0.0, "start"}));
    for (std::uint32_t f = 0; f < frames; ++f)
      ASSERT_TRUE(writer->append(samples(f * per_frame, per_frame)));
    if (!sealed) return;
    ASSERT_TRUE(writer->append(Event{1e3, "end"}));
    ASSERT_TRUE(writer->finish());
  }
  core::Bytes bytes() const { return core::read_file(path_).value(); }
  void put(core::ByteView content) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(content.data()), std::streamsize(content.size()));
  }
  /// Ends of the frames of the file, by its own lengths.
  std::vector<std::size_t> edges() const {
    const auto all = bytes();
    std::vector<std::size_t> out{kMagic.size()};
    while (out.back() < all.size()) {
      std::uint32_t length = 0;
      std::memcpy(&length, &all[out.back() + 4], 4);
      out.push_back(out.back() + kFrameHeader_bytes + length);
    }
    return out;
  }
  /// A file of the magic, a header frame, and `payload` as one more frame with true checksums.
  void put_frame(FrameType type, core::ByteView payload) const {
    core::Bytes all(core::bytes_of(kMagic).begin(), core::bytes_of(kMagic).end());
    for (const auto& part : {frame_bytes(FrameType::header, 0, json_payload(header().to_json())),
                             frame_bytes(type, 1, payload)})
      all.insert(all.end(), part.begin(), part.end());
    put(all);
  }
  void put_samples(std::vector<Sample> content) const {
    core::Bytes payload(4 + content.size() * sizeof(Sample));
    const auto count = std::uint32_t(content.size());
    std::memcpy(payload.data(), &count, 4);
    std::memcpy(payload.data() + 4, content.data(), content.size() * sizeof(Sample));
    put_frame(FrameType::samples, payload);
  }
  std::string refusal() const {
    const auto trial = read_trial(path_);
    if (trial) return "no error";
    EXPECT_EQ(trial.error().what.find('\n'), std::string::npos);
    return trial.error().what;
  }

  /// In memory where the system offers it: these tests flush thousands of times.
  static fs::path scratch() {
    return fs::exists("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
  }
  const fs::path folder_ = scratch() / ("tractus_trial_" + core::new_id());
  const fs::path path_ = folder_ / "a.trial";
};

TEST_F(TrialFile, GivesBackWhatWasWritten) {
  write(5, 80, true);
  const auto trial = read_trial(path_);
  ASSERT_TRUE(trial) << trial.error().what;
  EXPECT_EQ(trial->header.to_json(), header().to_json());
  ASSERT_EQ(trial->samples.size(), 400u);
  for (std::uint32_t i = 0; i < 400; ++i) EXPECT_TRUE(same(trial->samples[i], sample(i))) << i;
  ASSERT_EQ(trial->events.size(), 2u);
  EXPECT_EQ(trial->events[1].kind, "end");
  EXPECT_TRUE(trial->complete);
  EXPECT_TRUE(trial->sealed);
}

TEST_F(TrialFile, ScanHandsOutTheSameSamplesFrameByFrame) {
  write(3, 7, true);
  std::vector<Sample> seen;
  std::vector<std::size_t> sizes;
  const auto trial = scan_trial(path_, [&](const Block& block) {
    sizes.push_back(block.size());
    seen.insert(seen.end(), block.palpation.begin(), block.palpation.end());
  });
  ASSERT_TRUE(trial);
  EXPECT_TRUE(trial->samples.empty());
  EXPECT_THAT(sizes, testing::ElementsAre(7, 7, 7));
  for (std::uint32_t i = 0; i < 21; ++i) EXPECT_TRUE(same(seen[i], sample(i)));
}

TEST_F(TrialFile, AnAppendLargerThanAFrameIsSplit) {
  const auto many = std::uint32_t(max_frame_samples(sizeof(Sample))) + 5;
  write(1, many, true);
  const auto trial = read_trial(path_);
  ASSERT_TRUE(trial) << trial.error().what;
  ASSERT_EQ(trial->samples.size(), many);
  EXPECT_TRUE(same(trial->samples.back(), sample(many - 1)));
}

TEST_F(TrialFile, DoesNotOverwrite) {
  write(1, 1, true);
  const auto before = bytes();
  const auto again = TrialWriter::create(path_, header());
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, core::Errc::conflict);
  EXPECT_EQ(bytes(), before);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()), 1);
}

TEST_F(TrialFile, TheWriterRefusesWhatTheReaderWould) {
  auto bad = header();
  bad.id = "../../etc/passwd";
  EXPECT_FALSE(TrialWriter::create(path_, bad));
  EXPECT_FALSE(fs::exists(path_));
  auto writer = TrialWriter::create(path_, header());
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->append(samples(10, 2)));
  EXPECT_FALSE(writer->append(samples(5, 1)));                        // time and tick run backwards
  EXPECT_FALSE(writer->append(std::vector{sample(12), sample(12)}));  // the same tick twice
  EXPECT_FALSE(writer->append(Event{std::nan(""), "start"}));
  EXPECT_FALSE(writer->append(Event{0.0, ""}));
  ASSERT_TRUE(writer->append(samples(12, 1)));
  ASSERT_TRUE(writer->finish());
  const auto trial = read_trial(path_);
  ASSERT_TRUE(trial) << trial.error().what;
  EXPECT_EQ(trial->samples.size(), 3u);
}

TEST_F(TrialFile, CutAnywhereGivesExactlyTheSamplesOfTheWholeFrames) {
  constexpr std::uint32_t kFrames = 12, kPerFrame = 9;
  write(kFrames, kPerFrame, true);
  const auto all = bytes();
  const auto ends = edges();
  const std::size_t header_end = ends[1];
  std::vector<std::size_t> cuts;
  for (std::size_t at = ends[ends.size() - 5]; at < all.size(); ++at) cuts.push_back(at);
  std::mt19937 random(1);
  for (int i = 0; i < 500; ++i)
    cuts.push_back(std::uniform_int_distribution<std::size_t>(0, all.size() - 1)(random));
  for (const std::size_t cut : cuts) {
    put(core::ByteView(all).first(cut));
    const auto trial = read_trial(path_);
    if (cut < header_end) {
      ASSERT_FALSE(trial) << "cut at " << cut;
      continue;
    }
    ASSERT_TRUE(trial) << "cut at " << cut << ": " << trial.error().what;
    // frames after the header and the "start" event hold samples
    std::size_t whole = 0;
    for (std::size_t f = 0; f < kFrames; ++f) whole += ends[3 + f] <= cut;
    ASSERT_EQ(trial->samples.size(), whole * kPerFrame) << "cut at " << cut;
    for (std::uint32_t i = 0; i < trial->samples.size(); ++i)
      ASSERT_TRUE(same(trial->samples[i], sample(i))) << "cut at " << cut;
    ASSERT_FALSE(trial->sealed);
    ASSERT_FALSE(trial->complete);
  }
}

TEST_F(TrialFile, AnyFlippedBitIsDetected) {
  write(4, 3, true);
  auto all = bytes();
  for (std::size_t at = 0; at < all.size(); ++at) {
    const auto good = all[at];
    all[at] ^= std::byte(1u << (at % 8));
    put(all);
    ASSERT_FALSE(read_trial(path_)) << "byte " << at;
    all[at] = good;
  }
}

TEST_F(TrialFile, AFrameThatIsMissingOrTwiceThereIsNoticed) {
  write(4, 3, false);
  const auto all = bytes();
  const auto ends = edges();
  const auto at = [&](std::size_t edge) { return all.begin() + std::ptrdiff_t(ends[edge]); };
  core::Bytes without(all.begin(), at(3));
  without.insert(without.end(), at(4), all.end());
  put(without);
  EXPECT_THAT(refusal(), HasSubstr("frame 4 where frame 3 is expected"));
  core::Bytes twice(all.begin(), at(4));
  twice.insert(twice.end(), at(3), all.end());
  put(twice);
  EXPECT_THAT(refusal(), HasSubstr("frame 3 where frame 4 is expected"));
}

TEST_F(TrialFile, AFlippedBitOfAnUnfinishedFileNeverGivesAWrongSample) {
  write(4, 3, false);
  auto all = bytes();
  for (std::size_t at = 0; at < all.size(); ++at) {
    all[at] ^= std::byte{0x10};
    put(all);
    ASSERT_FALSE(read_trial(path_)) << "byte " << at;
    all[at] ^= std::byte{0x10};
  }
}

TEST_F(TrialFile, RecoveryEndsACutFileAnywhere) {
  write(6, 5, false);
  const auto all = bytes();
  const auto ends = edges();
  for (std::size_t cut = ends[1]; cut <= all.size(); cut += 17) {
    put(core::ByteView(all).first(cut));
    const auto kept = recover_trial(path_);
    ASSERT_TRUE(kept) << "cut at " << cut << ": " << kept.error().what;
    std::size_t whole = 0;
    for (std::size_t f = 3; f < ends.size(); ++f) whole += ends[f] <= cut;
    ASSERT_EQ(*kept, whole * 5);
    const auto trial = read_trial(path_);
    ASSERT_TRUE(trial) << trial.error().what;
    ASSERT_EQ(trial->samples.size(), whole * 5);
    ASSERT_TRUE(trial->sealed);
    ASSERT_FALSE(trial->complete);
    ASSERT_EQ(trial->events.back().kind, "interrupted");
    const auto once = bytes();
    ASSERT_TRUE(recover_trial(path_));
    ASSERT_EQ(bytes(), once);
  }
}

TEST_F(TrialFile, RecoveryInterruptedItselfIsRepeated) {
  write(3, 5, false);
  const auto open = bytes().size();
  ASSERT_TRUE(recover_trial(path_));
  const auto done = bytes();
  for (std::size_t cut = open; cut < done.size(); ++cut) {
    put(core::ByteView(done).first(cut));
    ASSERT_TRUE(recover_trial(path_));
    ASSERT_EQ(bytes(), done) << "cut at " << cut;
  }
}

TEST_F(TrialFile, RecoveryCutsZerosAndADamagedLastFrameThatAPowerCutLeaves) {
  write(3, 5, false);
  auto all = bytes();
  all.resize(all.size() + 100'000);
  put(all);
  ASSERT_TRUE(read_trial(path_));
  EXPECT_EQ(recover_trial(path_).value(), 15u);
  all.resize(all.size() - 100'000);
  std::fill(all.end() - 50, all.end(), std::byte{});
  put(all);
  EXPECT_FALSE(read_trial(path_));
  EXPECT_EQ(recover_trial(path_).value(), 10u);
}

TEST_F(TrialFile, RecoveryLeavesDamageInTheMiddleAlone) {
  write(3, 5, true);
  auto all = bytes();
  all[edges()[3] - 1] ^= std::byte{1};
  put(all);
  EXPECT_FALSE(recover_trial(path_));
  EXPECT_EQ(bytes(), all);
}

TEST_F(TrialFile, AWriteThatTheDiskRefusesLeavesWholeFramesAndMayBeTriedAgain) {
  auto writer = TrialWriter::create(path_, header());
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->append(samples(0, 10)));
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit full = before;
  full.rlim_cur = fs::file_size(path_) + 200;  // room for a part of the next frame
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
  const auto refused = writer->append(samples(10, 10));
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, core::Errc::io);
  EXPECT_EQ(read_trial(path_)->samples.size(), 10u);
  EXPECT_EQ(writer->samples_written(), 10u);
  ASSERT_TRUE(writer->append(samples(10, 1)));
  ASSERT_TRUE(writer->finish());
  const auto trial = read_trial(path_);
  ASSERT_TRUE(trial) << trial.error().what;
  EXPECT_EQ(trial->samples.size(), 11u);
}

TEST_F(TrialFile, RecoveryOfALivingWritersFileIsAConflict) {
  auto writer = TrialWriter::create(path_, header());
  ASSERT_TRUE(writer);
  const auto recovered = recover_trial(path_);
  ASSERT_FALSE(recovered);
  EXPECT_EQ(recovered.error().code, core::Errc::conflict);
  ASSERT_TRUE(writer->append(samples(0, 1)));
  ASSERT_TRUE(writer->finish());
  EXPECT_TRUE(read_trial(path_));
}

TEST_F(TrialFile, HostileFilesAreRefusedInOneLineWithTheirOffset) {
  put({});
  EXPECT_THAT(refusal(), HasSubstr("offset 0: not a trial file"));
  put(core::bytes_of("tractus-trial/3\n"));
  EXPECT_THAT(refusal(), HasSubstr("offset 0: not a trial file"));
  put(core::bytes_of(kMagic));
  EXPECT_THAT(refusal(), HasSubstr("offset 16: the file holds no whole header"));

  core::Bytes lie(4);
  const std::uint32_t billion = 1'000'000'000;
  std::memcpy(lie.data(), &billion, 4);
  put_frame(FrameType::samples, lie);
  EXPECT_THAT(refusal(), HasSubstr("1000000000 samples said, 4 bytes given"));

  fs::remove(path_);
  write(1, 1, true);
  auto longer = bytes();
  longer.resize(longer.size() + 3, std::byte{'x'});
  put(longer);
  EXPECT_THAT(refusal(), HasSubstr("3 bytes after the end frame"));

  put_frame(FrameType::header, json_payload(header().to_json()));
  EXPECT_THAT(refusal(), HasSubstr("a second header"));
  put_frame(FrameType(0x41414141), {});
  EXPECT_THAT(refusal(), HasSubstr("unknown type 0x41414141"));
  put_frame(FrameType::event, core::bytes_of(std::string(200'000, '[')));
  EXPECT_THAT(refusal(), HasSubstr("nested deeper than 32 levels"));
  put_frame(FrameType::event, core::bytes_of(std::string(300'000, ' ')));
  EXPECT_THAT(refusal(), HasSubstr("event of 300000 bytes"));
  put_frame(FrameType::event,
            core::bytes_of("{\"t_s\":0,\"kind\":\"start\",\"detail\":{},\"a\\nb\":1}"));
  EXPECT_THAT(refusal(), HasSubstr("this field is not known"));
  put_frame(FrameType::event, core::bytes_of("{\"t_s\":1e999,\"kind\":\"start\"}"));
  EXPECT_THAT(refusal(), HasSubstr("event: not valid JSON"));
  put_frame(FrameType::event, core::bytes_of("\xff\xfe"));
  EXPECT_THAT(refusal(), HasSubstr("event: not valid JSON"));
  put_frame(FrameType::end, lie);
  EXPECT_THAT(refusal(), HasSubstr("end frame of 4 bytes, expected 40"));
  put_frame(FrameType::end, end_payload(7, std::string(64, '0')));
  EXPECT_THAT(refusal(), HasSubstr("counts 7 samples, the file holds 0"));
  put_frame(FrameType::end, end_payload(0, std::string(64, '0')));
  EXPECT_THAT(refusal(), HasSubstr("SHA-256 of the file does not hold"));
}

TEST_F(TrialFile, SamplesThatCannotBeAreRefused) {
  const double nan = std::nan("");
  auto bad = samples(0, 3);
  bad[1].p_VH_m[2] = nan;
  put_samples(bad);
  EXPECT_THAT(refusal(), HasSubstr("sample 1: tick 1 holds a number that is not finite"));
  bad = samples(0, 3);
  bad[2].force_N[0] = std::numeric_limits<float>::infinity();
  put_samples(bad);
  EXPECT_THAT(refusal(), HasSubstr("sample 2: tick 2 holds a number that is not finite"));
  bad = samples(0, 3);
  bad[0].rendered_force_N[1] = 1e30f;
  put_samples(bad);
  EXPECT_THAT(refusal(), HasSubstr("sample 0: tick 0 holds a number"));
  bad = samples(0, 3);
  bad[2].t_s = 0.0;
  put_samples(bad);
  EXPECT_THAT(refusal(), HasSubstr("sample 2: time runs backwards"));
  bad = samples(0, 3);
  bad[0].t_s = nan;
  put_samples(bad);
  EXPECT_THAT(refusal(), HasSubstr("sample 0: time nan s"));
  bad = samples(0, 3);
  bad[2].tick = 1;
  put_samples(bad);
  EXPECT_THAT(refusal(), HasSubstr("sample 2: tick 1 after tick 1"));
  bad = samples(0, 3);
  bad[1].q_VH = {0, 0, 0, 0};
  put_samples(bad);
  EXPECT_THAT(refusal(), HasSubstr("quaternion of length 0"));
}

TEST_F(TrialFile, LimitsHold) {
  write(4, 10, true);
  EXPECT_EQ(read_trial(path_, {.max_samples = 39}).error().code, core::Errc::too_large);
  EXPECT_EQ(read_trial(path_, {.max_bytes = 100}).error().code, core::Errc::too_large);
  EXPECT_EQ(read_trial(folder_).error().code, core::Errc::bad_input);
  EXPECT_EQ(read_trial(folder_ / "none").error().code, core::Errc::not_found);
}

struct Released {
  const char *name, *whole, *torn;
  friend void PrintTo(const Released& file, std::ostream* out) { *out << file.name; }
};
class ReleasedTrialFile : public TrialFile, public testing::WithParamInterface<Released> {};
INSTANTIATE_TEST_SUITE_P(Formats, ReleasedTrialFile,
                         testing::Values(Released{"One", "trial-format-1/small.trial",
                                                  "trial-format-1/torn.trial"},
                                         Released{"Two", "trial-format-2/palpation.trial",
                                                  "trial-format-2/palpation-torn.trial"}),
                         [](const auto& format) { return format.param.name; });

// Written by make.py of tests/golden/trial-format-1 and -2, which share no code with the reader.
TEST_P(ReleasedTrialFile, IsReadForEver) {
  const fs::path golden = fs::path(checkout::kSource) / "tests/golden";
  const auto expected = core::read_json(golden / "trial-format-1/expected.json").value();
  const auto trial = read_trial(golden / GetParam().whole);
  ASSERT_TRUE(trial) << trial.error().what;
  auto header = trial->header.to_json();
  header["format"] = "tractus-trial/1";  // written anew it would be a later one
  EXPECT_EQ(header, expected["header"]);
  ASSERT_EQ(trial->events.size(), expected["events"].size());
  for (std::size_t i = 0; i < trial->events.size(); ++i)
    EXPECT_EQ(trial->events[i].to_json(), expected["events"][i]);
  ASSERT_EQ(trial->samples.size(), 12u);
  for (std::size_t i = 0; i < 12; ++i) {
    const Sample& s = trial->samples[i];
    const core::Json found{{"t_s", s.t_s},
                           {"p_VH_m", s.p_VH_m},
                           {"q_VH", s.q_VH},
                           {"force_N", s.force_N},
                           {"torque_Nm", s.torque_Nm},
                           {"rendered_force_N", s.rendered_force_N},
                           {"rendered_torque_Nm", s.rendered_torque_Nm},
                           {"deflection_m", s.deflection_m},
                           {"tick", s.tick},
                           {"iterations", s.iterations},
                           {"flags", s.flags}};
    EXPECT_EQ(found, expected["samples"][i]) << i;
  }
  EXPECT_TRUE(trial->complete);
  EXPECT_TRUE(trial->sealed);
  EXPECT_EQ(trial->answer()->wall, "medial");
  EXPECT_EQ(trial->answer()->confidence, 0.8);
  const auto ticks = count_ticks(trial->block());
  EXPECT_EQ(ticks.late, 1u);
  EXPECT_EQ(ticks.skipped, 1u);

  const auto torn = read_trial(golden / GetParam().torn);
  ASSERT_TRUE(torn) << torn.error().what;
  EXPECT_EQ(torn->samples.size(), 5u);
  EXPECT_EQ(torn->events.size(), 1u);
  EXPECT_FALSE(torn->sealed);
  fs::copy_file(golden / GetParam().torn, path_);
  EXPECT_EQ(recover_trial(path_).value(), 5u);
  EXPECT_EQ(read_trial(path_)->events.back().kind, "interrupted");
}

}  // namespace
}  // namespace trial
}  // namespace tractus
