/// Many stations, a data folder and a PostgreSQL for several servers, nginx before them: how fast
/// pieces of trials are acknowledged, what it costs, and whether anything that was acknowledged is
/// lost while servers are killed.
#include <fmt/format.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "tests/bench/stations_load/many/check.hpp"
#include "tests/bench/stations_load/many/live.hpp"
#include "tests/bench/stations_load/many/watch.hpp"
#include "tests/bench/support/report.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;
using many::Clock;
using many::Options;

constexpr double kRestart_s = 2.0;     ///< RestartSec of deploy/large/tractus-server@.service
constexpr double kAftermath_s = 15.0;  ///< after a kill, counted apart

double seconds_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double>(to - from).count();
}

void raise_descriptor_limit() {
  rlimit limit{};
  ::getrlimit(RLIMIT_NOFILE, &limit);
  limit.rlim_cur = limit.rlim_max;
  ::setrlimit(RLIMIT_NOFILE, &limit);
}

std::string load_average() { return load::first_line("/proc/loadavg").substr(0, 14); }

/// What was measured between the first station's second trial and the end.
struct Run {
  std::vector<Clock::time_point> kills;
  std::vector<double> down_s;
  Clock::time_point from, to;
  std::map<std::string, many::Used> used;
  double machine_cores = 0.0, own_cores = 0.0;
  std::uint64_t states = 0, reconnects = 0;
  std::map<std::string, int> refused;  ///< tries for a live connection, by their error
  int lines_open = 0;
  std::vector<many::Tally> tallies;
};

/// Kills one server after the other, and starts each again, until the time is over.
void kill_servers(many::Setup& setup, many::Watch& watch, const Options& options, Run& run) {
  const auto every = std::chrono::duration<double>(options.kill_every_s);
  for (int n = 1;; ++n) {
    const auto due = run.from + std::chrono::duration_cast<Clock::duration>(n * every);
    if (due + std::chrono::seconds(5) > run.to) return;
    std::this_thread::sleep_until(due);
    const auto which = std::size_t(n - 1) % setup.servers();
    watch.look();
    const auto killed = Clock::now();
    setup.kill_server(which);
    std::this_thread::sleep_for(std::chrono::duration<double>(kRestart_s));
    const auto again = setup.start_server(which);
    run.kills.push_back(killed);
    run.down_s.push_back(seconds_between(killed, Clock::now()));
    fmt::print("    {:6.1f} s: server {} killed, {} after {:.1f} s; load of the machine {}\n",
               seconds_between(run.from, killed), which + 1,
               again ? "again there" : again.error().what, run.down_s.back(), load_average());
    std::fflush(stdout);
  }
}

core::Result<Run> run(many::Setup& setup, const Options& options) {
  constexpr unsigned kTemplates = 4;
  std::vector<many::Template> recorded;
  for (unsigned seed = 0; seed < kTemplates; ++seed) {
    auto made = many::Template::make(setup.folder(), setup.case_id(), options, seed);
    if (!made) return made.error();
    recorded.push_back(std::move(*made));
  }
  many::Watch watch(setup);
  Run out;
  const auto begun = Clock::now();
  std::vector<std::unique_ptr<many::Station>> stations;
  for (std::size_t i = 0; i < std::size_t(options.stations); ++i)
    stations.push_back(
        std::make_unique<many::Station>(setup, options, recorded[i % kTemplates], i, begun));
  many::LiveLines lines(setup, options, stations);
  // As many record as will do later, and every station has its live connection.
  out.from = begun + std::chrono::duration_cast<Clock::duration>(
                         std::chrono::duration<double>(std::max(10.0, options.trial_s)));
  out.to = out.from + std::chrono::duration_cast<Clock::duration>(
                          std::chrono::duration<double>(60.0 * options.minutes));
  std::this_thread::sleep_until(out.from);
  watch.restart();
  const double own_s = bench::process_s();
  const std::uint64_t states = lines.states(), reconnects = lines.reconnects();
  if (options.kill_every_s > 0.0) kill_servers(setup, watch, options, out);
  std::this_thread::sleep_until(out.to);
  out.used = watch.used();
  out.machine_cores = watch.machine_cores();
  out.own_cores = (bench::process_s() - own_s) / (60.0 * options.minutes);
  out.states = lines.states() - states;
  out.reconnects = lines.reconnects() - reconnects;
  out.refused = lines.refused();
  out.lines_open = lines.open();
  for (auto& station : stations) station->end();
  for (auto& station : stations) out.tallies.push_back(station->finish());
  return out;
}

bool after_kill(const Run& run, Clock::time_point due) {
  for (const Clock::time_point kill : run.kills) {
    const double s = seconds_between(kill, due);
    if (s > -1.0 && s < kAftermath_s) return true;
  }
  return false;
}

void report_latencies(bench::Report& report, const std::string& what, std::vector<double> ms) {
  if (ms.empty()) return;
  const std::string count = fmt::format("{}", ms.size());
  report.row(what + " p50", bench::quantile(ms, 0.5), "ms", count);
  report.row(what + " p99", bench::quantile(ms, 0.99), "ms");
  report.row(what + ", worst", bench::quantile(ms, 1.0), "ms");
}

