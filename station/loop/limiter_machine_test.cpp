/// The limiter and the rig's guard themselves, every sequence of stimuli from every state.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "station/loop/limiter.hpp"
#include "station/loop/probing_guard.hpp"

namespace tractus {
namespace loop {
namespace {
using devices::Sample;
using devices::Status;
using math::Vec3;
using math::Wrench;

constexpr core::Instant_ns kMachinePeriod = 250'000;

/// What may happen in a tick, and the fault it is if it is one.
struct Stimulus {
  const char* name;
  Fault fault = Fault::none;
  bool stale = false, arm = false;
  core::Instant_ns elapsed = kMachinePeriod;
  void (*spoil)(Sample&, Status&, Wrench&) = [](Sample&, Status&, Wrench&) {};
};

std::vector<Stimulus> stimuli() {
  std::vector<Stimulus> out(13);
  out[0] = {.name = "push"};
  out[1] = {.name = "other way",
            .spoil = [](Sample&, Status&, Wrench& w) { w.force_N = -w.force_N; }};
  out[2] = {.name = "late", .elapsed = 6 * kMachinePeriod};
  out[3] = {.name = "arm", .arm = true};
  out[4] = {.name = "stale", .stale = true, .spoil = [](Sample&, Status& s, Wrench&) {
              s = Status::stale;
            }};
  out[5] = {.name = "stalled",
            .fault = Fault::stale,
            .stale = true,
            .elapsed = 21'000'000,
            .spoil = [](Sample&, Status& s, Wrench&) { s = Status::stale; }};
  out[6] = {.name = "NaN", .fault = Fault::not_finite, .spoil = [](Sample&, Status&, Wrench& w) {
              w.torque_Nm.x() = std::nan("");
            }};
  out[7] = {.name = "speed", .fault = Fault::speed, .spoil = [](Sample& s, Status&, Wrench&) {
              s.velocity_m_s.z() = 2.5;
            }};
  out[8] = {.name = "device", .fault = Fault::device, .spoil = [](Sample&, Status& s, Wrench&) {
              s = Status::fault;
            }};
  out[9] = {.name = "unplugged",
            .fault = Fault::unplugged,
            .spoil = [](Sample&, Status& s, Wrench&) { s = Status::gone; }};
  out[10] = {.name = "forces off",
             .fault = Fault::forces_off,
             .spoil = [](Sample&, Status& s, Wrench&) { s = Status::forces_off; }};
  out[11] = {.name = "huge", .spoil = [](Sample&, Status&, Wrench& w) { w.force_N *= 1e6; }};
  out[12] = {.name = "quiet", .spoil = [](Sample&, Status&, Wrench& w) { w = {}; }};
  return out;
}

/// A limiter on its way, and what a bystander knows of it.
struct Walk {
  Limiter limiter;
  core::Instant_ns now = 1'000'000'000;
  Vec3 force = Vec3::Zero();

