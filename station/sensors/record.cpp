#include "station/sensors/record.hpp"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "station/sensors/motion_rows.hpp"
#include "station/sensors/row_file.hpp"

namespace tractus {
namespace sensors {
namespace {
using core::Errc;
using core::Error;

constexpr int kWait_ms = 50;
constexpr double kBegin_s = 5.0, kSilent_s = 2.0;
// A capture system may have nothing to say while it sees nothing.
constexpr double kSilentMotion_s = 10.0;

/// What the threads of a recording share.
struct Shared {
  core::Instant_ns start = 0;
  std::atomic<bool> stop = false;

  void end(const std::string& why) {
    const std::lock_guard lock(guard_);
    if (ended_by_.empty()) ended_by_ = why;
    stop = true;
  }
  std::string ended_by() {
    const std::lock_guard lock(guard_);
    return ended_by_;
  }
  double seconds() const { return 1e-9 * double(core::MonotonicClock().now() - start); }

 private:
  std::mutex guard_;  // of ended_by_
  std::string ended_by_;
};

/// One device into one file, on a thread of its own.
struct Gatherer {
  explicit Gatherer(RowFile to) : file(std::move(to)) {}
  RowFile file;
  std::atomic<std::uint64_t> rows = 0;
  std::thread thread;

  void add(const std::string& row) {
    file.add(row, core::MonotonicClock().now());
    ++rows;
  }
};

struct Force : Gatherer {
  Force(RowFile to, std::unique_ptr<NetFtStream> from, const NetFtCalibration& by)
      : Gatherer(std::move(to)), stream(std::move(from)), calibration(by) {}
  std::unique_ptr<NetFtStream> stream;
  NetFtCalibration calibration;
  std::uint64_t faulty = 0, saturated = 0;
  std::uint32_t worst_status = 0;

  void take(const RdtRecord& record, double arrived_s) {
    const bool beyond = is_saturated(record.status, calibration.status);
    if (is_faulty(record.status) || beyond) {
      ++faulty;
      saturated += beyond;
      worst_status |= record.status;
      return;
    }
    const math::Wrench w = wrench_of(record, calibration);
    add(fmt::format("{:.7f},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7f}\n",
                    double(stream->index()) / calibration.rate_Hz, w.force_N.x(), w.force_N.y(),
                    w.force_N.z(), w.torque_Nm.x(), w.torque_Nm.y(), w.torque_Nm.z(), arrived_s));
  }

  void run(Shared& shared) {
    double heard_s = 0.0;
    while (!shared.stop && !file.failed()) {
      const auto record = stream->next(kWait_ms);
      const double now_s = shared.seconds();
      if (!record) return shared.end(record.error().what);
      if (*record) {
        heard_s = now_s;
        take(**record, now_s);
      } else if (rows > 0 && now_s - heard_s > kSilent_s) {
        return shared.end("the force sensor fell silent");
      }
    }
    if (file.failed()) shared.end("the disk takes no more");
  }
};

struct Motion : Gatherer {
  Motion(RowFile to, std::unique_ptr<IgtlStream> from, MotionRows rows_of)
      : Gatherer(std::move(to)), stream(std::move(from)), table(std::move(rows_of)) {}
  std::unique_ptr<IgtlStream> stream;
  MotionRows table;
  std::atomic<bool> complete = false;  ///< each body was seen once

