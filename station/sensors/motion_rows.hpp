/// Tracked poses as they come to rows of a table: one instant, one row.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "station/sensors/igtl_message.hpp"

namespace tractus::sensors {

/// Columns `t_s,NAME.px_m … NAME.qz,…,arrived_s`. t_s is the sender's clock from its first stamp,
/// or when it does not stamp, the same as arrived_s: this computer's. A body that was not seen at a
/// row's instant has zeros for its quaternion. Rows whose time does not run forward are left out.
class MotionRows {
 public:
  explicit MotionRows(std::vector<std::string> bodies);
  std::string header() const;
  /// The row that is whole now that this came, if one is.
  std::optional<std::string> take(const TrackedPose& seen, double arrived_s);
  /// What is left.
  std::optional<std::string> flush();
  std::uint64_t count() const noexcept { return count_; }
  /// Of each body: rows in which it was seen, for what was flushed.
  const std::map<std::string, std::uint64_t>& seen() const noexcept { return seen_; }
  /// Bodies that never came.
  std::vector<std::string> missing() const;
  /// Names that came and are not kept; 50 at most.
  const std::set<std::string>& others() const noexcept { return others_; }

 private:
  std::vector<std::string> bodies_;
  std::map<std::string, math::Pose> held_;
  std::map<std::string, std::uint64_t> seen_;
  std::set<std::string> others_;
  std::optional<double> first_stamp_s_;
  double t_s_ = 0.0, arrived_s_ = 0.0, last_s_ = -1e300;
  std::uint64_t count_ = 0;
};

}  // namespace tractus::sensors
