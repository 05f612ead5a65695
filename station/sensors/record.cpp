#include "station/sensors/record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <thread>

#include "core/file.hpp"
#include "core/json.hpp"

namespace sensors {
namespace {
using core::Errc;
using core::Error;

constexpr int kWait_ms = 50;
constexpr std::size_t kMostBytes = 2ull << 30;

/// What one of the two readers gathered.
struct Gathered {
  std::string rows;
  std::uint64_t count = 0;
  std::optional<Error> error;
};

void gather_force(NetFtStream& stream, const NetFtCalibration& by, core::Instant_ns start,
                  const std::atomic<bool>& stop, Gathered& out, std::uint64_t& faulty) {
  core::MonotonicClock clock;
  double last_s = -1.0;
  out.rows = "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm\n";
  while (!stop && out.rows.size() < kMostBytes) {
    const auto record = stream.next(kWait_ms);
    if (!record) continue;
    if (record->status & 0x80000000u) {  // the sensor says that this sample is no good
      ++faulty;
      continue;
    }
    double t_s = 1e-9 * double(clock.now() - start);
    if (t_s <= last_s) t_s = last_s + 1e-7;  // two that came in one go
    last_s = t_s;
    const math::Wrench w = wrench_of(*record, by);
    out.rows += fmt::format("{:.7f},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n", t_s,
                            w.force_N.x(), w.force_N.y(), w.force_N.z(), w.torque_Nm.x(),
                            w.torque_Nm.y(), w.torque_Nm.z());
    ++out.count;
  }
}

/// Bodies of one instant make one row; a body that is not in it is written as not seen.
class MotionRows {
 public:
  explicit MotionRows(const std::vector<std::string>& bodies) : bodies_(bodies) {
    rows = "t_s";
    for (const std::string& b : bodies)
      rows += fmt::format(",{0}.px_m,{0}.py_m,{0}.pz_m,{0}.qw,{0}.qx,{0}.qy,{0}.qz", b);
    rows += "\n";
  }
  void take(const TrackedPose& seen, double arrived_s) {
    if (std::ranges::find(bodies_, seen.body) == bodies_.end()) return;
    const bool stamped = seen.stamp_s > 0.0;
    if (stamped && first_stamp_s_ == 0.0) first_stamp_s_ = seen.stamp_s;
    const double t_s = stamped ? seen.stamp_s - first_stamp_s_ : arrived_s;
    const bool another = stamped ? t_s != t_s_ : held_.contains(seen.body);
    if (another) flush();
    t_s_ = t_s;
    held_[seen.body] = seen.X_CB;
  }
  void flush() {
    if (held_.empty() || t_s_ <= last_s_) {
      held_.clear();
      return;
    }
    last_s_ = t_s_;
    rows += fmt::format("{:.7f}", t_s_);
    for (const std::string& b : bodies_) {
      const auto at = held_.find(b);
      if (at == held_.end()) {
        rows += ",0,0,0,0,0,0,0";
        continue;
      }
      const auto& [p, q] = at->second;
      rows += fmt::format(",{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", p.x(), p.y(), p.z(),
                          q.w(), q.x(), q.y(), q.z());
    }
    rows += "\n";
    held_.clear();
    ++count;
  }
  std::string rows;
  std::uint64_t count = 0;

