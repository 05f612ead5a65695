/// One score of a trial: a number with its unit and what it means. One file each in catalogue/.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/json.hpp"
#include "core/named.hpp"
#include "trial/trial.hpp"
#include "volume/tract.hpp"

namespace tractus::metrics {

/// What the case's maker knows.
struct Truth {
  std::optional<volume::Wall> breached;  ///< palpation: which wall is breached, if any
  int walls = 0;                         ///< probing: how many walls the scenario lets give way
  /// Palpation: how well an ideal observer tells the breach; absent where the case does not say.
  std::optional<double> d_prime = {};
};

class ThresholdStatistics;
struct TipMotion;
struct Kinematics;
struct Coverage;

/// Signals that several scores are made from: computed when the first score asks for one, and kept
/// for the others. One thread at a time.
struct DerivedSignals {
  std::shared_ptr<const std::array<ThresholdStatistics, 4>> wrench;  ///< wrench_score
  std::shared_ptr<const TipMotion> tip_motion;                       ///< tip_motion
  std::shared_ptr<const std::optional<Kinematics>> kinematics;       ///< score_of_kinematics
  std::shared_ptr<const std::optional<Coverage>> coverage;           ///< coverage
};

/// What a score may be made from. The same for station, server and tool.
struct Subject {
  const trial::Trial& trial;
  const volume::Tract* tract = nullptr;  ///< of palpation; what needs it has no value without
  std::optional<Truth> truth = {};       ///< absent where the scorer must not know
  mutable DerivedSignals derived = {};
};

/// `value` is empty where the score does not exist for this trial (no contact, no answer, truth
/// unknown).
struct Score {
  std::optional<double> value;
  std::string note;  ///< one line why, when there is no value or something is to be known about it
};

/// How a page writes a value.
enum class ShownAs {
  number,               ///< with its unit
  share,                ///< as a percentage
  correct_or_incorrect  ///< 1: "correct", 0: "incorrect"; such a metric judges the trainee's answer
};
constexpr auto words(ShownAs) {
  using enum ShownAs;
  return std::to_array<core::Word<ShownAs>>(
      {{number, "number"}, {share, "share"}, {correct_or_incorrect, "correct_or_incorrect"}});
}
using core::name;

/// Place in a table of statistics: one row for each quantity, one column for each statistic.
struct TableCell {
  std::string row;     ///< "Transverse force"
  std::string symbol;  ///< "F_xy"
  std::string column;  ///< "Mean"
};

/// Of trials of either rig.
inline constexpr std::optional<trial::Rig> kBothRigs;

struct MetricInfo {
  std::string id;                 ///< "force_xy_mean"
  std::string label;              ///< "Mean transverse force"
  std::string unit;               ///< "N", "s", "1"
  std::string definition;         ///< one sentence with the rule
  std::string source;             ///< paper, table or "own definition"
  std::optional<trial::Rig> rig;  ///< whose trials it is of: of one rig, or kBothRigs
  Score (*compute)(const Subject& subject);
  bool (*is_of)(const trial::Trial& trial) = nullptr;  ///< of which of them; null: of all
  ShownAs shown_as = ShownAs::number;
  std::optional<TableCell> cell = {};  ///< nothing: the value stands by itself
  /// Place among the scores that a trainee's page follows from trial to trial, 1 first; 0: not
  /// followed.
  int followed = 0;
};

/// Every metric, in file-name order.
std::vector<MetricInfo> all();

/// Wall contact unrolled: for the 3-D page and the coverage metrics.
///
/// A sample touches a wall when the part of the model's force that is perpendicular to the tract's
/// axis is at least kContact_N and the tip lies between mouth and end. Its bin is the tip's depth
/// along the axis and the direction from which that force comes: bone pushes the probe away from
/// itself, so the wall that is touched lies opposite to the force, wherever the shank leans.
/// (The tip's offset from the axis would name the same wall while the tip touches, and a wrong one
/// while only the shank does.) Own definition.
struct Coverage {
  int depth_bins = 0, angle_bins = 0;
  /// [depth][angle], samples that touched. Bins are centred on their angle: 0 = medial, a quarter
  /// turn = superior, half a turn = lateral.
  std::vector<std::uint32_t> samples;

  /// Counts one contact; a depth outside 0 … 1 (of the tract's length) is not counted.
  void add(double depth_share, double angle_rad);
  /// Share of bins touched: of all side walls, or of one side wall's quarter.
  double share(std::optional<volume::Wall> side = {}) const;
};

/// From here on a force is a contact, N [Zoller2020, Table 1].
inline constexpr double kContact_N = 0.01;
inline constexpr int kDepthBins = 10, kAngleBins = 12;

/// Nothing when there is no tract or the trial's header does not place the tip.
const std::optional<Coverage>& coverage(const Subject& subject);

/// All scores that apply to the trial's rig, in the order of all().
std::vector<std::pair<MetricInfo, Score>> score_all(const Subject& subject);

/// {"id", "label", "unit", "definition", "source", "shown_as", "cell": {"row", "symbol",
/// "column"}|null}
core::Json to_json(const MetricInfo& info);
/// The same with {"value"|null, "note"}: as files, tool and server write a score.
core::Json to_json(const MetricInfo& info, const Score& score);

}  // namespace tractus::metrics
