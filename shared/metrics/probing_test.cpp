#include <gtest/gtest.h>

#include <checkout.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "core/json.hpp"
#include "metrics/probing_sections.hpp"

namespace tractus {
namespace metrics {
namespace {
using trial::ProbingMode;
using trial::ProbingSample;

const std::string kProbingGolden = std::string(checkout::kSource) + "/tests/golden/statistics/";

trial::Trial empty_trial() {
  trial::Trial trial;
  trial.header.rig = trial::Rig::probing;
  trial.header.rate_Hz = 1000.0;
  trial.complete = true;
  return trial;
}

/// Appends `count` samples 1 ms apart, depth integrated from the speed.
void add(trial::Trial& trial, int count, ProbingMode mode, double speed_m_s, double push_N = 10.0) {
  for (int k = 0; k < count; ++k) {
    ProbingSample s;
    const auto i = trial.probing.size();
    s.t_s = double(i) / 1000.0;
    s.tick = std::uint32_t(i);
    s.x_m = i == 0 ? 0.0 : trial.probing.back().x_m + speed_m_s / 1000.0;
    s.speed_m_s = float(speed_m_s);
    s.fz_N = float(push_N);
    s.mode = mode;
    trial.probing.push_back(s);
  }
}

Score probing_score(const trial::Trial& trial, const std::string& id,
                    std::optional<Truth> truth = std::nullopt) {
  for (const auto& [info, value] : score_all({.trial = trial, .truth = truth}))
    if (info.id == id) return value;
  ADD_FAILURE() << "no metric of probing " << id;
  return {};
}

/// The reference's breach trial (mm and mm/s there), computed by NumPy outside this code.
trial::Trial breach_trial() {
  auto trial = empty_trial();
  std::ifstream file(kProbingGolden + "sim_breach_trial_1kHz.csv");
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    ProbingSample s;
    s.t_s = row.at(0);
    s.tick = std::uint32_t(trial.probing.size());
    s.x_m = 1e-3 * row.at(1);
    s.speed_m_s = float(1e-3 * row.at(2));
    s.fz_N = float(row.at(3));
    s.mode = row.at(4) > 0.5 ? ProbingMode::breach : ProbingMode::bone;
    trial.probing.push_back(s);
  }
  return trial;
}

TEST(ProbingMetrics, AgreeWithTheReferenceOnABreachTrial) {
  const auto trial = breach_trial();
  const auto all = core::read_json(kProbingGolden + "motion_metrics.json").value()["breach_trial"];
  const auto& whole = all["whole_trial"];
  const auto& breach = all["breach_section_only"];
  // Samples hold speed and force as floats: 6e-8 of each, averaged.
  const auto near = [&](const std::string& id, double expected) {
    EXPECT_NEAR(probing_score(trial, id).value.value() / expected, 1.0, 1e-6) << id;
  };
  near("probing_time", whole["operation_time_s_(last-first)"]);
  near("probing_force_mean", whole["force"]["mean"]);
  near("probing_force_variance", whole["force"]["var_n_minus_1"]);
  near("probing_velocity_variance", 1e-6 * whole["velocity"]["var_n_minus_1"].get<double>());
  near("breach_time", breach["breach_time_s_(n_samples*dt)"]);
  near("breach_force_mean", breach["force"]["mean"]);
  near("breach_force_variance", breach["force"]["var_n_minus_1"]);
  near("breach_velocity_variance", 1e-6 * breach["velocity"]["var_n_minus_1"].get<double>());
  near("breach_velocity_onset", 1e-3 * breach["breach_velocity_onset"].get<double>());
  near("breach_velocity_peak", 1e-3 * breach["breach_velocity_peak"].get<double>());
  near("breach_velocity_mean", 1e-3 * breach["breach_velocity_mean"].get<double>());
  near("breach_force", 53.938318);  // the row at 4.971 s, before the onset
  EXPECT_EQ(probing_score(trial, "breaches").value, 1.0);
}

TEST(ProbingMetrics, OfEachRigDoNotApplyToTheOther) {
  auto trial = breach_trial();
  for (const auto& [info, value] : score_all({.trial = trial}))
    EXPECT_NE(info.rig, trial::Rig::palpation) << info.id;
  trial.header.rig = trial::Rig::palpation;
  for (const auto& [info, value] : score_all({.trial = trial}))
    EXPECT_NE(info.rig, trial::Rig::probing) << info.id;
}

TEST(ProbingMetrics, AnEmptyTrialGivesNoNumberAndAReason) {
  const auto trial = empty_trial();
  for (const auto& [info, value] : score_all({.trial = trial})) {
    if (info.id == "late_ticks") continue;  // none is a number
    EXPECT_FALSE(value.value) << info.id;
    EXPECT_FALSE(value.note.empty()) << info.id;
  }
}

TEST(ProbingMetrics, TimeRunsFromTheFirstTurnToTheProbeStop) {
  auto trial = empty_trial();
  add(trial, 500, ProbingMode::holding, 0.0);
  add(trial, 1001, ProbingMode::bone, 0.005);
  add(trial, 700, ProbingMode::stopped, 0.0);
  EXPECT_NEAR(*probing_score(trial, "probing_time").value, 1.0, 1e-12);
  EXPECT_FALSE(probing_score(trial, "breach_time").value);
  trial.probing.resize(500);  // it never turned
  EXPECT_FALSE(probing_score(trial, "probing_time").value);
}

TEST(ProbingMetrics, OnlyTheFirstBreachIsScoredAndTheOthersAreCounted) {
  auto trial = empty_trial();
  add(trial, 100, ProbingMode::resistance, 0.004, 140.0);
  add(trial, 40, ProbingMode::breach, 0.1, 20.0);
  add(trial, 5, ProbingMode::holding, 0.0, 20.0);  // it stops turning in soft tissue
  add(trial, 10, ProbingMode::breach, 0.1, 20.0);
  add(trial, 300, ProbingMode::bone, 0.005, 80.0);
  add(trial, 30, ProbingMode::breach, 0.05, 10.0);
  EXPECT_EQ(probing_score(trial, "breaches").value, 2.0);
  add(trial, 1, ProbingMode::bone, 0.001);
  add(trial, 1, ProbingMode::breach, -0.001);  // back across the far border: no new breach
  EXPECT_EQ(probing_score(trial, "breaches").value, 2.0);
  EXPECT_NEAR(*probing_score(trial, "breach_time").value, 0.055, 1e-12);
  EXPECT_NEAR(*probing_score(trial, "breach_force").value, 140.0, 1e-12);
  EXPECT_NEAR(*probing_score(trial, "breach_force_mean").value, 20.0, 1e-12);
  EXPECT_EQ(probing_score(trial, "breach_force_mean").note, "of the first breach");
  EXPECT_NEAR(*probing_score(trial, "breach_velocity_mean").value, 0.1 * 50 / 55, 1e-8);
}

TEST(ProbingMetrics, CountPausesWithinTheMotionUnderTremor) {
  auto trial = empty_trial();
  add(trial, 300, ProbingMode::bone, 0.0);  // rest before
  add(trial, 1000, ProbingMode::bone, 0.006);
  add(trial, 400, ProbingMode::bone, 0.0);  // a pause
  add(trial, 1000, ProbingMode::bone, 0.006);
  add(trial, 60, ProbingMode::bone, 0.0);  // too short
  add(trial, 1000, ProbingMode::bone, 0.006);
  add(trial, 200, ProbingMode::bone, 0.0);  // rest after
  for (auto& s : trial.probing)             // 10 Hz tremor of 5 mm/s: averaged out over its period
    s.speed_m_s += float(0.005 * std::sin(2.0 * std::numbers::pi * 10.0 * s.t_s));
  EXPECT_EQ(probing_score(trial, "pauses").value, 1.0);
  // Below 1 mm/s while less than a sixth of the 101 samples round it move: from 34 ms after the
  // stop to 34 ms before the start.
  EXPECT_NEAR(*probing_score(trial, "pause_time").value, 0.400 - 2 * 0.034, 0.004);
}

TEST(ProbingMetrics, MissedPeriodsAreAllThatHadNoExchangeInTime) {
  auto trial = empty_trial();
  add(trial, 10, ProbingMode::bone, 0.005);
  trial.probing[2].flags = trial::kMissed | trial::kLate;
  trial.probing[4].flags = trial::kBusLost | trial::kStale;
  trial.probing[9].tick = 12;  // three periods without a sample
  const auto missed = probing_score(trial, "missed_periods");
  EXPECT_EQ(missed.value, 5.0);
  EXPECT_EQ(missed.note, "1 late, 1 failed, 3 skipped");
}

TEST(ProbingMetrics, TheAnswerIsHeldAgainstTheScenariosWalls) {
  auto trial = breach_trial();
  trial.events.push_back({6.0, "answer", {{"breach", true}, {"wall", nullptr}}});
  EXPECT_EQ(probing_score(trial, "answer_right", Truth{.breached = {}, .walls = 1}).value, 1.0);
  EXPECT_EQ(probing_score(trial, "answer_right", Truth{.breached = {}, .walls = 0}).value, 0.0);
  EXPECT_FALSE(probing_score(trial, "answer_right").value);
}

}  // namespace
}  // namespace metrics
}  // namespace tractus
