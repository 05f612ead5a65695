#include "station/session/trial_runner.hpp"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>

#include "core/bytes.hpp"

namespace tractus {
namespace session {
namespace {
namespace fs = std::filesystem;

/// A rig of 100 ticks a second without a device; says what it is told to say.
class FakeRig final : public Rig {
 public:
  struct Told {
    std::vector<std::string> calls;
    Ended ended;
    double cap_N = 0.0;
    std::vector<bool> pauses;
    int ticks = 150;
    int lost = 0;
  };
  FakeRig(Told& told, const TrialTerms& terms) : told_(told), terms_(terms) {}

  const devices::DeviceInfo& device() const override { return info_; }
  TrialTerms terms() const override { return terms_; }
  std::size_t sample_bytes() const override { return sizeof(trial::Sample); }
  core::Result<void> prepare(TrialTime& time) override {
    told_.calls.push_back("prepare");
    time_ = &time;
    return {};
  }
  void describe(trial::Header& header) const override {
    told_.calls.push_back("describe");
    header.case_id = core::sha256(core::bytes_of("a case"));
    header.operator_name = "nobody";
    header.simulated = true;
  }
  void record(trial::TrialWriter writer) override {
    recorder_.emplace(ring_, std::move(writer), time_->real);
    periods_.emplace(time_->loop(), terms_.rate_Hz);
  }
  loop::TrialRecorder& recorder() override { return *recorder_; }
  void arm() override { told_.calls.push_back("arm"); }
  void run() noexcept override {
    told_.calls.push_back("run");
    int left = told_.ticks;
    periods_->run(
        [&](const loop::PeriodicLoop::Tick& at) {
          trial::Sample sample;
          sample.tick = at.number;
          sample.t_s = 0.01 * at.number;
          periods_->count(0, ring_.push(sample) && told_.lost-- <= 0);
        },
        [&] { return --left > 0; });
  }
  void stop() noexcept override { periods_->stop(); }
  void cap_force(double force_N) noexcept override { told_.cap_N = force_N; }
  void pause(bool on) noexcept override { told_.pauses.push_back(on); }
  TrialSnapshot latest(const trial::Header& header) const override { return {.header = header}; }
  const loop::PeriodicLoop& periods() const override { return *periods_; }
  Ended settle() override {
    told_.calls.push_back("settle");
    return told_.ended;
  }
  std::optional<trial::Answer> simulated_answer() const override { return std::nullopt; }
  void complete(TrialReport& report) override { report.injected_J = 0.5; }
  std::vector<trial::Event> closing_events(const TrialReport&, double t_s) const override {
    return {{t_s, "own", core::Json::object()}};
  }
  core::Json end_detail(const TrialReport& report) const override {
    return {{"injected_J", report.injected_J}};
  }
  core::Result<void> keep(const StationFolder&, const trial::Header&) const override {
    told_.calls.push_back("keep");
    return {};
  }

 private:
  Told& told_;
  TrialTerms terms_;
  devices::DeviceInfo info_{.id = "fake", .summary = "SIMULATED", .simulated = true};
  TrialTime* time_ = nullptr;
  loop::SampleRing ring_{4096};
  std::optional<loop::Recorder> recorder_;
  std::optional<loop::PeriodicLoop> periods_;
};

class TrialRunners : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = fs::temp_directory_path() / "runner-XXXXXX";
    root_ = ::mkdtemp(name.data());
    folder_.emplace(*StationFolder::open(root_));
    terms_ = {.speed = Speed::fast, .duration_s = 2.0, .rate_Hz = 100.0};
  }
  void TearDown() override { fs::remove_all(root_); }
  TrialReport done(const Watch& watch = {}) {
    auto made = TrialRunner::make(*folder_, std::make_unique<FakeRig>(told_, terms_));
    EXPECT_TRUE(made) << made.error().what;
    EXPECT_TRUE((*made)->run(watch));
    auto report = (*made)->finish(trial::Answer{.breach = true, .wall = {}, .confidence = {}});
    EXPECT_TRUE(report);
    return *report;
  }
  std::vector<std::string> events(const TrialReport& report) {
    std::vector<std::string> out;
    const auto read = trial::read_trial(report.file);
    for (const auto& event : read->events) out.push_back(event.kind);
    return out;
  }

