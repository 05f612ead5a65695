#include "station/check/device_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/try.hpp"
#include "station/check/driver.hpp"

namespace tractus {
namespace check {
namespace {
using devices::Sample;
using math::Vec3;
using math::Wrench;

constexpr double kMoment_s = 0.25, kAfterRamp_s = 0.1, kAtRest_s = 1.0, kStep_s = 0.5;
constexpr std::size_t kSteps = 1 << 16;
constexpr const char* kAxes[] = {"x (to the operator)", "y (to the right)", "z (up)"};

Vec3 turn_between(const math::Quat& from, const math::Quat& to) {
  const Eigen::AngleAxisd turn((to * from.conjugate()).normalized());
  return turn.angle() * turn.axis();
}

core::Result<void> check_rest(Driver& driver, const DeviceGoals& goals, std::vector<Finding>& out) {
  auto from = TRY(driver.mean_pose(kMoment_s, {}));
  TRY(driver.run(kAtRest_s - kMoment_s, {}));
  auto at = TRY(driver.mean_pose(kMoment_s, {}));
  const double drift = (at.p - from.p).norm();
  const bool still = drift <= goals.rest_m;
  out.push_back({.name = "rest at zero force",
                 .passed = still,
                 .value = drift,
                 .limit = goals.rest_m,
                 .unit = "m",
                 .words = still ? "in a second with no force the handle stays where it is held"
                                : "with no force the handle wanders: calibrate it; look for a "
                                  "cable that pulls"});
  return {};
}

/// What a push along `axis` did, in words.
std::string words_of(const Vec3& way, int axis, double least, const std::string& push) {
  Vec3 across = way;
  across[axis] = 0.0;
  if (way[axis] <= -least)
    return fmt::format(
        "{} moves it the WRONG WAY: do not use it; its motor or its cabling is "
        "reversed",
        push);
  if (way[axis] < least)
    return fmt::format(
        "{} does not move it: let it move freely and repeat; else its motor gives "
        "no force, or the axis is stuck",
        push);
  if (across.norm() > 0.5 * way[axis])
    return fmt::format("{} moves it across as well: hold it loosely and repeat; else calibrate it",
                       push);
  return fmt::format("{} moves it the right way", push);
}

Finding direction_of(const math::Pose& before, const math::Pose& after, int axis,
                     const DeviceGoals& goals) {
  const bool turns = axis >= 3;
  const Vec3 way = turns ? turn_between(before.q, after.q) : Vec3(after.p - before.p);
  const double least = turns ? goals.least_turn_rad : goals.least_way_m;
  Vec3 across = way;
  across[axis % 3] = 0.0;
  const std::string push =
      turns ? fmt::format("{} N·m", goals.turn_Nm) : fmt::format("{} N", goals.push_N);
  return {.name = fmt::format("direction {} {}", turns ? "about" : "along", kAxes[axis % 3]),
          .passed = way[axis % 3] >= least && across.norm() <= 0.5 * way[axis % 3],
          .value = way[axis % 3],
          .limit = least,
          .bound = Bound::at_least,
          .unit = turns ? "rad" : "m",
          .words = words_of(way, axis % 3, least, push)};
}

core::Result<void> check_directions(Driver& driver, const DeviceGoals& goals,
                                    std::vector<Finding>& out) {
  for (int axis = 0; axis < 6; ++axis) {
    Wrench push;
    (axis < 3 ? push.force_N : push.torque_Nm)[axis % 3] = axis < 3 ? goals.push_N : goals.turn_Nm;
    auto before = TRY(driver.mean_pose(kMoment_s, {}));
    TRY(driver.run(kMoment_s, push));
    auto after = TRY(driver.mean_pose(kMoment_s, push));
    TRY(driver.run(kMoment_s, {}));
    out.push_back(direction_of(before, after, axis, goals));
  }
  return {};
}

/// The way along x at each time since the step, s and m.
using Way = std::vector<std::pair<double, double>>;

double time_at(const Way& way, double height_m) {
  const auto at =
      std::ranges::find_if(way, [&](const auto& point) { return point.second >= height_m; });
  return at == way.end() ? kStep_s : at->first;
}

void judge_step(const Way& way, const DeviceGoals& goals, std::vector<Finding>& out) {
  double end_m = 0.0, most_m = 0.0;
  const auto tail = way.size() - std::max<std::size_t>(1, way.size() / 10);
  for (std::size_t k = 0; k < way.size(); ++k) {
    most_m = std::max(most_m, way[k].second);
    if (k >= tail) end_m += way[k].second / double(way.size() - tail);
  }
  Finding delay{.name = "step response, delay", .limit = goals.response_s, .unit = "s"};
  if (end_m < goals.least_way_m) {
    delay.words = fmt::format("a step of {} N along x did not move the handle", goals.push_N);
    out.push_back(delay);
    return;
  }
  const double tenth_s = time_at(way, 0.1 * end_m);
  const double rise_s = time_at(way, 0.9 * end_m) - tenth_s;
  const double over = most_m / end_m - 1.0;
  delay.value = tenth_s;
  delay.passed = tenth_s <= goals.response_s;
  delay.words =
      fmt::format("from a step of {} N along x to a tenth of its {:.1f} mm{}", goals.push_N,
                  1e3 * end_m, delay.passed ? "" : ": too late; look for friction and slack");
  out.push_back(delay);
  out.push_back({.name = "step response, rise time",
                 .passed = rise_s <= goals.rise_s,
                 .value = rise_s,
                 .limit = goals.rise_s,
                 .unit = "s",
                 .words = rise_s <= goals.rise_s
                              ? "from a tenth to nine tenths of its way"
                              : "it creeps: hold it loosely and repeat; else look for friction"});
  out.push_back(
      {.name = "step response, overshoot",
       .passed = over <= goals.overshoot,
       .value = over,
       .limit = goals.overshoot,
       .unit = "",
       .words = over <= goals.overshoot
                    ? "share of the way, beyond where it came to rest"
                    : "it swings: hold it loosely and repeat; else its joints have play"});
}

core::Result<void> check_step(Driver& driver, const DeviceGoals& goals, std::vector<Finding>& out) {
  const Wrench push{{goals.push_N, 0, 0}, Vec3::Zero()};
  auto before = TRY(driver.mean_pose(kMoment_s, {}));
  Way way;
  way.reserve(kSteps);
  TRY(driver.run(kStep_s, push, [&](double t_s, const Sample& sample) {
    way.emplace_back(t_s, sample.X_DH.p.x() - before.p.x());
  }));
  judge_step(way, goals, out);
  return {};
}

Finding round_trip(const Durations& trips, double period_s) {
  const double p99_s = trips.quantile_s(0.99);
  const bool fits = p99_s <= period_s;
  return {.name = "device round trip",
          .passed = fits,
          .value = p99_s,
          .limit = period_s,
          .unit = "s",
          .words = fmt::format("a read and a write through the driver: {}{}", trips.text(),
                               fits ? ""
                                    : ": longer than a step of the loop; give the device a USB "
                                      "controller of its own")};
}
}  // namespace

core::Result<void> check_travel(Bench bench, const DeviceGoals& goals, double for_s,
                                std::vector<Finding>& out) {
  Driver driver(bench);
  driver.plan(for_s);
  Eigen::AlignedBox3d seen;
  TRY(driver.run(for_s, {}, [&](double, const Sample& s) { seen.extend(s.X_DH.p); }));
  const Vec3 range = seen.sizes();
  const bool far = range.minCoeff() >= goals.travel_m;
  out.push_back({.name = "travel",
                 .passed = far,
                 .value = range.minCoeff(),
                 .limit = goals.travel_m,
                 .bound = Bound::at_least,
                 .unit = "m",
                 .words = fmt::format("a hand moved it {:.0f} × {:.0f} × {:.0f} mm (x, y, z){}",
                                      1e3 * range.x(), 1e3 * range.y(), 1e3 * range.z(),
                                      far ? ""
                                          : ": move it to every end; else something blocks it "
                                            "or a joint does not count")});
  return {};
}

core::Result<void> check_forces(Bench bench, const DeviceGoals& goals, std::vector<Finding>& out) {
  Driver driver(bench);
  // The quiet moment and the ramp, with nothing wanted yet.
  const double ramp_s = bench.limiter.limits().ramp_s + kAfterRamp_s;
  driver.plan(ramp_s + kAtRest_s + 6 * 4 * kMoment_s + 2 * kMoment_s + kStep_s);
  TRY(driver.run(ramp_s, {}));
  for (auto* part : {&check_rest, &check_directions, &check_step}) TRY((*part)(driver, goals, out));
  out.push_back(round_trip(driver.trips(), 1.0 / bench.rate_Hz));
  return {};
}

}  // namespace check
}  // namespace tractus
