/// `tractus-rig`: simulates the electronics and mechanics of the probing rig.
#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <memory>

#include "core/json.hpp"
#include "core/try.hpp"
#include "station/rig/modbus_peer.hpp"

namespace tractus {
namespace {

constexpr const char* kExamples = R"(Examples:
  tractus-rig                                   Modbus TCP on 127.0.0.1:1502
  tractus-rig --port 0 --surgeon --seed 7       a free port, printed; a SIMULATED surgeon pushes
  tractus-rig --port 0 --surgeon --bus-clock    faster than real time: the bus is the clock
  tractus-rig --rtu /dev/ttyUSB0 --baud 115200  on a serial line as well
Registers: station/devices/rig-registers.md. Nothing here is a machine: all it says is simulated.)";

struct Options {
  std::string address = "127.0.0.1", rtu, specimen;
  int port = 1502, baud = 115200;
  std::uint64_t seed = 1;
  double travel_m = 0.1, skill = 0.5, duration_s = 0.0;
  bool surgeon = false, json = false, bus_clock = false, until_eof = false;
};

constexpr core::Instant_ns kIdle_ns = 20'000'000;
std::atomic<bool> asked_to_stop = false;

/// Requests real-time scheduling for this thread and for threads it starts, because electronics do
/// not wait for other programs. The program continues if the system refuses it.
void become_urgent() {
  const sched_param priority{.sched_priority = 70};
  static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority));
}

/// Whether standard input has ended, because the parent process closed it or died.
bool input_ended() {
  pollfd input{STDIN_FILENO, POLLIN, 0};
  if (::poll(&input, 1, 0) <= 0) return false;
  char byte = 0;
  return ::read(STDIN_FILENO, &byte, 1) <= 0;
}

void add(CLI::App& app, Options& o) {
  app.add_option("--address", o.address, "IPv4 address to listen on")->capture_default_str();
  app.add_option("--port", o.port, "TCP port to listen on; 0: a free port is chosen")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  app.add_option("--rtu", o.rtu, "serial device for Modbus RTU, in addition to TCP");
  app.add_option("--baud", o.baud,
                 "baud rate of the serial line (8 data bits, even parity, 1 stop bit), in bit/s")
      ->check(CLI::IsMember({9600, 19200, 38400, 57600, 115200}))
      ->capture_default_str();
  app.add_option("--seed", o.seed,
                 "seed of the random numbers for sensor noise, bias and the simulated surgeon")
      ->capture_default_str();
  app.add_option("--travel", o.travel_m, "travel of the linear axis, in metres")
      ->check(CLI::Range(0.01, 0.3))
      ->capture_default_str();
  app.add_flag("--surgeon", o.surgeon,
               "a SIMULATED surgeon pushes and turns while the drive is enabled");
  app.add_option("--skill", o.skill, "skill of the simulated surgeon, 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->capture_default_str();
  app.add_option("--specimen", o.specimen,
                 "file of a SIMULATED material in front of the probe, tractus-specimen/1");
  app.add_option("--duration", o.duration_s,
                 "time after which the program ends, in seconds; 0: it runs until it is stopped")
      ->check(CLI::Range(0.0, 1e6))
      ->capture_default_str();
  app.add_flag("--bus-clock", o.bus_clock,
               "simulated time advances by 1 ms with every command, so that the simulation can be "
               "faster than real time");
  app.add_flag("--until-eof", o.until_eof,
               "end when standard input ends, that is, when the parent process ends");
  app.add_flag("--json", o.json, "print one JSON document per line on standard output");
}

void say_ready(const Options& o, int port) {
  if (o.json)
    fmt::print(
        "{}\n",
        core::Json{{"address", o.address}, {"port", port}, {"rtu", o.rtu}, {"simulated", true}}
            .dump());
  else
    fmt::print("tractus-rig: Modbus TCP on {}:{}{}{}, SIMULATED\n", o.address, port,
               o.rtu.empty() ? "" : ", RTU on ", o.rtu);
  std::fflush(stdout);
}

void say_end(const Options& o, const rig::Traffic& t, std::uint64_t stalls) {
  if (o.json)
    fmt::print("{}\n", core::Json{{"answered", t.answered.load()},
                                  {"refused", t.refused.load()},
                                  {"garbage", t.garbage.load()},
                                  {"stalls", stalls}}
                           .dump());
  else
    fmt::print("{} requests answered, {} refused, {} invalid; {} stalls of the simulation\n",
               t.answered.load(), t.refused.load(), t.garbage.load(), stalls);
}

core::Result<int> run(const Options& o) {
  core::MonotonicClock clock;
  rig::MachineParameters machine;
  machine.seed = o.seed;
  machine.linear.travel_m = o.travel_m;
  machine.surgeon = rig::SurgeonParameters::of_skill(o.skill);
  if (!o.specimen.empty())
    machine.specimen =
        TRY(rig::Specimen::from_json(TRY(core::read_json(o.specimen)), o.specimen + ": "));
  rig::World world;
  world.surgeon = o.surgeon;
  if (!o.bus_clock) become_urgent();
  auto made = o.bus_clock ? std::make_unique<rig::Electronics>(machine, world)
                          : std::make_unique<rig::Electronics>(machine, world, clock);
  rig::Electronics& electronics = *made;
  rig::Traffic traffic;
  auto tcp = TRY(rig::listen_tcp(electronics, traffic, o.address, o.port));
  std::unique_ptr<rig::ModbusPeer> serial;
  if (!o.rtu.empty()) {
    auto rtu = TRY(rig::open_rtu(electronics, traffic, o.rtu, o.baud));
    serial = std::move(rtu);
  }
  say_ready(o, tcp->port());
  const core::Instant_ns start = clock.now();
  core::Instant_ns next = start;
  while (!asked_to_stop && !(o.until_eof && input_ended()) &&
         (o.duration_s <= 0.0 || 1e-9 * double(next - start) < o.duration_s)) {
    electronics.advance();
    next = std::max(next + (o.bus_clock ? kIdle_ns : 1'000'000), clock.now());
    clock.sleep_until(next);
  }
  say_end(o, traffic, electronics.stalls());
  return 0;
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  Options options;
  CLI::App app("Simulates the electronics and physics of the probing rig as a Modbus server",
               "tractus-rig");
  app.set_version_flag("--version", TRACTUS_VERSION);
  app.footer(kExamples);
  add(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& failure) {
    if (failure.get_exit_code() == 0) return app.exit(failure);
    std::fprintf(stderr, "tractus-rig: %s (see --help)\n", failure.what());
    return 2;
  }
  std::signal(SIGINT, [](int) { asked_to_stop = true; });
  std::signal(SIGTERM, [](int) { asked_to_stop = true; });
  std::signal(SIGPIPE, SIG_IGN);
  const auto outcome = run(options);
  if (outcome) return *outcome;
  std::fprintf(stderr, "tractus-rig: %s\n", outcome.error().what.c_str());
  return 2;
}
