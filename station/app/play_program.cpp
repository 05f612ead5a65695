/// `tractus-station record --program`: the rig plays a motion by itself, into a measurement set.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <chrono>

#include "core/progress.hpp"
#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/loop/loop_thread.hpp"
#include "station/loop/program_player.hpp"
#include "station/session/rig_entry.hpp"

namespace tractus {
namespace app {
namespace {

using core::Errc;
using core::Error;
using core::Result;

constexpr const char* kHandsOff =
    "Keep clear, hands off: the stage moves by itself through what is clamped before the probe.";

/// The trials of a set that is there already, with the new ones after them under names of their own.
Result<trial::ProbingSet> joined(const std::filesystem::path& with,
                                 std::vector<trial::ProbingMeasurement> played, bool simulated) {
  trial::ProbingSet out;
  if (!with.empty()) out = TRY(trial::read_probing_set(with));
  for (trial::ProbingMeasurement& trial : played) {
    // The program's name comes from a file and becomes a file's name.
    std::ranges::replace_if(
        trial.id, [](unsigned char c) { return std::isalnum(c) == 0; }, '-');
    const std::string name = trial.id;
    for (int k = 2;
         std::ranges::any_of(out.trials, [&](const auto& other) { return other.id == trial.id; });
         ++k)
      trial.id = fmt::format("{}-again-{}", name, k);
    trial.file = trial.id + ".csv";
    out.trials.push_back(std::move(trial));
  }
  if (simulated) out.stated["simulated"] = true;
  return out;
}

Result<devices::MadeRig> rig_for(const Options& options) {
  const auto info = TRY(devices::find(options.setup.device, devices::DeviceKind::rig));
  if (!info.simulated && !options.specimen.empty())
    return Error{Errc::bad_input,
                 "--specimen: of a simulated rig alone; a machine has a real one before its probe"};
  return info.make_rig({.address = options.rig.address,
                        .program = options.rig.program,
                        .seed = options.rig.seed,
                        .surgeon = false,
                        .specimen = options.specimen});
}

/// Plays in a thread of its own with real-time priority, as a trial does: neither a terminal nor
/// another program may hold up a tick.
Result<std::vector<trial::ProbingMeasurement>> played_shown(loop::ProgramPlayer& player,
                                                            const trial::MotionProgram& program,
                                                            const Options& options) {
  const auto shown = core::terminal_progress("Playing");
  loop::Playing playing;
  Result<std::vector<trial::ProbingMeasurement>> out = Error{Errc::cancelled, "stopped"};
  loop::LoopThread works(loop::Pace::real_time,
                         [&] { out = player.play(program, options.repetitions, playing); });
  for (const std::string& warning : works.grant().warnings)
    if (!options.json) fmt::print(stderr, "{}\n", warning);
  works.go();
  while (!works.ended_within(std::chrono::milliseconds(50)))
    if (asked_to_stop() || (shown && !shown(playing.share))) playing.stop = true;
  works.join();
  return out;
}

}  // namespace

Result<int> play_program(const Options& options) {
  core::stop_on_signals();
  if (std::filesystem::exists(options.room))
    return Error{Errc::bad_input,
                 options.room.string() + ": is there already; a new folder's name is expected"};
  const auto program = TRY(trial::MotionProgram::from_json(TRY(core::read_json(options.program)),
                                                           options.program.string() + ": "));
  auto made = TRY(rig_for(options));
  const auto identity = TRY(made.device->open());
  core::MonotonicClock clock;
  loop::RigLimits limits;
  limits.max_speed_m_s = std::min(limits.max_speed_m_s, identity.top_speed_m_s);
  for (const trial::Move& move : program.moves)
    if (std::max(move.to_m, program.start_m) > identity.travel_m ||
        std::min(move.to_m, program.start_m) < 0.0 || move.speed_m_s > limits.max_speed_m_s)
      return Error{Errc::out_of_range,
                   fmt::format("{}: goes from 0 to {:.4g} m at {:.4g} m/s at most; this program "
                               "asks for {:.4g} m at {:.4g} m/s",
                               made.address, identity.travel_m, limits.max_speed_m_s, move.to_m,
                               move.speed_m_s)};
  if (!identity.simulated) TRY(ask_person(options, kHandsOff));
  TRY(session::bring_to_entry(*made.device, clock, options.rig.rate_Hz));
  loop::ProbingGuard guard(limits, identity.travel_m, 1.0 / options.rig.rate_Hz);
  loop::ProgramPlayer player({clock, *made.device, guard}, options.rig.rate_Hz);
  auto played = TRY(played_shown(player, program, options));
  TRY(session::bring_to_entry(*made.device, clock, options.rig.rate_Hz));
  made.device->close();
  const std::size_t trials = played.size(), samples = played.front().t_s.size();
  const auto set = TRY(joined(options.with_set, std::move(played), identity.simulated));
  TRY(trial::write_probing_set(options.room, set));
  if (options.json)
    fmt::print("{}\n", core::Json{{"folder", options.room.string()},
                                  {"trials", trials},
                                  {"samples", samples},
                                  {"all_trials", set.trials.size()},
                                  {"simulated", identity.simulated}}
                           .dump(2));
  else
    fmt::print("{}: {} trials of \"{}\"{}; {} in all\n", options.room.string(), trials,
               program.name, identity.simulated ? ", SIMULATED" : "", set.trials.size());
  return 0;
}

}  // namespace app
}  // namespace tractus
