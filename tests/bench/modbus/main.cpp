/// A station's cycle with the rig, FC 23, 6 registers out and 16 back, through the station's own
/// device and the peer with the machine's physics, against a raw TCP ping-pong of the same number
/// of bytes.
#include <fmt/core.h>

#include <functional>
#include <vector>

#include "bench/modbus/raw_ping_pong.hpp"
#include "bench/support/report.hpp"
#include "core/clock.hpp"
#include "station/devices/modbus_rig.hpp"
#include "station/rig/modbus_peer.hpp"

namespace tractus {
namespace {

namespace registers = devices::rig;

constexpr int kRequestBytes =
    7 + 1 + 9 + 2 * registers::kCommandCount;  // header, code, 23's fields
constexpr int kReplyBytes = 7 + 2 + 2 * registers::kReadingCount;
constexpr int kRounds = 8;
constexpr int kFreeCycles = 4000, kPacedCycles = 700;

using Cycle = std::function<bool()>;

/// µs of each of many cycles, back to back or one a millisecond.
bool time_cycles(const Cycle& cycle, int count, bool paced, std::vector<double>& out) {
  core::MonotonicClock clock;
  core::Instant_ns next = clock.now();
  for (int k = 0; k < count; ++k) {
    if (paced) clock.sleep_until(next += 1'000'000);
    const core::Instant_ns start = clock.now();
    if (!cycle()) return false;
    out.push_back(1e-3 * double(clock.now() - start));
  }
  return true;
}

void compare(bench::Report& report, const Cycle& modbus, const Cycle& raw, bool paced) {
  std::vector<double> ours, rival;
  const int count = paced ? kPacedCycles : kFreeCycles;
  bool all = true;
  for (int round = 0; round < kRounds; ++round)  // in turns, so that the machine's load is shared
    all = all && time_cycles(raw, count, paced, rival) && time_cycles(modbus, count, paced, ours);
  const std::string how = paced ? "one a millisecond" : "back to back";
  report.must(how + ": every cycle came back whole", all);
  for (const double share : {0.5, 0.99}) {
    report.row(fmt::format("{}, raw TCP, {:.0f} %", how, 100 * share),
               bench::quantile(rival, share), "us");
    report.row(fmt::format("{}, Modbus, {:.0f} %", how, 100 * share), bench::quantile(ours, share),
               "us");
  }
  report.at_most(how + ", median against raw TCP",
                 bench::quantile(ours, 0.5) / bench::quantile(rival, 0.5), 1.3, "x");
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  bench::Report report("modbus");
  core::MonotonicClock clock;
  rig::Electronics electronics({}, {}, clock);
  rig::Traffic traffic;
  const auto peer = rig::listen_tcp(electronics, traffic, "127.0.0.1", 0);
  const auto raw = bench::RawPingPong::open(kRequestBytes, kReplyBytes);
  if (!peer || !raw) return 2;
  auto device = devices::modbus_rig(fmt::format("127.0.0.1:{}", (*peer)->port()));
  if (!device || !(*device)->open()) return 2;
  devices::RigReading reading;
  const Cycle modbus_cycle = [&] {
    // What takes longer than the device waits for is a cycle that took so long, not a broken one.
    const auto how = (*device)->exchange({}, reading);
    return how == devices::Exchange::ok || how == devices::Exchange::silent;
  };
  const Cycle raw_cycle = [&] { return raw->cycle() == kReplyBytes; };
  compare(report, modbus_cycle, raw_cycle, false);
  compare(report, modbus_cycle, raw_cycle, true);
  report.row("stretches in which the peer was held up", double(electronics.stalls()), "");
  return report.finish(argc, argv);
}
