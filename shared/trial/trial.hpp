/// A trial: one attempt at a case, as it was recorded.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/json.hpp"
#include "core/named.hpp"
#include "core/probing_mode.hpp"
#include "math/geometry.hpp"

namespace tractus::trial {

/// One tick of a palpation trial. 136 bytes, little-endian, no padding: also the layout on disk
/// (ADR-0004).
struct Sample {
  double t_s = 0.0;                        ///< since the trial's start, one monotonic clock
  std::array<double, 3> p_VH_m{};          ///< handle frame's origin in V
  std::array<double, 4> q_VH{1, 0, 0, 0};  ///< handle frame's orientation in V: w, x, y, z
  std::array<float, 3>
      force_N{};  ///< what the bone does to the probe by the model, at the origin of H, in H
  std::array<float, 3> torque_Nm{};
  std::array<float, 3> rendered_force_N{};  ///< what the limiter let through to the device
  std::array<float, 3> rendered_torque_Nm{};
  std::array<float, 2> deflection_m{};  ///< δ of the tip, in H
  std::uint32_t tick = 0;               ///< counts from 0; a gap is a tick that was skipped
  std::uint16_t iterations = 0;         ///< of the equilibrium
  std::uint16_t flags = 0;              ///< Flag bits
  /// Of a trial that drills: changes of the field that this tick's force has felt, in their order.
  std::uint32_t patches = 0;
  std::uint32_t reserved1 = 0;

  math::Pose pose() const {
    return {{p_VH_m[0], p_VH_m[1], p_VH_m[2]}, {q_VH[0], q_VH[1], q_VH[2], q_VH[3]}};
  }
};
static_assert(sizeof(Sample) == 136);

/// The two simulators. A trial is of one of them and holds its kind of samples alone.
enum class Rig : std::uint8_t { palpation, probing };
constexpr auto words(Rig) {
  return std::to_array<core::Word<Rig>>({{Rig::palpation, "palpation"}, {Rig::probing, "probing"}});
}

using core::kProbingModes;
using core::name;
using core::ProbingMode;

/// One tick of a probing trial: what was read in one exchange with the rig, and what was commanded
/// for the next period. 64 bytes, little-endian, no padding: also the layout on disk.
struct ProbingSample {
  double t_s = 0.0;            ///< since the trial's start, one monotonic clock
  double x_m = 0.0;            ///< depth of the tip from the entry, positive into the bone
  double theta_rad = 0.0;      ///< angle about x, unwrapped
  float speed_m_s = 0.0f;      ///< of the depth, the actuator's own
  float turning_rad_s = 0.0f;  ///< of the angle
  float fz_N = 0.0f;           ///< push of the hand on the probe along x, positive into the bone
  float tz_Nm = 0.0f;          ///< torque of the hand on the probe about x
  float command_m_s = 0.0f;    ///< speed that was commanded, within the safety's limits
  float command_Nm = 0.0f;     ///< torque of the rotary motor that was commanded
  float law_m_s = 0.0f;        ///< speed that the law asked for
  float round_trip_s = 0.0f;   ///< of this tick's exchange over the bus; 0 when there was none
  std::uint32_t tick = 0;      ///< counts from 0; a gap is a period that was missed altogether
  std::uint16_t flags = 0;     ///< Flag bits
  ProbingMode mode = ProbingMode::holding;
  std::uint8_t fault = 0;  ///< the rig's own fault code (station/devices/rig-registers.md)
};
static_assert(sizeof(ProbingSample) == 64);

enum Flag : std::uint16_t {
  kNotConverged = 1,  ///< palpation: the equilibrium was not reached
  kLimited = 2,       ///< the limiter changed the wrench, or the commanded speed or torque
  kLate = 4,          ///< this tick woke more than a quarter period late
  kStale = 8,         ///< no fresh sample of the device: the last one stands, nothing was rendered
  kSaturated = 16,    ///< the device reports that it could not give what was asked
  kMissed = 32,       ///< probing: the exchange ended after the next period had begun
  kBusLost = 64,      ///< probing: the exchange failed
  kPressed = 128,     ///< palpation: the device's first button was held
};

/// Samples in order, of one rig: the other's span is empty.
struct Block {
  std::span<const Sample> palpation;
  std::span<const ProbingSample> probing;

