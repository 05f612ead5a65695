#include "station/sensors/motion_rows.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace tractus::sensors {
namespace {
constexpr std::size_t kMostOthers = 50;
}

MotionRows::MotionRows(std::vector<std::string> bodies) : bodies_(std::move(bodies)) {
  for (const std::string& body : bodies_) seen_[body] = 0;
}

std::vector<std::string> MotionRows::missing() const {
  std::vector<std::string> out;
  for (const auto& [body, rows] : seen_)
    if (rows == 0 && !held_.contains(body)) out.push_back(body);
  return out;
}

std::string MotionRows::header() const {
  std::string out = "t_s";
  for (const std::string& b : bodies_)
    out += fmt::format(",{0}.px_m,{0}.py_m,{0}.pz_m,{0}.qw,{0}.qx,{0}.qy,{0}.qz", b);
  return out + ",arrived_s\n";
}

std::optional<std::string> MotionRows::take(const TrackedPose& seen, double arrived_s) {
  if (std::ranges::find(bodies_, seen.body) == bodies_.end()) {
    if (others_.size() < kMostOthers) others_.insert(seen.body);
    return std::nullopt;
  }
  const bool stamped = seen.stamp_s > 0.0;
  if (stamped && !first_stamp_s_) first_stamp_s_ = seen.stamp_s;
  const double t_s = stamped ? seen.stamp_s - *first_stamp_s_ : arrived_s;
  const bool another = !held_.empty() && (stamped ? t_s != t_s_ : held_.contains(seen.body));
  auto row = another ? flush() : std::nullopt;
  if (held_.empty()) {
    t_s_ = t_s;
    arrived_s_ = arrived_s;
  }
  held_[seen.body] = seen.X_CB;
  return row;
}

std::optional<std::string> MotionRows::flush() {
  if (held_.empty() || t_s_ <= last_s_) {
    held_.clear();
    return std::nullopt;
  }
  last_s_ = t_s_;
  std::string row = fmt::format("{:.7f}", t_s_);
  for (const std::string& b : bodies_) {
    const auto at = held_.find(b);
    if (at == held_.end()) {
      row += ",0,0,0,0,0,0,0";
      continue;
    }
    ++seen_[b];
    const auto& [p, q] = at->second;
    row += fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", p.x(), p.y(), p.z(),
                       q.w(), q.x(), q.y(), q.z());
  }
  held_.clear();
  ++count_;
  return row + fmt::format(",{:.7f}\n", arrived_s_);
}

}  // namespace tractus::sensors
