/// The recorder is killed (SIGKILL) at random points: what it acknowledged is there, nothing is
/// half there.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <random>

#include "core/bytes.hpp"
#include "kills.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace trial {
namespace {
namespace fs = std::filesystem;
constexpr std::uint32_t kPerFrame = 80;  // 20 ms at 4 kHz
constexpr std::uint32_t kFrames = 30;
const int kRounds = kills(250);

Sample sample(std::uint32_t i) {
  Sample s;
  s.t_s = i / 4000.0;
  s.tick = i;
  s.p_VH_m = {1.0 * i, 2.0 * i, 3.0 * i};
  s.force_N = {float(i), 0.5f, -float(i)};
  return s;
}

/// The child: writes and flushes frame after frame, and tells each count only when it is on the
/// disk.
[[noreturn]] void record(const fs::path& path, int acknowledge) {
  const auto tell = [&](std::uint64_t count) {
    if (::write(acknowledge, &count, sizeof count) != sizeof count) ::_exit(2);
  };
  Header header;
  header.id = std::string(32, '1');
  header.case_id = std::string(64, '2');
  auto writer = TrialWriter::create(path, header);
  if (!writer) ::_exit(3);
  tell(0);
  for (std::uint32_t frame = 0; frame < kFrames; ++frame) {
    std::vector<Sample> block;
    for (std::uint32_t i = 0; i < kPerFrame; ++i) block.push_back(sample(frame * kPerFrame + i));
    if (!writer->append(block) || !writer->flush()) ::_exit(4);
    tell(writer->samples_written());
  }
  if (!writer->append(Event{1.0, "end"}) || !writer->finish()) ::_exit(5);
  tell(writer->samples_written());
  ::_exit(0);
}

/// Passes an unpredictable little time without sleeping.
void spin(std::mt19937& random) {
  std::atomic<int> turns = std::uniform_int_distribution<int>(0, 100'000)(random);
  while (turns.fetch_sub(1, std::memory_order_relaxed) > 0) {
  }
}

/// Kills and reaps; true when the child was still at work.
bool kill_now(pid_t child) {
  ::kill(child, SIGKILL);
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << "status " << status;
  return WIFSIGNALED(status);
}

struct Killed {
  std::int64_t acknowledged = -1;  ///< -1: not even the header
  bool at_work = false;
};

/// Lets a recorder run until `wanted` acknowledgements, then kills it somewhere after.
Killed record_and_kill(const fs::path& path, int wanted, std::mt19937& random) {
  int ends[2];
  EXPECT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  const pid_t child = ::fork();
  if (child == 0) record(path, ends[1]);
  ::close(ends[1]);
  Killed out;
  std::uint64_t count = 0;
  const auto hear = [&] {
    if (::read(ends[0], &count, sizeof count) != sizeof count) return false;
    out.acknowledged = std::int64_t(count);
    return true;
  };
  for (int heard = 0; heard < wanted && hear(); ++heard) {
  }
  spin(random);
  out.at_work = kill_now(child);
  while (hear()) {
  }
  ::close(ends[0]);
  return out;
}

void recover_and_kill(const fs::path& path, std::mt19937& random) {
  const pid_t child = ::fork();
  if (child == 0) ::_exit(recover_trial(path) ? 0 : 6);
  spin(random);
  kill_now(child);
}

void expect_acknowledged(const fs::path& path, std::int64_t acknowledged, int round) {
  const auto kept = recover_trial(path);
  ASSERT_TRUE(kept) << "round " << round << ": " << kept.error().what;
  const auto trial = read_trial(path);
  ASSERT_TRUE(trial) << "round " << round << ": " << trial.error().what;
  const auto found = std::int64_t(trial->samples.size());
  EXPECT_EQ(found, std::int64_t(*kept));
  EXPECT_GE(found, acknowledged) << "round " << round << ": acknowledged samples are lost";
  EXPECT_LE(found, acknowledged + kPerFrame) << "round " << round;
  EXPECT_EQ(found % kPerFrame, 0) << "round " << round << ": half a frame";
  for (std::uint32_t i = 0; i < trial->samples.size(); ++i) {
    const Sample expected = sample(i);
    ASSERT_EQ(std::memcmp(&trial->samples[i], &expected, sizeof expected), 0)
        << "round " << round << ", sample " << i;
  }
  EXPECT_TRUE(trial->sealed);
}

TEST(TrialKill, NoAcknowledgedSampleIsLostAndNoneIsHalf) {
  const fs::path folder = fs::temp_directory_path() / ("tractus_kill_" + core::new_id());
  fs::create_directories(folder);
  std::mt19937 random(20261121);
  int at_work = 0;
  for (int round = 0; round < kRounds && !HasFatalFailure(); ++round) {
    const fs::path path = folder / (std::to_string(round) + ".trial");
    const int wanted = std::uniform_int_distribution<int>(0, 16)(random);
    const Killed killed = record_and_kill(path, wanted, random);
    at_work += killed.at_work;
    if (!fs::exists(path)) {
      EXPECT_EQ(killed.acknowledged, -1) << "round " << round << ": an acknowledged file is gone";
      continue;
    }
    if (round % 2 == 0) recover_and_kill(path, random);
    expect_acknowledged(path, std::max<std::int64_t>(killed.acknowledged, 0), round);
    fs::remove(path);
  }
  fs::remove_all(folder);
  EXPECT_GE(at_work, 200) << "too few of the kills met a recorder at work";
}

}  // namespace
}  // namespace trial
}  // namespace tractus
