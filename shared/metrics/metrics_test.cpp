#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <checkout.hpp>
#include <cmath>
#include <fstream>
#include <numbers>
#include <set>
#include <sstream>

#include "math/savitzky_golay.hpp"
#include "metrics/metric.hpp"
#include "metrics/path_length.hpp"
#include "metrics/threshold_statistics.hpp"

namespace tractus {
namespace metrics {
namespace {
const std::string kGolden = std::string(checkout::kSource) + "/tests/golden/statistics/";

core::Json golden(const std::string& name) { return core::read_json(kGolden + name).value(); }

/// Rows of a CSV with one line of names.
std::vector<std::vector<double>> table(const std::string& name) {
  std::ifstream file(kGolden + name);
  std::vector<std::vector<double>> rows;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::istringstream cells(line);
    std::vector<double> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(std::stod(cell));
    rows.push_back(row);
  }
  EXPECT_FALSE(rows.empty()) << name;
  return rows;
}

/// A tract along x from (0, 0, 0), 30 mm long; medial is y, superior is z. A probe of 0.1 m.
struct Bench {
  Bench() {
    tract.axis = {1, 0, 0};
    tract.medial = {0, 1, 0};
    tract.superior = {0, 0, 1};
    tract.length_m = 0.03;
    tract.radius_m = 0.002;
    trial.header.probe = {{"length_m", 0.1}};
    trial.complete = true;
  }
  /// The unbent tip at `tip_m`, the shank along x; `force_V_N` in V.
  void add(double t_s, const math::Vec3& tip_m, const math::Vec3& force_V_N) {
    trial::Sample s;
    s.t_s = t_s;
    s.tick = std::uint32_t(trial.samples.size());
    const math::Quat q = math::Quat::FromTwoVectors(math::Vec3::UnitZ(), math::Vec3::UnitX());
    s.q_VH = {q.w(), q.x(), q.y(), q.z()};
    s.p_VH_m = {tip_m.x() - 0.1, tip_m.y(), tip_m.z()};
    const math::Vec3 f_H = q.conjugate() * force_V_N;
    s.force_N = {float(f_H.x()), float(f_H.y()), float(f_H.z())};
    trial.samples.push_back(s);
  }
  Subject subject() const { return {trial, &tract, truth}; }
  Score score(const std::string& id) const {
    for (const auto& info : all())
      if (info.id == id) return info.compute(subject());
    ADD_FAILURE() << "no metric " << id;
    return {};
  }

