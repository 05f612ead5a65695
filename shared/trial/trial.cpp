#include "trial/trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/bytes.hpp"
#include "core/try.hpp"

namespace tractus {
namespace trial {
namespace {
constexpr std::size_t kMaxName = 200;  // characters of a station, a device, a person
constexpr double kMaxRate_Hz = 1e5;
constexpr double kDeepest_m = 0.2;                  // of a breach that somebody felt
constexpr long kMaxUtc_us = 4'102'444'800'000'000;  // the year 2100

template <class T, std::size_t N>
bool plausible(const std::array<T, N>& values) {
  return std::ranges::all_of(values, [](T v) { return std::abs(v) <= T(kMaxMagnitude); });
}

/// What both kinds of samples must keep to.
template <class S>
std::string order_fault(const S& s, const S* before) {
  if (!std::isfinite(s.t_s) || s.t_s < 0.0 || s.t_s > kMaxTime_s)
    return fmt::format("time {} s, expected 0 … {}", s.t_s, kMaxTime_s);
  if (before && s.t_s < before->t_s)
    return fmt::format("time runs backwards from {} s to {} s", before->t_s, s.t_s);
  if (before && s.tick <= before->tick)
    return fmt::format("tick {} after tick {}, expected a later one", s.tick, before->tick);
  return {};
}

std::string number_fault(std::uint32_t tick) {
  return fmt::format("tick {} holds a number that is not finite or beyond {}", tick, kMaxMagnitude);
}

bool truth_of(core::Fields& fields, const char* key) {
  const core::Json* found = fields.member(key);
  if (!found) return false;
  if (!found->is_boolean()) return fields.wrong(key, "true or false is expected"), false;
  return found->get<bool>();
}

core::Json object_of(core::Fields& fields, const char* key) {
  const core::Json* found = fields.member(key, false);
  if (!found || found->is_null()) return core::Json::object();
  if (!found->is_object()) return fields.wrong(key, "an object is expected"), core::Json::object();
  return *found;
}
}  // namespace

std::string fault_of(const Sample& s, const Sample* before) {
  if (auto fault = order_fault(s, before); !fault.empty()) return fault;
  const bool numbers = plausible(s.p_VH_m) && plausible(s.q_VH) && plausible(s.force_N) &&
                       plausible(s.torque_Nm) && plausible(s.rendered_force_N) &&
                       plausible(s.rendered_torque_Nm) && plausible(s.deflection_m);
  if (!numbers) return number_fault(s.tick);
  const auto& q = s.q_VH;
  const double norm2 = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  if (std::abs(norm2 - 1.0) > 0.02)
    return fmt::format("tick {}: quaternion of length {:.6g}, expected 1", s.tick,
                       std::sqrt(norm2));
  return {};
}

std::string fault_of(const ProbingSample& s, const ProbingSample* before) {
  if (auto fault = order_fault(s, before); !fault.empty()) return fault;
  if (!plausible(std::array{s.x_m, s.theta_rad}) ||
      !plausible(std::array{s.speed_m_s, s.turning_rad_s, s.fz_N, s.tz_Nm, s.command_m_s,
                            s.command_Nm, s.law_m_s, s.round_trip_s}))
    return number_fault(s.tick);
  if (int(s.mode) >= kProbingModes)
    return fmt::format("tick {}: mode {}, expected 0 … {}", s.tick, int(s.mode), kProbingModes - 1);
  return {};
}

core::Json Event::to_json() const { return {{"t_s", t_s}, {"kind", kind}, {"detail", detail}}; }

core::Result<Event> Event::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  Event event;
  event.t_s = fields.number("t_s", 0.0, kMaxTime_s);
  event.kind = fields.text("kind", 64);
  if (fields.has("kind") && event.kind.empty()) fields.wrong("kind", "a word is expected");
  event.detail = object_of(fields, "detail");
  TRY(fields.done());
  return event;
}

core::Json Answer::to_json() const {
  core::Json json{{"breach", breach}, {"wall", nullptr}};
  if (wall) json["wall"] = *wall;
  if (confidence) json["confidence"] = *confidence;
  if (depth_m) json["depth_m"] = *depth_m;
  return json;
}

core::Result<Answer> Answer::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  Answer answer;
  answer.breach = truth_of(fields, "breach");
  const core::Json* wall = fields.member("wall", false);
  if (wall && !wall->is_null()) {
    answer.wall = fields.text("wall", 32);
    if (!answer.breach) fields.wrong("wall", "a wall is named without a breach");
  }
  const core::Json* confidence = fields.member("confidence", false);
  if (confidence && !confidence->is_null())
    answer.confidence = fields.number("confidence", 0.0, 1.0);
  const core::Json* depth = fields.member("depth_m", false);
  if (depth && !depth->is_null()) {
    answer.depth_m = fields.number("depth_m", 0.0, kDeepest_m);
    if (!answer.breach) fields.wrong("depth_m", "a depth is named without a breach");
  }
  TRY(fields.done());
  return answer;
}

