/// One score of a trial: a number with its unit and what it means. One file each in catalogue/.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trial/trial.hpp"
#include "volume/tract.hpp"

namespace metrics {

/// What the case's maker knows: which wall is breached, if any.
struct Truth {
  std::optional<volume::Wall> breached;
};

/// What a score may be made from. The same for station, server and tool.
struct Subject {
  const trial::Trial& trial;
  const volume::Tract& tract;
  std::optional<Truth> truth;  ///< absent where the scorer must not know
};

/// `value` is empty where the score does not exist for this trial (no contact, no answer, truth
/// unknown).
struct Score {
  std::optional<double> value;
  std::string note;  ///< one line why, when there is no value or something is to be known about it
};

struct MetricInfo {
  std::string id;          ///< "force_xy_mean"
  std::string label;       ///< "Mean transverse force"
  std::string unit;        ///< "N", "s", "1"
  std::string definition;  ///< one sentence with the rule
  std::string source;      ///< paper, table or "own definition"
  Score (*compute)(const Subject& subject);
};

/// Every metric, in file-name order.
std::vector<MetricInfo> all();

/// Wall contact unrolled: for the 3-D page and the coverage metrics.
struct Coverage {
  int depth_bins = 0, angle_bins = 0;
  std::vector<std::uint32_t>
      samples;  ///< [depth][angle]; angle 0 = medial, quarter turn = superior, half = lateral
};

}  // namespace metrics