  void run(Shared& shared) {
    double heard_s = 0.0;
    std::uint64_t heard = 0;
    while (!shared.stop && !file.failed()) {
      const auto seen = stream->next(kWait_ms);
      const double now_s = shared.seconds();
      if (!seen) {
        shared.end(seen.error().what);
        break;
      }
      if (heard != stream->received()) heard = stream->received(), heard_s = now_s;
      if (now_s - heard_s > kSilentMotion_s) {
        shared.end("the motion capture fell silent");
        break;
      }
      for (const TrackedPose& pose : *seen)
        if (const auto row = table.take(pose, now_s)) add(*row);
      if (!complete && table.missing().empty()) complete = true;
    }
    if (const auto row = table.flush()) add(*row);
    if (file.failed()) shared.end("the disk takes no more");
  }
};

core::Json recipe_of(const RecordSetup& setup) {
  const core::Json identity = {{"p_m", {0, 0, 0}}, {"q", {1, 0, 0, 0}}};
  core::Json out = {
      {"format", "tractus-assembly/1"},
      {"rig", "palpation"},
      {"tool", {{"body", setup.bodies.empty() ? "probe" : setup.bodies[0]}, {"X_BH", identity}}}};
  if (setup.bodies.size() > 1) out["bone"] = {{"body", setup.bodies[1]}, {"X_BV", identity}};
  out["sensor"] = {{"X_HS", identity}, {"says", "on_probe"}};
  out["tip_z_m"] = 0.13;
  out["trials"] = core::Json::array(
      {{{"id", "trial1"}, {"motion", "motion.csv"}, {"force", "force.csv"}, {"operator", ""}}});
  return out;
}

/// The streams of a recording, and the folder that is not there yet.
struct Room {
  std::optional<core::ScratchFolder> scratch;
  std::unique_ptr<Force> force;
  std::unique_ptr<Motion> motion;

