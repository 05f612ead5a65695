#include "station/safety/machine.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <set>
#include <vector>

namespace tractus {
namespace safety {
namespace {

/// Small enough that every state can be visited, large enough that each counter counts.
constexpr core::Instant_ns kPeriod = 10;
constexpr Timing kSmall{
    .quiet_ticks = 3, .ramp_ns = 40, .stale_latch_ns = 30, .when_stale = Fault::stale};

/// One thing that may happen to a machine: a person's deed, or a tick.
struct Input {
  enum class Kind { arm, disarm, tick } kind = Kind::tick;
  core::Instant_ns elapsed = kPeriod;
  TickInput seen;
};

/// Everything: deeds, and ticks of every fault × fresh or not × ready or not × punctual, late,
/// twice the same instant, or after a stall.
std::vector<Input> every_input() {
  std::vector<Input> out{{Input::Kind::arm, 0, {}}, {Input::Kind::disarm, 0, {}}};
  for (const core::Instant_ns elapsed : {0, 10, 25, 1000})
    for (int fault = 0; fault < kFaults; ++fault)
      for (const bool fresh : {false, true})
        for (const bool ready : {false, true})
          out.push_back({Input::Kind::tick, elapsed, {Fault(fault), fresh, ready}});
  return out;
}

struct Outcome {
  Machine after;
  std::optional<double> share;  ///< of a tick
};

Outcome apply(Machine machine, const Input& input) {
  if (input.kind == Input::Kind::arm) machine.arm();
  if (input.kind == Input::Kind::disarm) machine.disarm();
  if (input.kind != Input::Kind::tick) return {machine, std::nullopt};
  const double share = machine.tick(input.elapsed, input.seen);
  return {machine, share};
}

/// The machine and the share it gave last: what the promises are about.
struct Node {
  Machine machine;
  double share = 0.0;
  auto key() const { return std::pair(machine.memory(), share); }
};

/// Every state that any sequence of inputs, of any length, leads to: breadth first, each visited
/// once. `check` sees every step out of each.
template <class Check>
std::size_t explore(const Timing& timing, const Check& check) {
  const std::vector<Input> inputs = every_input();
  std::vector<Node> frontier{{Machine(timing), 0.0}};
  std::set<decltype(frontier[0].key())> seen{frontier[0].key()};
  while (!frontier.empty()) {
    std::vector<Node> next;
    for (const Node& node : frontier)
      for (const Input& input : inputs) {
        const Outcome outcome = apply(node.machine, input);
        check(node, input, outcome);
        const Node reached{outcome.after, outcome.share.value_or(0.0)};
        if (seen.insert(reached.key()).second) next.push_back(reached);
      }
    frontier = std::move(next);
    if (seen.size() > 1'000'000) break;
  }
  return seen.size();
}

TEST(SafetyMachine, GivesNothingInTheVeryTickOfAnyFaultWhateverCameBefore) {
  const std::size_t states = explore(kSmall, [](const Node&, const Input& in, const Outcome& out) {
    if (in.kind != Input::Kind::tick || in.seen.fault == Fault::none) return;
    ASSERT_EQ(*out.share, 0.0);
    const State to = out.after.state();
    ASSERT_TRUE(to == State::latched || to == State::off);
  });
  EXPECT_GT(states, 100u);      // the exploration did go somewhere
  EXPECT_LT(states, 100'000u);  // and came to its end
}

TEST(SafetyMachine, OnlyAPersonLeadsOutOfOffAndLatched) {
  explore(kSmall, [](const Node& from, const Input& in, const Outcome& out) {
    const State was = from.machine.state();
    if (was != State::latched && was != State::off) return;
    if (in.kind == Input::Kind::arm) {
      ASSERT_EQ(out.after.state(), State::waiting);
      return;
    }
    ASSERT_TRUE(out.after.state() == was || out.after.state() == State::off);
    ASSERT_EQ(out.share.value_or(0.0), 0.0);
  });
}

TEST(SafetyMachine, APersonStartsFromNothingAndTheFaultIsForgotten) {
  explore(kSmall, [](const Node&, const Input& in, const Outcome& out) {
    if (in.kind != Input::Kind::arm) return;
    const Machine::Memory fresh{.state = State::waiting};
    ASSERT_EQ(out.after.memory(), fresh);
  });
}

TEST(SafetyMachine, TheShareNeverGrowsFasterThanTheRamp) {
  explore(kSmall, [](const Node& from, const Input& in, const Outcome& out) {
    if (!out.share) return;
    ASSERT_GE(*out.share, 0.0);
    ASSERT_LE(*out.share, 1.0);
    if (from.machine.state() == State::on) return;  // reached: what leaves is slewed by the limiter
    const double grown = double(in.elapsed) / double(kSmall.ramp_ns);
    const double reached = double(from.machine.memory().ramped_ns) / double(kSmall.ramp_ns);
    ASSERT_LE(*out.share, reached + grown + 1e-12);
  });
}

TEST(SafetyMachine, GivesNothingWithoutAFreshSampleAndLatchesWhenItStaysSo) {
  explore(kSmall, [](const Node& from, const Input& in, const Outcome& out) {
    if (in.kind != Input::Kind::tick || in.seen.fresh) return;
    ASSERT_EQ(*out.share, 0.0);
    const bool long_silent = from.machine.memory().silent_ns + in.elapsed > kSmall.stale_latch_ns;
    const State was = from.machine.state();
    if (!long_silent || was == State::off || was == State::latched) return;
    ASSERT_EQ(out.after.state(), State::latched);
    ASSERT_EQ(out.after.fault(), in.seen.fault == Fault::none ? Fault::stale : in.seen.fault);
  });
}

TEST(SafetyMachine, KeepsTheFirstFaultUntilAPersonArms) {
  explore(kSmall, [](const Node& from, const Input& in, const Outcome& out) {
    if (from.machine.state() != State::latched || in.kind != Input::Kind::tick) return;
    ASSERT_NE(from.machine.fault(), Fault::none);
    ASSERT_EQ(out.after.fault(), from.machine.fault());
  });
}

TEST(SafetyMachine, FromEveryStateAPersonAndAQuietMomentLeadToOn) {
  explore(kSmall, [](const Node& from, const Input& in, const Outcome&) {
    if (in.kind != Input::Kind::arm) return;  // once a state
    Machine machine = from.machine;
    machine.arm();
    double share = 0.0;
    for (int tick = 0; tick < 3 + 4; ++tick) share = machine.tick(kPeriod, {});
    ASSERT_EQ(machine.state(), State::on);
    ASSERT_EQ(share, 1.0);
  });
}

TEST(SafetyMachine, NeedsTheQuietMomentInOnePiece) {
  Machine machine(kSmall);
  machine.arm();
  for (int k = 0; k < 50; ++k) {
    machine.tick(kPeriod, {});
    machine.tick(kPeriod, {});
    machine.tick(kPeriod, {.ready = false});
  }
  EXPECT_EQ(machine.state(), State::waiting);
}

// The table alone, without the counters: every state × every event.
TEST(SafetyTable, NoEventButArmLeavesLatchedOrOffForAStateThatGivesAnything) {
  for (int event = 0; event < kEvents; ++event)
    for (const State from : {State::off, State::latched}) {
      const Step step = kTable[std::size_t(from)][std::size_t(event)];
      EXPECT_EQ(step.output, Output::zero);
      if (Event(event) == Event::arm) continue;
      EXPECT_TRUE(step.to == from || step.to == State::off);
    }
}

TEST(SafetyTable, FaultsStaleTicksAndPersonsGiveNothingInAnyState) {
  for (int state = 0; state < kStates; ++state)
    for (const Event event : {Event::arm, Event::disarm, Event::fault, Event::stale})
      EXPECT_EQ(kTable[std::size_t(state)][std::size_t(event)].output, Output::zero);
}

TEST(SafetyFault, EachHasItsOwnLineForAPerson) {
  std::set<std::string> lines;
  for (int k = 0; k < kFaults; ++k) lines.insert(text_of(Fault(k)));
  EXPECT_EQ(lines.size(), std::size_t(kFaults));
}

}  // namespace
}  // namespace safety
}  // namespace tractus