  std::size_t size() const { return palpation.size() + probing.size(); }
  /// What both kinds have (t_s, tick, flags), in order: `take` is called with each sample.
  template <class Take>
  void each(Take&& take) const {
    for (const Sample& sample : palpation) take(sample);
    for (const ProbingSample& sample : probing) take(sample);
  }
};

/// The events that this version writes.
enum class EventKind {
  start,
  headset,  ///< what the headset counted
  retuned,  ///< an expert changed the law
  drilled,
  answer,
  end,
  fault,
  interrupted,  ///< the file was left open, and closed by another process
};
constexpr auto words(EventKind) {
  using enum EventKind;
  return std::to_array<core::Word<EventKind>>({{start, "start"},
                                               {headset, "headset"},
                                               {retuned, "retuned"},
                                               {drilled, "drilled"},
                                               {answer, "answer"},
                                               {end, "end"},
                                               {fault, "fault"},
                                               {interrupted, "interrupted"}});
}

/// Something that happened at a time.
struct Event {
  double t_s = 0.0;
  std::string kind;                          ///< the word of an EventKind; a file may hold others
  core::Json detail = core::Json::object();  ///< object; for an answer see Answer

  static Event of(double t_s, EventKind kind, core::Json detail = core::Json::object()) {
    return {t_s, std::string(core::name(kind)), std::move(detail)};
  }
  bool is(EventKind wanted) const { return kind == core::name(wanted); }

  core::Json to_json() const;
  /// Errors: bad_input naming `where` and the field.
  static core::Result<Event> from_json(const core::Json& json, const std::string& where);
};

/// What the trainee said: {"breach": bool, "wall": "medial"|…|null, "confidence": 0…1,
/// "depth_m": 0…0.2}; all but the first may be missing.
struct Answer {
  bool breach = false;
  std::optional<std::string> wall;     ///< palpation: name of a volume::Wall; only with a breach
  std::optional<double> confidence;    ///< 0 … 1
  std::optional<double> depth_m = {};  ///< probing: where it was felt; only with a breach

  core::Json to_json() const;
  static core::Result<Answer> from_json(const core::Json& json, const std::string& where);
};

/// What is known before the first sample.
struct Header {
  std::string id;             ///< core::new_id()
  std::string case_id;        ///< content id of the case or of the scenario, SHA-256
  std::string station;        ///< its name
  std::string operator_name;  ///< who; "simulated hand, seed 7" for a simulated one
  bool simulated = false;     ///< true when a simulated device stood in for hand and machine
  std::string device;         ///< "sim-lambda6", …
  std::int64_t started_utc_us = 0;
  double rate_Hz = 4000.0;
  Rig rig = Rig::palpation;
  core::Json probe = core::Json::object();  ///< palpation: length_m, radius_m, points,
                                            ///< point_spacing_m, pose_offset_m of the model that
                                            ///< ran; probing: travel_m of the scenario
  core::Json extra = core::Json::object();  ///< anything further a later version knows

  core::Json to_json() const;
  /// Errors: bad_input naming `where` and the field: an id or case_id of the wrong shape, an
  /// unknown field, …
  static core::Result<Header> from_json(const core::Json& json, const std::string& where);
};

/// Everything, in memory.
struct Trial {
  Header header;
  std::vector<Sample> samples;         ///< of palpation, in order of tick
  std::vector<ProbingSample> probing;  ///< of probing, in order of tick
  std::vector<Event> events;           ///< in order of time
  bool complete = false;  ///< an "end" event was recorded and the file sealed; false after a crash
  bool sealed = false;    ///< the end frame is there and its hash holds: nothing can follow

  Block block() const { return {samples, probing}; }
  /// The last answer that was given; nothing when there was none, or when it cannot be understood.
  std::optional<Answer> answer() const;
};

/// The largest time a trial may hold, s (eleven days): what is beyond is a broken clock.
inline constexpr double kMaxTime_s = 1e6;
/// The largest position, force, torque or deflection a sample may hold, in its unit.
inline constexpr double kMaxMagnitude = 1e6;

/// What is wrong with `sample` after `before` (null for the first): a number that is not finite, a
/// time outside 0 … kMaxTime_s or running backwards, a tick that does not increase, a quaternion
/// that is no rotation. Empty if nothing.
std::string fault_of(const Sample& sample, const Sample* before);
/// Likewise; also a mode that is none.
std::string fault_of(const ProbingSample& sample, const ProbingSample* before);

/// How the loop that recorded the samples fared: counted by the loop itself as it runs, and again
/// by a reader of its samples.
struct TickCounts {
  std::uint64_t samples = 0;
  std::uint64_t limited = 0, late = 0, stale = 0;
  std::uint64_t not_converged = 0, saturated = 0;  ///< palpation alone
  std::uint64_t missed = 0, bus_lost = 0;          ///< probing alone
  std::uint64_t skipped = 0;  ///< ticks from 0 to the last one that left no sample

  /// One sample more, by its Flag bits. Real-time safe.
  void count(std::uint16_t flags) noexcept;
  /// Blocks of one trial, in order.
  void add(const Block& block);
};
TickCounts count_ticks(const Block& block);

}  // namespace tractus::trial