void report_processes(bench::Report& report, const Run& run, const Options& options) {
  const double s = 60.0 * options.minutes;
  double ours = run.own_cores;
  for (const auto& [name, used] : run.used) {
    ours += used.processor_s / s;
    report.row(name + ", processor", used.processor_s / s, "cores");
    report.row(name + ", memory, most", used.most_bytes * 1e-6, "MB",
               used.most_threads == 0 ? "PSS of all its processes"
                                      : fmt::format("{} threads, {} descriptors at most",
                                                    used.most_threads, used.most_descriptors));
  }
  report.row("this load generator, processor", run.own_cores, "cores");
  report.row("everything else on this machine", run.machine_cores - ours, "cores",
             "load average " + load_average());
}

void report_run(bench::Report& report, const Run& run, const Options& options) {
  std::vector<double> calm, after, committed, late;
  std::uint64_t retries = 0, lost = 0, bytes = 0;
  std::map<std::string, int> failures;
  for (const many::Tally& one : run.tallies) {
    for (const many::Acknowledged& piece : one.pieces) {
      if (piece.due < run.from || piece.due > run.to) continue;
      (after_kill(run, piece.due) ? after : calm).push_back(piece.took_s * 1e3);
      late.push_back(piece.late_s * 1e3);
    }
    for (const many::Acknowledged& commit : one.commits)
      if (commit.due > run.from && commit.due < run.to) committed.push_back(commit.took_s * 1e3);
    retries += one.retries;
    lost += one.lost_bytes;
    bytes += one.bytes;
    for (const std::string& failure : one.failures) ++failures[failure.substr(0, 120)];
  }
  const double s = 60.0 * options.minutes;
  const double recording = options.stations * options.trial_s / options.cycle_s();
  report.row(
      "stations", options.stations, "",
      fmt::format("{:.0f} of them record at a time, {:.0f} s each", recording, options.trial_s));
  report.row("pieces due", recording / options.between_s, "1/s");
  report.row("pieces acknowledged", double(calm.size() + after.size()) / s, "1/s");
  report.row("states said", double(run.states) / s, "1/s",
             fmt::format("{} live connections open at the end", run.lines_open));
  std::vector<double> all = calm;
  all.insert(all.end(), after.begin(), after.end());
  report_latencies(report, "acknowledgement", all);
  if (!after.empty()) {
    report_latencies(report, "  away from kills", calm);
    report_latencies(report, "  within 15 s after a kill", after);
  }
  report_latencies(report, "commit", committed);
  report_latencies(report, "a piece was sent late by", late);
  report_processes(report, run, options);
  if (!run.kills.empty())
    report.row("servers killed", double(run.kills.size()), "",
               fmt::format("away for {:.1f} s at most",
                           *std::max_element(run.down_s.begin(), run.down_s.end())));
  report.row("requests repeated", double(retries), "");
  report.row("live connections made again", double(run.reconnects), "");
  for (const auto& [why, count] : run.refused)
    report.row("  tries for one that failed", count, "", why);
  report.row("bytes acknowledged", double(bytes) * 1e-6, "MB");
  report.at_most("acknowledged bytes that a server had lost", double(lost), 0.0, "B");
  for (const auto& [failure, count] : failures)
    report.must(fmt::format("no station failed; {} did: {}", count, failure), false);
}

void report_check(bench::Report& report, const many::Setup& setup, const Run& run) {
  std::vector<many::Committed> trials;
  for (const many::Tally& one : run.tallies)
    trials.insert(trials.end(), one.trials.begin(), one.trials.end());
  report.row("trials acknowledged as complete", double(trials.size()), "");
  const auto checked = many::check(setup, trials);
  if (!checked) return report.must(checked.error().what, false);
  report.at_least("trials", double(trials.size()), 1.0, "");
  report.at_most("of them missing in the records", double(checked->missing), 0.0, "");
  report.at_most("whose bytes are not those sent", double(checked->different), 0.0, "");
  report.at_most("that a server does not list whole", double(checked->unlisted), 0.0, "");
  report.at_most("uploads left unfinished", double(checked->unfinished), 0.0, "");
  report.row("jobs that wait", double(checked->jobs_waiting), "");
  report.must("tractus-server verify finds nothing wrong", checked->verified);
}

}  // namespace
}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  Options options;
  std::string json;
  CLI::App app{"Many simulated stations against several servers on one PostgreSQL"};
  app.add_option("--stations", options.stations);
  app.add_option("--servers", options.servers);
  app.add_option("--minutes", options.minutes, "measured, after a trial's length of warming up");
  app.add_option("--kill-every-s", options.kill_every_s, "0: no server is killed");
  app.add_option("--trial-s", options.trial_s, "length of a trial");
  app.add_option("--pause-s", options.pause_s, "from a trial's end to the next one's start");
  app.add_option("--between-s", options.between_s, "time between two pieces of a trial");
  app.add_option("--states-hz", options.states_Hz, "states a second of a station that records");
  app.add_option("--descriptors", options.descriptors, "soft limit of servers and nginx");
  app.add_option("--port", options.port, "first port; 0: any");
  app.add_option("--folder", options.folder, "where the data folder is made");
  app.add_option("--json", json);
  CLI11_PARSE(app, argc, argv);
  raise_descriptor_limit();
  bench::Report report("many_stations");
  auto setup = many::Setup::start(options);
  if (!setup) {
    fmt::print(stderr, "{}\n", setup.error().what);
    return 2;
  }
  const auto ran = run(**setup, options);
  if (!ran) {
    fmt::print(stderr, "{}\n", ran.error().what);
    return 2;
  }
  report_run(report, *ran, options);
  report_check(report, **setup, *ran);
  return report.finish(argc, argv);
}