  trial::Trial trial;
  volume::Tract tract;
  std::optional<Truth> truth;
};

/// The rows of sim_force_torque_100Hz.csv as a trial.
Bench force_torque() {
  Bench bench;
  for (const auto& row : table("sim_force_torque_100Hz.csv")) {
    trial::Sample s;
    s.t_s = row[0];
    s.tick = std::uint32_t(bench.trial.samples.size());
    s.force_N = {float(row[1]), float(row[2]), float(row[3])};
    s.torque_Nm = {float(row[4]), float(row[5]), float(row[6])};
    bench.trial.samples.push_back(s);
  }
  return bench;
}

TEST(Metrics, EveryEntryExplainsItselfUnderItsFilesName) {
  std::set<std::string> ids;
  for (const auto& info : all()) {
    ids.insert(info.id);
    EXPECT_FALSE(info.label.empty()) << info.id << " has no label";
    EXPECT_FALSE(info.unit.empty()) << info.id << " has no unit; a number without one has \"1\"";
    EXPECT_FALSE(info.source.empty()) << info.id << " has no source";
    EXPECT_TRUE(info.definition.ends_with('.')) << info.id;
    EXPECT_TRUE(std::ifstream(std::string(checkout::kSource) + "/shared/metrics/catalogue/" +
                              info.id + ".cpp")
                    .good())
        << info.id;
  }
  EXPECT_EQ(ids.size(), all().size());
}

TEST(Metrics, AnEmptyTrialGivesNoNumberAndAReason) {
  Bench bench;
  bench.trial.header.probe = core::Json::object();
  for (const auto& [info, score] : score_all(bench.subject())) {
    if (info.id == "late_ticks") continue;  // none is a number
    EXPECT_FALSE(score.value) << info.id;
    EXPECT_FALSE(score.note.empty()) << info.id;
  }
}

TEST(ThresholdStatistics, AgreesWithTheReference) {
  const auto expected = golden("threshold_descriptives.json");
  const auto check = [](const ThresholdStatistics& ours, const core::Json& theirs) {
    EXPECT_EQ(ours.count(), theirs["n_used"].get<std::uint64_t>());
    const auto near = [](double value, double of) { EXPECT_NEAR(value / of, 1.0, 1e-12); };
    near(*ours.mean(), theirs["mean"]);
    near(*ours.sd(), theirs["sd_n_minus_1"]);
    near(*ours.max(), theirs["max"]);
  };
  ThresholdStatistics force_xy(0.01), force_z(0.01), torque_xy(0.001), torque_z(0.001);
  for (const auto& row : table("sim_force_torque_100Hz.csv")) {
    force_xy.add(std::hypot(row[1], row[2]));
    force_z.add(std::abs(row[3]));
    torque_xy.add(std::hypot(row[4], row[5]));
    torque_z.add(std::abs(row[6]));
  }
  check(force_xy, expected["F_xy"]);
  check(force_z, expected["F_z_abs"]);
  check(torque_xy, expected["T_xy"]);
  check(torque_z, expected["T_z_abs"]);
}

TEST(ThresholdStatistics, TheFloorItselfIsOut) {
  ThresholdStatistics s(0.01);
  for (const double v : {0.01, 0.0, 0.02, 0.04}) s.add(v);  // mean 0.03, sd sqrt(2)·0.01
  EXPECT_EQ(s.count(), 2u);
  EXPECT_DOUBLE_EQ(*s.mean(), 0.03);
  EXPECT_DOUBLE_EQ(*s.sd(), std::sqrt(2.0) * 0.01);
  EXPECT_DOUBLE_EQ(*s.max(), 0.04);
}

TEST(Metrics, TheTwelveCellsOfTheTablesAgreeWithTheReference) {
  const auto expected = golden("threshold_descriptives.json");
  const Bench bench = force_torque();
  const std::pair<const char*, const char*> parts[] = {
      {"force_xy", "F_xy"}, {"force_z", "F_z_abs"}, {"torque_xy", "T_xy"}, {"torque_z", "T_z_abs"}};
  const std::pair<const char*, const char*> cells[] = {
      {"_mean", "mean"}, {"_sd", "sd_n_minus_1"}, {"_max", "max"}};
  for (const auto& [ours, theirs] : parts)
    for (const auto& [suffix, key] : cells) {
      const auto score = bench.score(std::string(ours) + suffix);
      ASSERT_TRUE(score.value) << ours << suffix;
      EXPECT_NEAR(*score.value / expected[theirs][key].get<double>(), 1.0, 1e-6) << ours << suffix;
    }
  EXPECT_EQ(bench.score("force_z_mean").note, "over 487 of 600 samples");
}

TEST(SavitzkyGolay, HasTheExactWeightsOfTheReference) {
  const auto expected = golden("motion_metrics.json");
  for (const auto& set : expected["savgol"]) {
    const int window = set["window"], order = set["polyorder"], derivative = set["deriv"];
    const bool edge = set["use"].get<std::string>().starts_with("left-edge");
    const math::SavitzkyGolay filter(window, order, derivative);
    const auto weights = filter.weights(edge ? 0 : window / 2);
    for (int i = 0; i < window; ++i)
      EXPECT_NEAR(weights[i], set["coef"][std::size_t(i)].get<double>(), 1e-13)
          << window << " " << order << " " << derivative;
  }
}

TEST(PathLength, AgreesWithTheReferenceThroughAWholeTrial) {
  const auto expected =
      golden("motion_metrics.json")["trajectory"]["velocity_by_savgol(21,3,interp)"];
  const double length_mm = expected["path_length_by_trapezoid_of_speed"];
  Bench bench;
  int i = 0;
  for (const auto& row : table("sim_trajectory_200Hz_mm.csv"))
    bench.add(i++ / 200.0, 1e-3 * math::Vec3(row[1], row[2], row[3]), math::Vec3::Zero());
  const auto score = bench.score("path_length");
  ASSERT_TRUE(score.value) << score.note;
  EXPECT_NEAR(*score.value * 1e3 / length_mm, 1.0, 1e-9);
}

TEST(PathLength, OfASteadyMotionIsItsStraightWayAtAnyRateAndAcrossGaps) {
  Bench bench;
  for (int i = 0; i <= 4000; ++i)  // 20 mm/s for 1 s at 4 kHz, a tenth of the ticks skipped
    if (i % 10 != 3) bench.add(i / 4000.0, {0.02 * i / 4000.0, 0, 0}, math::Vec3::Zero());
  EXPECT_NEAR(*bench.score("path_length").value, 0.02, 1e-9);
}

TEST(PathLength, OfTwentyPointsIsUnknown) {
  EXPECT_FALSE(smoothed_length_m(std::vector<math::Vec3>(20, math::Vec3::Zero()), 0.005));
}

TEST(Coverage, AgreesWithTheReference) {
  const auto expected = golden("motion_metrics.json")["wall_coverage"];
  // Contact at angle θ of the wall: the bone pushes the probe the other way.
  const auto touched = [](double turned_by) {
    Bench bench;
    int i = 0;
    for (const auto& row : table("sim_wall_contacts.csv")) {
      const double theta = row[1] + turned_by;
      bench.add(i++ * 1e-3, {row[0] * 1e-3, 0, 0},
                -row[2] * math::Vec3(0, std::cos(theta), std::sin(theta)));
    }
    return bench;
  };
  const double half_bin = std::numbers::pi / 12;
  EXPECT_NEAR(*touched(-half_bin).score("wall_coverage").value, expected["coverage"].get<double>(),
              1e-12);
  const Bench quarters = touched(-std::numbers::pi / 4);
  const char* sides[] = {"medial", "superior", "lateral", "inferior"};
  for (std::size_t q = 0; q < 4; ++q)
    EXPECT_NEAR(*quarters.score(std::string("wall_coverage_") + sides[q]).value,
                expected["coverage_by_quadrant"][q].get<double>(), 1e-12)
        << sides[q];
  std::uint64_t contacts = 0;
  const auto bins = *coverage(quarters.subject());
  for (const auto n : bins.samples) contacts += n;
  EXPECT_EQ(contacts, expected["n_contacts_used"].get<std::uint64_t>());
}

TEST(Coverage, ATouchOfOneWallIsSeenOnThatWallAlone) {
  const std::pair<const char*, math::Vec3> pushes[] = {{"medial", {0, -1, 0}},
                                                       {"lateral", {0, 1, 0}},
                                                       {"superior", {0, 0, -1}},
                                                       {"inferior", {0, 0, 1}}};
  for (const auto& [touched, force] : pushes) {
    Bench bench;
    bench.add(0, {0.0149, 0, 0}, force);
    for (const auto& [side, _] : pushes)
      EXPECT_DOUBLE_EQ(*bench.score(std::string("wall_coverage_") + side).value,
                       side == touched ? 1.0 / 30 : 0.0)
          << "touched " << touched << ", asked for " << side;
    const auto bins = *coverage(bench.subject());
    EXPECT_EQ(bins.samples.size(), 120u);
    // depth 14.9 of 30 mm: bin 4; the wall's middle bin
    const std::size_t middle = touched == std::string("medial")     ? 0
                               : touched == std::string("superior") ? 3
                               : touched == std::string("lateral")  ? 6
                                                                    : 9;
    EXPECT_EQ(bins.samples[4 * 12 + middle], 1u) << touched;
  }
}

TEST(Coverage, OutsideTheTractAndAlongItsAxisNothingIsTouched) {
  Bench bench;
  bench.add(0, {-0.001, 0, 0}, {0, 1, 0});
  bench.add(1, {0.031, 0, 0}, {0, 1, 0});
  bench.add(2, {0.015, 0, 0}, {-5, 0, 0});      // the end pushes back
  bench.add(3, {0.015, 0, 0}, {0, 0.0099, 0});  // below the floor
  EXPECT_EQ(*bench.score("wall_coverage").value, 0.0);
  bench.add(4, {0.03, 0, 0}, {0, 1, 0});  // the very end counts
  EXPECT_DOUBLE_EQ(*bench.score("wall_coverage").value, 1.0 / 120);
}

TEST(Metrics, CountsByHand) {
  Bench bench;
  for (int i = 0; i < 8; ++i) bench.add(0.5 + i * 0.25, {0.01, 0, 0}, {0, i < 3 ? 0.02 : 0.0, 0});
  bench.trial.samples[2].flags = trial::kNotConverged | trial::kLate;
  bench.trial.samples[5].flags = trial::kLate;
  bench.trial.samples[7].tick = 9;
  EXPECT_DOUBLE_EQ(*bench.score("operation_time").value, 1.75);
  EXPECT_DOUBLE_EQ(*bench.score("contact_share").value, 3.0 / 8);
  EXPECT_DOUBLE_EQ(*bench.score("not_converged_share").value, 1.0 / 8);
  EXPECT_DOUBLE_EQ(*bench.score("late_ticks").value, 2.0);
  EXPECT_EQ(bench.score("late_ticks").note, "and 2 skipped");
  EXPECT_EQ(bench.score("operation_time").note, "");
  bench.trial.complete = false;
  EXPECT_EQ(bench.score("operation_time").note, "the trial was interrupted");
}

TEST(AnswerRight, NeedsTheBreachAndItsWall) {
  using volume::Wall;
  const auto judged = [](core::Json answer, std::optional<Wall> breached) {
    Bench bench;
    bench.trial.events = {{1, "answer", std::move(answer)}};
    bench.truth = Truth{breached};
    return bench.score("answer_right").value;
  };
  EXPECT_EQ(judged({{"breach", false}, {"wall", nullptr}}, {}), 1.0);
  EXPECT_EQ(judged({{"breach", false}, {"wall", nullptr}}, Wall::medial), 0.0);
  EXPECT_EQ(judged({{"breach", true}, {"wall", "medial"}}, Wall::medial), 1.0);
  EXPECT_EQ(judged({{"breach", true}, {"wall", "lateral"}}, Wall::medial), 0.0);
  EXPECT_EQ(judged({{"breach", true}, {"wall", nullptr}}, Wall::medial), 0.0);
  EXPECT_EQ(judged({{"breach", true}, {"wall", "medial"}}, {}), 0.0);
  EXPECT_EQ(judged({{"nonsense", 1}}, {}), std::nullopt);
}

TEST(AnswerRight, IsUnknownWithoutTheTruthAndTheLastAnswerCounts) {
  Bench bench;
  bench.trial.events = {{1, "answer", {{"breach", true}, {"wall", "medial"}}},
                        {2, "answer", {{"breach", false}}}};
  EXPECT_FALSE(bench.score("answer_right").value);
  EXPECT_EQ(bench.score("answer_right").note, "the truth is not known here");
  bench.truth = Truth{};
  EXPECT_EQ(bench.score("answer_right").value, 1.0);
}

// 30 mm planned: 31.2 mm deep is 1.2 mm too far; an entry (3, −4) mm aside is 5 mm off.
TEST(Metrics, OfADrilledChannelAreWhatItsEventSays) {
  Bench bench;
  bench.trial.events.push_back(
      {1.0,
       "drilled",
       {{"removed_m3", 2.5e-7},
        {"channel",
         {{"entry_offset_m", {0.003, -0.004}},
          {"angle_rad", 0.1},
          {"depth_m", 0.0312},
          {"beyond_m", {{"medial", -0.001}, {"superior", 0.0004}, {"anterior", nullptr}}}}}}});
  EXPECT_EQ(bench.score("drilled_volume").value, 2.5e-7);
  EXPECT_EQ(bench.score("channel_angle").value, 0.1);
  EXPECT_DOUBLE_EQ(*bench.score("channel_entry_offset").value, 0.005);
  EXPECT_NEAR(*bench.score("channel_beyond_end").value, 0.0012, 1e-12);
  EXPECT_EQ(bench.score("channel_breach").value, 0.0004);
  EXPECT_EQ(bench.score("channel_breach").note, "through the superior wall");
}

// The bounds of the classes [Gertzbein1990]: 0, 2, 4 and 6 mm.
TEST(BreachClass, ChangesAtTheBoundsOfTheSource) {
  const std::vector<std::pair<double, char>> known{
      {-0.001, 'A'}, {0.0, 'A'},   {0.0001, 'B'}, {0.0019, 'B'}, {0.002, 'C'},
      {0.0039, 'C'}, {0.004, 'D'}, {0.0059, 'D'}, {0.006, 'E'},  {0.02, 'E'}};
  for (const auto& [beyond_m, letter] : known) {
    Bench bench;
    bench.trial.events.push_back(
        {1.0,
         "drilled",
         {{"channel",
           {{"worst",
             {{"beyond_m", beyond_m}, {"depth_m", 0.012}, {"farthest_m", {0.001, -0.006}}}}}}}});
    const Score score = bench.score("breach_class");
    EXPECT_EQ(score.value, beyond_m);
    EXPECT_EQ(score.note.substr(0, 8), std::string("class ") + letter + ":") << score.note;
    EXPECT_NE(score.note.find("at depth 12 mm, inferior"), std::string::npos) << score.note;
  }
}

TEST(Metrics, OfADrilledChannelHaveNoValueWhereTheEventIsNotUnderstood) {
  for (const core::Json& detail :
       {core::Json::object(), core::Json{{"channel", 7}, {"removed_m3", "much"}},
        core::Json{
            {"channel",
             {{"entry_offset_m", {1}}, {"beyond_m", 3}, {"depth_m", nullptr}, {"worst", 4}}}}}) {
    Bench bench;
    bench.trial.events.push_back({1.0, "drilled", detail});
    for (const char* id : {"drilled_volume", "channel_angle", "channel_entry_offset",
                           "channel_beyond_end", "channel_breach", "breach_class"}) {
      EXPECT_FALSE(bench.score(id).value) << id << " " << detail;
      EXPECT_FALSE(bench.score(id).note.empty()) << id;
    }
  }
}

TEST(Metrics, OfADrilledChannelAreOfTrialsThatDrill) {
  const auto has_one = [](const trial::Trial& trial) {
    return std::ranges::any_of(score_all({.trial = trial}), [](const auto& scored) {
      return scored.first.id == "drilled_volume";
    });
  };
  Bench bench;
  EXPECT_FALSE(has_one(bench.trial));
  bench.trial.header.extra["drilling"] = {{"law", "tractus-drilling/1"}};
  EXPECT_TRUE(has_one(bench.trial));
}

}  // namespace
}  // namespace metrics
}  // namespace tractus
