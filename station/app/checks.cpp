#include "station/app/checks.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "station/app/exchange.hpp"
#include "station/devices/catalogue.hpp"
#include "station/loop/realtime.hpp"

namespace tractus {
namespace app {
namespace {
constexpr auto kShown = std::chrono::milliseconds(30);
constexpr int kWait_ms = 100;

core::Error stopped() { return {core::Errc::cancelled, "stopped"}; }
}  // namespace

core::Result<void> ask_person(const Options& options, const char* what) {
  if (options.stand_by) return {};
  if (!::isatty(STDIN_FILENO))
    return core::Error{core::Errc::bad_input,
                       fmt::format("a person has to stand by ({}): run it at a terminal, or say "
                                   "--stand-by",
                                   what)};
  fmt::print(stderr, "{} Then press Enter.\n", what);
  for (char typed = 0; typed != '\n';) {
    if (asked_to_stop()) return stopped();
    pollfd input{STDIN_FILENO, POLLIN, 0};
    if (::poll(&input, 1, kWait_ms) > 0 && ::read(STDIN_FILENO, &typed, 1) != 1) return stopped();
  }
  return {};
}

bool Checked::attended() const { return attendant || ::isatty(STDIN_FILENO); }

void Checked::tell(const char* what) const {
  if (attendant)
    attendant->tell(what);
  else
    fmt::print(stderr, "\n{}\n", what);
}

core::Result<void> run_shown(
    const std::string& label, Pace pace, const session::RemoteSupervisor& outside,
    const std::function<core::Result<void>(const std::function<bool(double)>& progress)>& work,
    const std::function<void()>& on_wait) {
  std::atomic<double> share = 0.0;
  std::atomic<bool> stop = false, done = false;
  std::optional<core::Result<void>> outcome;
  std::thread thread([&] {
    std::optional<loop::Realtime> realtime;
    if (pace == Pace::real_time) realtime.emplace();
    outcome.emplace(work([&](double now) {
      share = now;
      return !stop;
    }));
    done = true;
  });
  const core::Progress shown = core::terminal_progress(label);
  for (; !done; std::this_thread::sleep_for(kShown)) {
    shown(share);
    if (on_wait) on_wait();
    if (asked_to_stop() || outside.stopped()) stop = true;
  }
  thread.join();
  if (*outcome) shown(1.0);
  return *outcome;
}

void say_calibration_due(const session::StationFolder& folder, const std::string& device) {
  const auto last = check::Calibration::read(folder.calibration_file(device));
  std::string line;
  if (!last)
    line = last.error().what;
  else if (*last)
    line = check::due_warning(**last, core::utc_us());
  else if (!devices::is_simulated(device))
    line = fmt::format("{} was never calibrated here: run `tractus-station calibrate`", device);
  if (!line.empty()) std::fprintf(stderr, "warning: %s\n", line.c_str());
}

session::Watch warned(session::Watch inner, const session::StationFolder& folder,
                      const std::string& device) {
  return [inner = std::move(inner), &folder, device,
          said = false](const session::TrialSnapshot& seen) mutable {
    if (!said) say_calibration_due(folder, device);
    said = true;
    return inner(seen);
  };
}

}  // namespace app
}  // namespace tractus