 private:
  const std::vector<std::string>& bodies_;
  std::map<std::string, math::Pose> held_;
  double t_s_ = 0.0, last_s_ = -1e300, first_stamp_s_ = 0.0;
};

void gather_motion(IgtlStream& stream, const std::vector<std::string>& bodies,
                   core::Instant_ns start, const std::atomic<bool>& stop, Gathered& out) {
  core::MonotonicClock clock;
  MotionRows rows(bodies);
  while (!stop && rows.rows.size() < kMostBytes) {
    auto seen = stream.next(kWait_ms);
    if (!seen) {
      out.error = seen.error();
      break;
    }
    for (const TrackedPose& pose : *seen) rows.take(pose, 1e-9 * double(clock.now() - start));
  }
  rows.flush();
  out.rows = std::move(rows.rows);
  out.count = rows.count;
}

core::Json recipe_of(const RecordSetup& setup) {
  const core::Json identity = {{"p_m", {0, 0, 0}}, {"q", {1, 0, 0, 0}}};
  core::Json out = {{"format", "tractus-assembly/1"},
                    {"rig", "palpation"},
                    {"tool", {{"body", setup.bodies[0]}, {"X_BH", identity}}}};
  if (setup.bodies.size() > 1) out["bone"] = {{"body", setup.bodies[1]}, {"X_BV", identity}};
  out["sensor"] = {{"X_HS", identity}, {"says", "on_probe"}};
  out["tip_z_m"] = 0.13;
  out["trials"] = core::Json::array(
      {{{"id", "trial1"}, {"motion", "motion.csv"}, {"force", "force.csv"}, {"operator", ""}}});
  return out;
}

core::Result<void> write_all(const RecordSetup& setup, const std::filesystem::path& folder,
                             const Gathered& force, const Gathered& motion) {
  auto scratch = core::ScratchFolder::make(folder);
  if (!scratch) return scratch.error();
  const auto& at = scratch->path();
  if (auto done = core::write_file(at / "force.csv", core::bytes_of(force.rows)); !done)
    return done;
  if (auto done = core::write_file(at / "motion.csv", core::bytes_of(motion.rows)); !done)
    return done;
  if (auto done = core::write_json(at / "assembly.json", recipe_of(setup)); !done) return done;
  return scratch->keep_as(folder);
}
}  // namespace

core::Result<Recorded> record(const RecordSetup& setup, const std::filesystem::path& folder,
                              const std::function<bool(double)>& progress) {
  core::require(!setup.bodies.empty(), "a recording has a tool");
  if (std::filesystem::exists(folder))
    return Error{Errc::conflict, fmt::format("{}: is there already", folder.string())};
  auto calibration = ask_calibration(setup.netft_host, setup.http_port);
  if (!calibration) return calibration.error();
  auto motion = IgtlStream::open(setup.igtl_host, setup.igtl_port);
  if (!motion) return motion.error();
  auto force = NetFtStream::open(setup.netft_host, setup.netft_port);
  if (!force) return force.error();

  core::MonotonicClock clock;
  const core::Instant_ns start = clock.now();
  std::atomic<bool> stop = false;
  Gathered forces, motions;
  Recorded out{.calibration = *calibration};
  std::thread force_thread(
      [&] { gather_force(**force, *calibration, start, stop, forces, out.force_faulty); });
  std::thread motion_thread([&] { gather_motion(**motion, setup.bodies, start, stop, motions); });
  double elapsed_s = 0.0;
  while (elapsed_s < setup.for_s) {
    clock.sleep_until(clock.now() + 30'000'000);
    elapsed_s = 1e-9 * double(clock.now() - start);
    if (progress && !progress(elapsed_s / setup.for_s)) break;
  }
  stop = true;
  force_thread.join();
  motion_thread.join();
  out.force_samples = forces.count, out.force_lost = (*force)->lost();
  out.motion_rows = motions.count, out.motion_damaged = (*motion)->damaged();
  out.duration_s = elapsed_s;
  if (forces.count < 2)
    return Error{Errc::unavailable,
                 fmt::format("the force sensor at {} sent nothing", setup.netft_host)};
  if (motions.count < 2)
    return motions.error ? *motions.error
                         : Error{Errc::unavailable,
                                 fmt::format("the motion capture at {} sent nothing of '{}'",
                                             setup.igtl_host, setup.bodies[0])};
  if (auto written = write_all(setup, folder, forces, motions); !written) return written.error();
  return out;
}

}  // namespace sensors
