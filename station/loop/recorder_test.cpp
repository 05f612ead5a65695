#include "station/loop/recorder.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>

#include "core/bytes.hpp"

namespace tractus {
namespace loop {
namespace {
namespace fs = std::filesystem;

/// A folder of its own for each test.
class Folder {
 public:
  Folder() {
    std::string name = fs::temp_directory_path() / "recorder-XXXXXX";
    path_ = ::mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path_); }
  fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

trial::Header header() {
  trial::Header out;
  out.id = core::new_id();
  out.case_id = core::sha256(core::bytes_of("a case"));
  out.station = "test";
  out.operator_name = "nobody";
  out.device = "none";
  return out;
}

trial::Sample sample(std::uint32_t tick) {
  trial::Sample out;
  out.tick = tick;
  out.t_s = 0.00025 * tick;
  return out;
}

TEST(Recorder, PutsEverySampleOfTheRingIntoTheFileInOrder) {
  const Folder folder;
  const fs::path path = folder / "a.ttrial";
  SampleRing ring(4096);
  core::ManualClock clock;
  auto writer = trial::TrialWriter::create(path, header());
  ASSERT_TRUE(writer);
  Recorder recorder(ring, std::move(*writer), clock);
  std::uint32_t tick = 0;
  for (int burst = 0; burst < 5; ++burst) {
    for (int i = 0; i < 3000; ++i) ASSERT_TRUE(ring.push(sample(tick++)));
    recorder.drain();
  }
  EXPECT_TRUE(recorder.stop());
  EXPECT_TRUE(recorder.append({3.75, "end", core::Json::object()}));
  EXPECT_TRUE(recorder.finish());
  const auto read = trial::read_trial(path);
  ASSERT_TRUE(read);
  ASSERT_EQ(read->samples.size(), 15000u);
  for (std::uint32_t i = 0; i < 15000; ++i) ASSERT_EQ(read->samples[i].tick, i);
  EXPECT_TRUE(read->complete);
}

TEST(Recorder, CountsSamplesAsSafeOnlyOnceTheyAreFlushed) {
  const Folder folder;
  SampleRing ring(64);
  core::ManualClock clock;
  auto writer = trial::TrialWriter::create(folder / "a.ttrial", header());
  ASSERT_TRUE(writer);
  Recorder recorder(ring, std::move(*writer), clock);
  for (std::uint32_t i = 0; i < 10; ++i) ring.push(sample(i));
  recorder.drain();
  EXPECT_EQ(recorder.samples_safe(), 0u);
  clock.advance(Recorder::kFlush_ns);
  recorder.drain();
  EXPECT_EQ(recorder.samples_safe(), 10u);
}

TEST(Recorder, WithItsOwnThreadLosesNothingAndTellsAllOfIt) {
  const Folder folder;
  const fs::path path = folder / "a.ttrial";
  SampleRing ring(1024);
  core::MonotonicClock clock;
  auto writer = trial::TrialWriter::create(path, header());
  ASSERT_TRUE(writer);
  Recorder recorder(ring, std::move(*writer), clock);
  std::uint32_t told = 0;
  recorder.tell([&told](std::span<const trial::Sample> samples) {
    for (const auto& sample : samples) EXPECT_EQ(sample.tick, told++);
  });
  recorder.start();
  for (std::uint32_t i = 0; i < 20000;)
    if (ring.push(sample(i))) ++i;
  EXPECT_TRUE(recorder.stop());
  EXPECT_TRUE(recorder.finish());
  const auto read = trial::read_trial(path);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->samples.size(), 20000u);
  EXPECT_EQ(told, 20000u);
}

TEST(Recorder, KeepsTheFirstErrorAndWritesNothingAfterIt) {
  const Folder folder;
  SampleRing ring(64);
  core::ManualClock clock;
  auto writer = trial::TrialWriter::create(folder / "a.ttrial", header());
  ASSERT_TRUE(writer);
  Recorder recorder(ring, std::move(*writer), clock);
  ring.push(sample(7));
  ring.push(sample(6));  // a tick that runs backwards: no trial may hold it
  recorder.drain();
  EXPECT_TRUE(recorder.failed());
  ring.push(sample(8));
  const auto stopped = recorder.stop();
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, core::Errc::bad_input);
  EXPECT_FALSE(recorder.finish());
}

}  // namespace
}  // namespace loop
}  // namespace tractus
