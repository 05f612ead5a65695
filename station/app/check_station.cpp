/// self-test and calibrate: what a technician runs, and what is left of it.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/checks.hpp"
#include "station/app/commands.hpp"
#include "station/app/exchange.hpp"
#include "station/app/presence.hpp"
#include "station/check/machine_check.hpp"
#include "station/devices/catalogue.hpp"
#include "station/uplink/clock_offset.hpp"
#include "station/uplink/reports.hpp"

namespace tractus {
namespace app {
namespace {
constexpr double kHandRate_Hz = 4000.0, kWatched_s = 5.0;  // at most

void warn(const std::string& line) { std::fprintf(stderr, "warning: %s\n", line.c_str()); }

/// How the server's clock stands; nothing without one.
std::optional<check::Offset> offset_to_server(const Options& options) {
  if (options.server_url.empty()) return std::nullopt;
  auto server = connect(options);
  core::MonotonicClock clock;
  auto measured = server ? uplink::measure_clock(**server, clock, core::utc_us)
                         : core::Result<uplink::ClockOffset>(server.error());
  if (measured) return check::Offset{measured->offset_s, measured->error_s};
  warn("the server's clock was not compared: " + measured.error().what);
  return std::nullopt;
}

core::Result<void> check_machine(Checked& checked) {
  const Options& options = checked.options;
  std::vector<check::Finding>& out = checked.findings;
  const bool rig = devices::is_rig(options.setup.device);
  if (!rig && options.show != Show::none) out.push_back(check_display(options.show));
  const core::Progress shown = core::terminal_progress("Loop");
  out.push_back(check::check_wake_ups(
      rig ? options.rig.rate_Hz : kHandRate_Hz, std::min(kWatched_s, options.for_s),
      [&](double share) { return shown(share) && !asked_to_stop(); }));
  TRY(check::check_disk(checked.folder.trials(), out));
  out.push_back(check::check_clock());
  out.push_back(check::check_time_of_day(offset_to_server(options)));
  return {};
}

/// Not of a simulated device that nobody ever calibrated: there is nothing to calibrate.
core::Result<void> check_calibration(Checked& checked) {
  const std::string& device = checked.options.setup.device;
  auto last = TRY(check::Calibration::read(checked.folder.calibration_file(device)));
  if (last || !devices::is_simulated(device))
    checked.findings.push_back(check::check_calibration(
        last, core::utc_us(),
        checked.simulated ? check::Tested::simulation : check::Tested::machine));
  return {};
}

check::Report report_for(const session::StationFolder& folder) {
  std::error_code failed;
  const auto space = std::filesystem::space(folder.trials(), failed);
  return {.version = TRACTUS_VERSION, .free_disk_bytes = failed ? 0 : space.available};
}

/// What the page calls the station: its own name, else the computer's.
std::string name_of(const session::StationFolder& folder) {
  std::array<char, 256> host{};
  const bool nameless = folder.config().name == session::StationConfig{}.name;
  if (!nameless || ::gethostname(host.data(), host.size() - 1) != 0) return folder.config().name;
  return fmt::format("{} on {}", folder.config().name, host.data());
}

/// A page that cannot be written is better known before anything moves.
core::Result<void> check_page(const Options& options) {
  if (options.page.empty()) return {};
  return core::may_be_written(options.page);
}

/// Into the folder; to the server when there is one, else with the next exchange; as a page.
core::Result<void> keep(const Checked& checked, const check::Report& report) {
  const Options& options = checked.options;
  TRY(report.leave(checked.folder.reports()));
  if (!options.page.empty()) {
    const std::string page = report.to_html(name_of(checked.folder));
    if (auto written = core::write_file(options.page, core::bytes_of(page)); !written)
      warn("there is no page: " + written.error().what);
  }
  if (options.server_url.empty()) return {};
  auto server = TRY(connect(options));
  auto handed = uplink::hand_over_reports(*server, checked.folder.reports());
  if (!handed) {
    warn("the report waits for the server: " + handed.error().what);
    return {};
  }
  for (const std::string& line : handed->refused)
    warn("the server does not take a report: " + line);
  return {};
}

void print(const Checked& checked) {
  fmt::print("{}{}\n", checked.device.empty() ? checked.options.setup.device : checked.device,
             checked.simulated ? "  (SIMULATED: no machine was tested)" : "");
  for (const check::Finding& f : checked.findings) {
    const std::string wanted = check::wanted_of(f);
    fmt::print("  {}  {:<36} {:>9}{}  {}\n", f.passed ? "passed    " : "NOT passed", f.name,
               check::found_of(f), wanted.empty() ? "" : fmt::format(" ({})", wanted), f.words);
  }
}

bool all_passed(const Checked& checked) {
  return std::ranges::all_of(checked.findings, &check::Finding::passed);
}

/// What went wrong with the device itself is a finding like others; bad use and a stop are not.
core::Result<void> recorded_outcome(const core::Result<void>& outcome, Checked& checked) {
  if (outcome || outcome.error().code != core::Errc::unavailable) return outcome;
  checked.findings.push_back({.name = "device", .words = outcome.error().what});
  return {};
}

/// The exit code of what did not come to its end.
core::Result<int> unfinished(const core::Error& why) {
  if (why.code != core::Errc::cancelled) return why;
  std::fprintf(stderr, "stopped: zero force, and no report was left\n");
  return 1;
}

const check::Finding* finding(const Checked& checked, const char* name) {
  const auto found = std::ranges::find(checked.findings, name, &check::Finding::name);
  return found == checked.findings.end() ? nullptr : &*found;
}

/// One line of what the calibration found; of a rig, how far its sensor has moved since the last.
void describe(const Checked& checked, const std::optional<check::Calibration>& last,
              check::Calibration& out) {
  const auto* push = finding(checked, "sensor zero, push");
  const auto* twist = finding(checked, "sensor zero, torque");
  if (!push || !twist) {
    const auto* rest = finding(checked, "rest at zero force");
    out.words = fmt::format(
        "{}: zero found, gravity balanced (drift {}), six directions and the "
        "step as they should be",
        checked.device, rest ? check::found_of(*rest) : "");
  } else {
    out.zero_N = push->value;
    out.zero_Nm = twist->value;
    out.words = fmt::format("{}: sensor zero {:.3f} N, {:.4f} N·m", checked.device, *push->value,
                            *twist->value);
    if (last && last->zero_N)
      out.words += fmt::format(" ({:+.3f} N since {})", *push->value - *last->zero_N,
                               check::day_of(last->at_utc_us));
    out.words += ", entry found, e-stop, travel, watchdog and motor as they should be";
  }
  if (checked.simulated) out.words += " (SIMULATED)";
}

/// Nothing is noted: what is wrong is said.
int not_calibrated(const Checked& checked) {
  if (checked.options.json) {
    core::Json checks = core::Json::array();
    for (const check::Finding& f : checked.findings) checks.push_back(f.to_json());
    fmt::print("{}\n", core::Json{{"calibration", nullptr}, {"checks", checks}}.dump(2));
  } else {
    print(checked);
  }
  std::fprintf(stderr, "not calibrated: put right what did not pass, and repeat\n");
  return 1;
}
}  // namespace

core::Result<check::Report> test_station(Checked& checked) {
  const Options& options = checked.options;
  check::SelfTest test{.at_utc_us = core::utc_us()};
  const auto device =
      devices::is_rig(options.setup.device) ? check_whole_rig(checked) : self_test_hand(checked);
  TRY(recorded_outcome(device, checked));
  TRY(check_calibration(checked));
  TRY(check_machine(checked));
  if (asked_to_stop()) return core::Error{core::Errc::cancelled, "stopped"};
  test.device = checked.device.empty() ? options.setup.device : checked.device;
  test.simulated = checked.simulated;
  test.findings = checked.findings;
  check::Report report = report_for(checked.folder);
  report.self_test = std::move(test);
  TRY(keep(checked, report));
  return report;
}

core::Result<int> self_test(const Options& options) {
  TRY(check_page(options));
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  Presence presence(options, folder);
  presence.is(Presence::State::preparing);
  Checked checked{options, folder, *presence.outside()};
  const auto report = test_station(checked);
  if (!report) return unfinished(report.error());
  if (options.json)
    fmt::print("{}\n", report->to_json().dump(2));
  else
    print(checked);
  return all_passed(checked) ? 0 : 1;
}

core::Result<int> calibrate(const Options& options) {
  TRY(check_page(options));
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  const std::filesystem::path file = folder.calibration_file(options.setup.device);
  auto last = TRY(check::Calibration::read(file));
  auto presence = std::make_unique<Presence>(options, folder);
  presence->is(Presence::State::preparing);
  Checked checked{options, folder, *presence->outside()};
  const auto device =
      devices::is_rig(options.setup.device) ? check_whole_rig(checked) : calibrate_hand(checked);
  if (auto fine = recorded_outcome(device, checked); !fine) return unfinished(fine.error());
  if (!all_passed(checked)) return not_calibrated(checked);
  presence.reset();  // it told the date that was due until now
  const std::int64_t now = core::utc_us();
  check::Calibration made{.at_utc_us = now,
                          .due_utc_us = now + options.due_days * core::kDay_us,
                          .kind = options.setup.device,
                          .who = options.who,
                          .simulated = checked.simulated};
  describe(checked, last, made);
  std::error_code there;
  std::filesystem::create_directories(file.parent_path(), there);
  TRY(core::write_json(file, made.to_json()));
  check::Report report = report_for(folder);
  report.calibration = std::move(made);
  report.checks = checked.findings;
  TRY(keep(checked, report));
  if (options.json) {
    fmt::print("{}\n", report.to_json().dump(2));
    return 0;
  }
  print(checked);
  fmt::print("calibrated; due again on {}\n", check::day_of(report.calibration->due_utc_us));
  return 0;
}

}  // namespace app
}  // namespace tractus
