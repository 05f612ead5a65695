/// What this person can tell at this device: thresholds of force and of a wall's gap.
#include <fmt/format.h>
#include <unistd.h>

#include <cmath>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/presence.hpp"
#include "station/app/terminal_keys.hpp"
#include "station/check/simulated_person.hpp"
#include "station/devices/catalogue.hpp"

namespace tractus {
namespace app {
namespace {
using check::Moment;
using check::Stimulus;

/// A person at the terminal, asked by the thread that ticks and read by the one that waits.
class AtTerminal {
 public:
  check::Asked asked() {
    return {.begins =
                [this](Stimulus, Moment moment) {
                  if (moment == Moment::pause) said_ = 0;
                  moment_ = moment;
                },
            .answer = [this] { return said_.load(); }};
  }
  /// Says what has begun, and takes a key.
  void wait() {
    const Moment now = moment_;
    if (now != shown_) show(now);
    shown_ = now;
    for (auto key = typed_key(); key; key = typed_key())
      if (now == Moment::answer && (*key == '1' || *key == '2')) said_ = *key - '0';
  }

 private:
  static void show(Moment moment) {
    switch (moment) {
      case Moment::pause:
        break;
      case Moment::first:
        fmt::print(stderr, "\n  first  ");
        break;
      case Moment::second:
        fmt::print(stderr, "  second  ");
        break;
      case Moment::answer:
        fmt::print(stderr, "  which had more? 1 or 2 ");
        break;
    }
  }
  std::atomic<Moment> moment_ = Moment::pause;
  std::atomic<int> said_ = 0;
  Moment shown_ = Moment::pause;
};

const char* instruction_of(Stimulus stimulus) {
  switch (stimulus) {
    case Stimulus::detection:
      return "Hold the handle loosely in the middle. In one of two intervals it is pushed to the "
             "right, more and more faintly: say in which, 1 or 2; guess where you cannot tell.";
    case Stimulus::difference:
      return "Hold the handle against pushes to the right of a newton, twice: say which was the "
             "stronger, 1 or 2.";
    case Stimulus::gap:
      return "To the right of the handle is a wall. In each interval (3 s) press against it and "
             "stroke it down and up; one of the two has a gap: say which, 1 or 2.";
  }
  return "";
}

/// What is asked, and how its answers come.
struct Setup {
  std::unique_ptr<devices::Device> device;
  devices::Limits limits;
  check::SimulatedPerson* simulated = nullptr;
  std::unique_ptr<core::Clock> clock;
};

core::Result<Setup> set_up(const Options& options) {
  auto info = TRY(devices::find(options.setup.device, devices::DeviceKind::handle));
  Setup out;
  if (info.simulated) {
    auto person = std::make_unique<check::SimulatedPerson>(devices::HandSense{}, options.seed);
    out.simulated = person.get();
    out.device = std::move(person);
    out.clock = std::make_unique<core::ManualClock>();
  } else {
    if (!::isatty(STDIN_FILENO))
      return core::Error{core::Errc::bad_input,
                         "threshold: a person has to answer: run it at a terminal"};
    auto made = TRY(info.make({.sdk = options.setup.sdk, .homing = devices::Homing::refuse}));
    out.device = std::move(made.device);
    out.clock = std::make_unique<core::MonotonicClock>();
  }
  out.limits = TRY(out.device->open());
  if (out.limits.name.empty()) out.limits.name = info.id;
  return out;
}

core::Result<check::MeasuredThreshold> measured(const Options& options,
                                                const session::StationFolder& folder,
                                                const session::RemoteSupervisor& outside,
                                                Setup& setup, Stimulus stimulus) {
  core::MonotonicClock wall;
  AtTerminal terminal;
  if (!setup.simulated) TRY(ask_person(options, instruction_of(stimulus)));
  const RawTerminal raw;
  const double rate_Hz = setup.limits.rate_Hz;
  loop::Limiter limiter(folder.config().limits, core::Instant_ns(std::llround(1e9 / rate_Hz)));
  limiter.cap_force(outside.force_N());
  const auto asked = setup.simulated ? setup.simulated->asked() : terminal.asked();
  core::Result<check::MeasuredThreshold> out = check::MeasuredThreshold{};
  TRY(run_shown(
      std::string(check::name(stimulus)),
      setup.simulated ? Pace::as_fast_as_it_goes : Pace::real_time, outside,
      [&](const std::function<bool(double)>& progress) -> core::Result<void> {
        out = check::measure_threshold(
            {*setup.clock, wall, *setup.device, limiter, rate_Hz, progress}, stimulus,
            options.questions, options.seed + std::uint64_t(stimulus), asked);
        return out ? core::Result<void>() : out.error();
      },
      [&] {
        limiter.cap_force(outside.force_N());
        if (!setup.simulated) terminal.wait();
      }));
  return out;
}

void print(const check::ObserverRecord& record) {
  fmt::print("{}{}\n", record.device, record.simulated ? "  (SIMULATED person)" : "");
  for (const auto& one : record.measured) {
    const bool gap = one.stimulus == Stimulus::gap;
    const auto& [median, range, slope] = one.threshold;
    fmt::print("  {:<11} {:7.2f} {} (95 %: {:.2f} to {:.2f}), {} of {} right\n",
               check::name(one.stimulus), 1e3 * median, gap ? "mm" : "mN", 1e3 * range.low,
               1e3 * range.high, one.right, one.questions);
  }
}
}  // namespace

core::Result<int> measure_thresholds(const Options& options) {
  TRY(core::may_be_written(options.out));
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  Presence presence(options, folder);
  presence.is(Presence::State::preparing);
  auto setup = TRY(set_up(options));
  check::ObserverRecord record{.at_utc_us = core::utc_us(),
                               .device = setup.limits.name,
                               .who = options.who,
                               .simulated = setup.simulated || setup.limits.simulated};
  core::Result<void> outcome;
  for (const Stimulus stimulus : core::values<Stimulus>()) {
    auto one = measured(options, folder, *presence.outside(), setup, stimulus);
    if (one)
      record.measured.push_back(*one);
    else
      outcome = one.error();
    if (!outcome) break;
  }
  setup.device->close();
  TRY(std::move(outcome));
  TRY(core::write_json(options.out, record.to_json()));
  if (options.json)
    fmt::print("{}\n", record.to_json().dump(2));
  else
    print(record);
  return 0;
}

}  // namespace app
}  // namespace tractus