  bool begun() const {
    return (!force || force->rows > 0) && (!motion || (motion->rows > 0 && motion->complete));
  }
  void start(Shared& shared) {
    shared.start = core::MonotonicClock().now();
    if (force) force->thread = std::thread([this, &shared] { force->run(shared); });
    if (motion) motion->thread = std::thread([this, &shared] { motion->run(shared); });
  }
  void join() {
    if (force && force->thread.joinable()) force->thread.join();
    if (motion && motion->thread.joinable()) motion->thread.join();
  }
};

core::Result<Room> open_room(const RecordSetup& setup, const std::filesystem::path& folder) {
  Room out;
  std::optional<NetFtCalibration> calibration;
  std::unique_ptr<NetFtStream> force;
  std::unique_ptr<IgtlStream> motion;
  if (!setup.netft_host.empty()) {
    auto asked = TRY(ask_calibration(setup.netft_host, setup.http_port));
    calibration = asked;
  }
  if (!setup.igtl_host.empty()) {
    auto opened = TRY(IgtlStream::open(setup.igtl_host, setup.igtl_port));
    motion = std::move(opened);
  }
  if (calibration) {
    auto opened = TRY(NetFtStream::open(setup.netft_host, setup.netft_port, setup.bias));
    force = std::move(opened);
  }
  auto scratch = TRY(core::ScratchFolder::make(folder));
  out.scratch.emplace(std::move(scratch));
  if (force) {
    auto file = TRY(RowFile::make(out.scratch->path() / "force.csv",
                                  "t_s,fx_N,fy_N,fz_N,tx_Nm,ty_Nm,tz_Nm,arrived_s\n"));
    out.force = std::make_unique<Force>(std::move(file), std::move(force), *calibration);
  }
  if (motion) {
    MotionRows rows(setup.bodies);
    auto file = TRY(RowFile::make(out.scratch->path() / "motion.csv", rows.header()));
    out.motion = std::make_unique<Motion>(std::move(file), std::move(motion), std::move(rows));
  }
  return out;
}

/// Why a room has not begun, in one line.
Error not_begun(const RecordSetup& setup, const Room& room, const std::string& ended_by) {
  if (!ended_by.empty()) return {Errc::unavailable, ended_by};
  if (room.force && room.force->faulty > 0)
    return {Errc::unavailable,
            fmt::format("the force sensor says of every sample: {}",
                        status_words(room.force->worst_status, room.force->calibration.status))};
  if (room.force && room.force->rows == 0)
    return {Errc::unavailable,
            fmt::format("the force sensor at {} sends no samples", setup.netft_host)};
  std::string others;
  for (const auto& name : room.motion->table.others()) others += fmt::format(" '{}'", name);
  return {Errc::unavailable,
          fmt::format("the motion capture at {} sends nothing of '{}'; it sends{}", setup.igtl_host,
                      fmt::join(room.motion->table.missing(), "' and '"),
                      others.empty() ? " no other poses" : others)};
}

/// Waits until every stream has given something, then gives the folder its name.
core::Result<void> begin(const RecordSetup& setup, const std::filesystem::path& folder, Room& room,
                         Shared& shared) {
  core::MonotonicClock clock;
  while (!room.begun() && !shared.stop && shared.seconds() < kBegin_s)
    clock.sleep_until(clock.now() + 10'000'000);
  if (!room.begun()) {
    shared.stop = true;
    room.join();
    return not_begun(setup, room, shared.ended_by());
  }
  const auto& at = room.scratch->path();
  TRY(core::write_json(at / "assembly.json", recipe_of(setup)));
  const core::Json state = {{"format", "tractus-recording/1"}, {"state", "recording"}};
  TRY(core::write_json(at / "recording.json", state));
  return room.scratch->keep_as(folder);
}

core::Result<Recorded> finished(Room& room, Shared& shared, const std::filesystem::path& folder) {
  Recorded out;
  out.duration_s = shared.seconds();
  out.ended_by = shared.ended_by();
  if (room.force) {
    const Force& force = *room.force;
    out.force_samples = force.rows;
    out.force_lost = force.stream->lost(), out.force_late = force.stream->late();
    out.force_faulty = force.faulty, out.force_saturated = force.saturated;
    out.worst_status = force.worst_status;
    out.calibration = force.calibration;
    if (auto done = room.force->file.finish(); !done) out.ended_by = done.error().what;
  }
  if (room.motion) {
    out.motion_rows = room.motion->rows, out.motion_damaged = room.motion->stream->damaged();
    out.seen = room.motion->table.seen();
    out.complaint = room.motion->stream->complaint();
    if (auto done = room.motion->file.finish(); !done) out.ended_by = done.error().what;
  }
  // A full disk may have no room for this either; the rows are there all the same.
  if (auto done = core::write_json(folder / "recording.json", out.json()); !done)
    if (out.ended_by.empty()) return done.error();
  return out;
}
}  // namespace

core::Json Recorded::json() const {
  core::Json out = {{"format", "tractus-recording/1"},
                    {"state", "done"},
                    {"duration_s", duration_s},
                    {"ended_by", ended_by}};
  if (calibration.rate_Hz > 0.0)
    out["force"] = {{"samples", force_samples},
                    {"lost", force_lost},
                    {"late", force_late},
                    {"faulty", force_faulty},
                    {"saturated", force_saturated},
                    {"status", status_words(worst_status, calibration.status)},
                    {"product", calibration.product},
                    {"calibration", calibration.serial},
                    {"counts_per_N", calibration.counts_per_N},
                    {"counts_per_Nm", calibration.counts_per_Nm},
                    {"rate_Hz", calibration.rate_Hz}};
  if (motion_rows > 0)
    out["motion"] = {{"rows", motion_rows}, {"seen", seen}, {"damaged_messages", motion_damaged}};
  if (complaint)
    out["motion"]["complaint"] = {
        {"code", complaint->code}, {"name", complaint->name}, {"message", complaint->message}};
  return out;
}

core::Result<Recorded> record(const RecordSetup& setup, const std::filesystem::path& folder,
                              const std::function<bool(double)>& progress) {
  core::require(!setup.netft_host.empty() || !setup.igtl_host.empty(), "something is recorded");
  if (std::filesystem::exists(folder))
    return Error{Errc::conflict, fmt::format("{}: is there already", folder.string())};
  auto room = TRY(open_room(setup, folder));
  Shared shared;
  room.start(shared);
  const auto begun = begin(setup, folder, room, shared);
  core::MonotonicClock clock;
  while (begun && !shared.stop && shared.seconds() < setup.for_s) {
    clock.sleep_until(clock.now() + 30'000'000);
    if (progress && !progress(shared.seconds() / setup.for_s)) break;
  }
  shared.stop = true;
  room.join();
  if (!begun) return begun.error();
  return finished(room, shared, folder);
}

}  // namespace sensors
}  // namespace tractus