std::optional<Answer> Trial::answer() const {
  for (auto event = events.rbegin(); event != events.rend(); ++event) {
    if (!event->is(EventKind::answer)) continue;
    auto answer = Answer::from_json(event->detail, "answer");
    if (!answer) return std::nullopt;
    return std::move(answer).value();
  }
  return std::nullopt;
}

void TickCounts::count(std::uint16_t flags) noexcept {
  ++samples;
  not_converged += (flags & kNotConverged) != 0;
  limited += (flags & kLimited) != 0;
  late += (flags & kLate) != 0;
  stale += (flags & kStale) != 0;
  saturated += (flags & kSaturated) != 0;
  missed += (flags & kMissed) != 0;
  bus_lost += (flags & kBusLost) != 0;
}

void TickCounts::add(const Block& block) {
  std::uint32_t last = 0;
  block.each([&](const auto& sample) {
    count(sample.flags);
    last = sample.tick;
  });
  if (block.size() > 0) skipped = std::uint64_t{last} + 1 - samples;
}

TickCounts count_ticks(const Block& block) {
  TickCounts out;
  out.add(block);
  return out;
}

core::Json Header::to_json() const {
  core::Json json{{"format", "tractus-trial/2"},
                  {"id", id},
                  {"case_id", case_id},
                  {"station", station},
                  {"operator", operator_name},
                  {"simulated", simulated},
                  {"device", device},
                  {"started_utc_us", started_utc_us},
                  {"rate_Hz", rate_Hz},
                  {"probe", probe},
                  {"extra", extra}};
  if (rig != Rig::palpation) json["rig"] = name(rig);
  return json;
}

core::Result<Header> Header::from_json(const core::Json& json, const std::string& where) {
  core::Fields fields(json, where);
  Header header;
  const auto format = fields.text("format", 64);
  if (fields.has("format") && format != "tractus-trial/1" && format != "tractus-trial/2")
    fields.wrong("format", "is neither \"tractus-trial/1\" nor \"tractus-trial/2\"");
  header.id = fields.text("id", 64);
  if (!core::is_id(header.id)) fields.wrong("id", "32 hexadecimal characters are expected");
  header.case_id = fields.text("case_id", 128);
  if (!core::is_sha256(header.case_id))
    fields.wrong("case_id", "64 hexadecimal characters are expected");
  header.station = fields.text("station", kMaxName);
  header.operator_name = fields.text("operator", kMaxName);
  header.simulated = truth_of(fields, "simulated");
  header.device = fields.text("device", kMaxName);
  header.started_utc_us = fields.integer("started_utc_us", 0, kMaxUtc_us);
  header.rate_Hz = fields.number("rate_Hz", 1e-3, kMaxRate_Hz);
  header.rig = fields.word_or("rig", Rig::palpation);
  header.probe = object_of(fields, "probe");
  header.extra = object_of(fields, "extra");
  TRY(fields.done());
  return header;
}

}  // namespace trial
}  // namespace tractus