  fs::path root_;
  std::optional<StationFolder> folder_;
  TrialTerms terms_;
  FakeRig::Told told_;
  using Words = std::vector<std::string>;
};

TEST_F(TrialRunners, RunsARigFromPrepareToTheSealedFile) {
  const TrialReport report = done();
  EXPECT_EQ(told_.calls, (Words{"prepare", "describe", "arm", "run", "settle", "keep"}));
  EXPECT_EQ(events(report), (Words{"start", "own", "answer", "end"}));
  EXPECT_TRUE(report.complete);
  EXPECT_EQ(report.counts.samples, 150u);
  EXPECT_DOUBLE_EQ(report.duration_s, 1.5);
  EXPECT_EQ(report.injected_J, 0.5);
  EXPECT_TRUE(folder_->outbox().holds(report.trial_id));
}

TEST_F(TrialRunners, AFaultTakesNoAnswerAndTheTrialIsKept) {
  told_.ended = {.behind = "", .latched = "too fast"};
  const TrialReport report = done();
  EXPECT_EQ(report.fault, "too fast");
  EXPECT_FALSE(report.complete);
  EXPECT_FALSE(report.answer);
  EXPECT_EQ(events(report), (Words{"start", "own", "fault"}));
  EXPECT_TRUE(folder_->outbox().holds(report.trial_id));
}

TEST_F(TrialRunners, NamesTheGravestReason) {
  RemoteSupervisor outside;
  terms_.outside = &outside;
  told_.ended = {.behind = "too slow", .latched = ""};
  EXPECT_EQ(done().fault, "too slow");
  outside.lower_force(3.0);
  outside.stop("a break");
  EXPECT_EQ(done().fault, "stopped by a supervisor: a break");
  EXPECT_EQ(told_.cap_N, 3.0);
  told_.ended.latched = "too fast";
  EXPECT_EQ(done().fault, "too fast");
  told_.lost = 2;
  EXPECT_EQ(done().fault, "2 samples were not recorded: the disk was too slow");
}

TEST_F(TrialRunners, EndsWhenTheWatchSaysSo) {
  told_.ticks = 1'000'000'000;
  terms_.duration_s = 3600.0;
  const TrialReport report = done([](const TrialSnapshot&) { return false; });
  EXPECT_LT(report.counts.samples, 1'000'000'000u);
}

TEST_F(TrialRunners, APauseIsHandedOnOnceAndStandsInTheFileWithItsLength) {
  RemoteSupervisor outside;
  terms_.outside = &outside;
  terms_.speed = Speed::real;  // 150 ticks of 10 ms
  int seen = 0;
  const TrialReport report = done([&](const TrialSnapshot&) {
    ++seen;
    outside.pause(seen >= 5 && seen < 15);
    return true;
  });
  EXPECT_EQ(told_.pauses, (std::vector<bool>{true, false}));
  const auto read = trial::read_trial(report.file);
  const auto pause = std::ranges::find(read->events, "paused", &trial::Event::kind);
  ASSERT_NE(pause, read->events.end());
  // Ten looks, 30 ms apart; a busy machine makes them longer, never shorter.
  EXPECT_GE(pause->detail.at("lasted_s").get<double>(), 0.25);
}

TEST_F(TrialRunners, RefusesTermsThatNoTrialCanHave) {
  const auto refused = [&] {
    auto made = TrialRunner::make(*folder_, std::make_unique<FakeRig>(told_, terms_));
    return made ? std::string() : made.error().what;
  };
  terms_.duration_s = 0.5;
  EXPECT_EQ(refused(), "--duration 0.5: 1 … 3600 s are possible");
  terms_ = {.speed = Speed::real, .duration_s = 2.0, .rate_Hz = 100.0, .started_utc_us = 1};
  EXPECT_EQ(refused(), "--started: is of simulated time, --speed fast");
  EXPECT_TRUE(told_.calls.empty());
}

}  // namespace
}  // namespace session
}  // namespace tractus