  /// False when a promise was broken; says which.
  bool take(const Stimulus& s, std::string& why) {
    const Guard was = limiter.guard();
    if (s.arm) {
      limiter.arm();
      force.setZero();
    }
    const Guard before = limiter.guard();
    now += s.elapsed;
    Sample sample;
    sample.stamp = now;
    Status status = Status::ok;
    Wrench wanted{{3.0, 0, 0}, {0, 0.05, 0}};
    s.spoil(sample, status, wanted);
    const Limiter::Passed out = limiter.pass(now, status, sample, wanted);
    const bool zero = out.wrench.force_N.isZero(0.0) && out.wrench.torque_Nm.isZero(0.0);
    const HandLimits& most = limiter.limits();
    const double dt_s = double(std::min(s.elapsed, 2 * kMachinePeriod)) * 1e-9 + 1e-9;
    const double change_N = (out.wrench.force_N - force).norm();
    force = out.wrench.force_N;
    if ((s.fault != Fault::none || s.stale) && !zero) return why = "force in a bad tick", false;
    if (s.fault != Fault::none && before != Guard::off && limiter.guard() != Guard::latched)
      return why = "a fault did not latch", false;
    if (!s.arm && was == Guard::latched && limiter.guard() != Guard::latched)
      return why = "re-enabled by itself", false;
    if (!s.arm && was == Guard::off && limiter.guard() != Guard::off)
      return why = "enabled by itself", false;
    if (limiter.guard() == Guard::latched && !zero) return why = "force after a fault", false;
    if (!(force.norm() <= most.max_force_N && out.wrench.torque_Nm.norm() <= most.max_torque_Nm))
      return why = "above the clamp", false;
    if (!zero && change_N > most.max_force_slew_N_per_s * dt_s)
      return why = "faster than the slew", false;
    return true;
  }
};

Walk fresh(Guard state) {
  HandLimits limits;
  limits.ramp_s = 0.2;
  Walk walk{Limiter(limits, kMachinePeriod)};
  std::string why;
  const std::vector<Stimulus> all = stimuli();
  if (state == Guard::off) return walk;
  walk.limiter.arm();
  const int ticks = state == Guard::waiting ? 1 : state == Guard::ramping ? 100 : 1000;
  for (int k = 0; k < ticks; ++k) walk.take(all[12], why);
  if (state == Guard::latched) walk.limiter.fail(Fault::device);
  EXPECT_EQ(walk.limiter.guard(), state);
  return walk;
}

/// Depth first: every sequence of `depth` stimuli, each checked at each step.
void every_sequence(const Walk& walk, const std::vector<Stimulus>& all, int depth,
                    const std::string& so_far, long& steps) {
  if (depth == 0 || testing::Test::HasFatalFailure()) return;
  for (const Stimulus& stimulus : all) {
    Walk next = walk;
    std::string why;
    ++steps;
    ASSERT_TRUE(next.take(stimulus, why)) << why << " after" << so_far << ", " << stimulus.name;
    every_sequence(next, all, depth - 1, so_far + ", " + stimulus.name, steps);
  }
}

TEST(Limiter, KeepsItsPromisesInEverySequenceOfFiveStimuliFromEveryState) {
  long steps = 0;
  for (const Guard state : {Guard::off, Guard::waiting, Guard::ramping, Guard::on, Guard::latched})
    every_sequence(fresh(state), stimuli(), 5, "", steps);
  EXPECT_EQ(steps, 5L * (13 + 169 + 2197 + 28561 + 371293));
}

/// The rig: what an exchange may give.
struct RigStimulus {
  const char* name;
  safety::Fault fault = safety::Fault::none;
  devices::Exchange how = devices::Exchange::ok;
  devices::RigReading reading;
};

std::vector<RigStimulus> rig_stimuli() {
  namespace reg = devices::rig;
  const auto faulted = [](reg::RigFault fault) {
    devices::RigReading r;
    r.x_m = 0.02;
    r.status = reg::kFaulted;
    r.fault = fault;
    return r;
  };
  devices::RigReading fine, pushed, emergency;
  fine.x_m = pushed.x_m = 0.02;
  pushed.fz_N = 185.0;
  emergency.status = reg::kEmergency;
  return {
      {"fine", safety::Fault::none, devices::Exchange::ok, fine},
      {"pushed", safety::Fault::none, devices::Exchange::ok, pushed},
      {"silent", safety::Fault::none, devices::Exchange::silent, {}},
      {"garbage", safety::Fault::garbage, devices::Exchange::garbage, {}},
      {"gone", safety::Fault::gone, devices::Exchange::gone, {}},
      {"emergency", safety::Fault::emergency, devices::Exchange::ok, emergency},
      {"watchdog", safety::Fault::none, devices::Exchange::ok, faulted(reg::RigFault::watchdog)},
      {"stalled", safety::Fault::stalled, devices::Exchange::ok, faulted(reg::RigFault::stalled)},
      {"drive", safety::Fault::drive, devices::Exchange::ok, faulted(reg::RigFault::drive)},
      {"sensor", safety::Fault::sensor, devices::Exchange::ok, faulted(reg::RigFault::sensor)}};
}

bool take(ProbingGuard& guard, const RigStimulus& s, std::string& why) {
  const bool was_latched = guard.latched();
  const safety::Fault was = guard.fault();
  const ProbingGuard::LawInput seen = guard.see(s.how, s.reading);
  const auto out = guard.pass(1.0, 1.0).command;
  const bool moves = out.speed_m_s != 0.0 || out.torque_Nm != 0.0;
  if (s.fault != safety::Fault::none && !guard.latched())
    return why = "a fault did not latch", false;
  if (was_latched && guard.fault() != was) return why = "the first fault was lost", false;
  if (guard.latched() && (moves || out.enable || out.rotary_on || out.reset_fault))
    return why = "a command after a fault", false;
  if (!seen.fresh && moves) return why = "moved without an answer", false;
  if (seen.fresh && std::abs(seen.fz_N) > 180.0 && out.speed_m_s != 0.0)
    return why = "moved under too great a push", false;
  if (moves && !guard.enabled()) return why = "moved before it was enabled", false;
  if (std::abs(out.speed_m_s) > 0.23 || std::abs(out.torque_Nm) > 0.5)
    return why = "above the limits", false;
  return true;
}

void every_sequence(const ProbingGuard& guard, const std::vector<RigStimulus>& all, int depth,
                    const std::string& so_far, long& steps) {
  if (depth == 0 || testing::Test::HasFatalFailure()) return;
  for (const RigStimulus& stimulus : all) {
    ProbingGuard next = guard;
    std::string why;
    ++steps;
    ASSERT_TRUE(take(next, stimulus, why)) << why << " after" << so_far << ", " << stimulus.name;
    every_sequence(next, all, depth - 1, so_far + ", " + stimulus.name, steps);
  }
}

TEST(ProbingGuard, KeepsItsPromisesInEverySequenceOfFiveAnswersFromEveryState) {
  const std::vector<RigStimulus> all = rig_stimuli();
  long steps = 0;
  // Before taring, in its middle, at its last tick, enabling, moving, and at its last restart.
  for (const int ticks : {0, 100, 199, 200, 400}) {
    ProbingGuard guard(RigLimits{}, 0.05, 1e-3);
    std::string why;
    for (int k = 0; k < ticks; ++k) ASSERT_TRUE(take(guard, all[0], why)) << why;
    every_sequence(guard, all, 5, "", steps);
  }
  ProbingGuard worn(RigLimits{}, 0.05, 1e-3);
  std::string why;
  for (int k = 0; k < 100'000 && worn.restarts() < ProbingGuard::kMostRestarts; ++k)
    ASSERT_TRUE(take(worn, all[k > 400 && k % 7 == 0 ? 6 : 0], why)) << why;
  every_sequence(worn, all, 5, "", steps);
  EXPECT_EQ(steps, 6L * 111110);
}

}  // namespace
}  // namespace loop
}  // namespace tractus
