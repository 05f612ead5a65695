/// 64 stations at 1 kHz and 16 at 4 kHz hand over what they capture, each a piece a second, and say
/// their state 20 times a second, to one server on this machine; walls look on. Then the backlog of
/// an outage against a plain upload of as many bytes.
#include <fmt/format.h>

#include <cstdlib>
#include <thread>

#include "station/uplink/upload.hpp"
#include "tests/bench/stations_load/backlog.hpp"
#include "tests/bench/stations_load/station.hpp"
#include "tests/bench/support/report.hpp"

namespace tractus {
namespace {
namespace fs = std::filesystem;

struct Options {
  int slow = 64, fast = 16, walls = 2, backlog = 100;
  int connections = int(uplink::kUploadConnections);
  double seconds = 30.0, between_s = 1.0;
  bool plain = false;
};

Options options_of(int argc, char** argv) {
  Options out;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i], value = i + 1 < argc ? argv[i + 1] : "0";
    if (word == "--slow") out.slow = std::atoi(value.c_str());
    if (word == "--fast") out.fast = std::atoi(value.c_str());
    if (word == "--walls") out.walls = std::atoi(value.c_str());
    if (word == "--backlog") out.backlog = std::atoi(value.c_str());
    if (word == "--connections") out.connections = std::atoi(value.c_str());
    if (word == "--seconds") out.seconds = std::atof(value.c_str());
    if (word == "--between") out.between_s = std::atof(value.c_str());
    if (word == "--plain") out.plain = true;
  }
  return out;
}

/// Somebody looks on: counts the frames.
class Wall {
 public:
  Wall(const load::Server& server, const std::string& cookie)
      : thread_([this, &server, cookie](std::stop_token stop) {
          const std::atomic<bool> stopped = false;
          auto line =
              uplink::open_server_socket({.url = server.url(),
                                          .headers = {{"Cookie", cookie}, {"Origin", server.url()}},
                                          .authority = server.authority(),
                                          .path = "/api/v1/live"},
                                         stopped);
          while (line && !stop.stop_requested()) {
            auto heard = (*line)->receive(200);
            if (!heard) return;
            frames_ += heard->has_value();
          }
        }) {}
  std::uint64_t frames() const { return frames_; }

 private:
  std::atomic<std::uint64_t> frames_ = 0;
  std::jthread thread_;
};

void judge_load(bench::Report& report, const load::Server& server, const Options& options,
                const fs::path& folder) {
  const auto all = static_cast<std::size_t>(options.slow + options.fast);
  std::vector<std::string> ids, trials;
  for (std::size_t i = 0; i < all; ++i) {
    const double rate_Hz = i < std::size_t(options.slow) ? 1000.0 : 4000.0;
    ids.push_back(core::new_id());
    auto bytes = load::trial_bytes(folder, ids.back(), server.case_id(), rate_Hz, options.seconds,
                                   unsigned(i));
    if (!bytes) return report.must(bytes.error().what, false);
    trials.push_back(std::move(*bytes));
  }
  auto cookie = server.cookie();
  if (!cookie) return report.must(cookie.error().what, false);
  std::vector<std::unique_ptr<Wall>> walls;
  for (int i = 0; i < options.walls; ++i) walls.push_back(std::make_unique<Wall>(server, *cookie));
  std::vector<double> resident_MB;
  std::vector<load::Met> met;
  const double begun_s = bench::wall_s(), processor_s = server.processor_s();
  {
    std::vector<std::unique_ptr<load::Station>> stations;
    for (std::size_t i = 0; i < all; ++i)
      stations.push_back(std::make_unique<load::Station>(server, i, ids[i], std::move(trials[i]),
                                                         options.seconds, options.between_s));
    std::jthread watching([&](std::stop_token stop) {
      while (!stop.stop_requested()) {
        resident_MB.push_back(server.resident_bytes() * 1e-6);
        std::this_thread::sleep_for(std::chrono::seconds(1));
      }
    });
    for (auto& station : stations) met.push_back(station->finish());
  }
  const double took_s = bench::wall_s() - begun_s;
  std::vector<double> acknowledged_ms, committed_ms;
  double bytes = 0.0, states = 0.0, frames = 0.0;
  for (const load::Met& one : met) {
    if (!one.failure.empty()) report.must(one.failure, false);
    for (const double s : one.acknowledged_s) acknowledged_ms.push_back(s * 1e3);
    committed_ms.push_back(one.committed_s * 1e3);
    bytes += double(one.bytes);
    states += double(one.states);
  }
  for (const auto& wall : walls) frames += double(wall->frames());
  report.row("stations", double(all), "", options.plain ? "plain" : "TLS");
  report.row("handed over", bytes * 1e-6 / took_s, "MB/s");
  report.row("states said", states / took_s, "1/s");
  report.row("frames to each wall", frames / took_s / std::max(1, options.walls), "1/s");
  report.row("server's processor time", (server.processor_s() - processor_s) / took_s, "cores");
  report.row("acknowledgement p50", bench::quantile(acknowledged_ms, 0.5), "ms",
             fmt::format("{} pieces", acknowledged_ms.size()));
  report.at_most("acknowledgement p99", bench::quantile(acknowledged_ms, 0.99), 250.0, "ms");
  report.row("acknowledgement, worst", bench::quantile(acknowledged_ms, 1.0), "ms");
  report.row("commit p50", bench::quantile(committed_ms, 0.5), "ms",
             "the whole file checked; all at once");
  report.row("commit, worst", bench::quantile(committed_ms, 1.0), "ms");
  if (resident_MB.size() < 8) return;
  const std::size_t quarter = resident_MB.size() / 4;
  const double early = *std::max_element(resident_MB.begin() + long(quarter / 2),
                                         resident_MB.begin() + long(2 * quarter));
  // The last seconds are the commits of all stations in one moment.
  const double late = *std::max_element(resident_MB.begin() + long(2 * quarter),
                                        resident_MB.end() - long(quarter / 2) - 1);
  report.row("server's memory, first half", early, "MB");
  report.row("server's memory, most", *std::max_element(resident_MB.begin(), resident_MB.end()),
             "MB");
  report.at_most("server's memory, growth in the second half", late - early, 16.0, "MB");
}

}  // namespace

}  // namespace tractus

int main(int argc, char** argv) {
  using namespace tractus;
  const Options options = options_of(argc, argv);
  const fs::path folder = fs::temp_directory_path() / ("stations-load-" + core::new_id());
  bench::Report report("stations_load");
  auto server = load::Server::start(folder, options.slow + options.fast + 1, options.plain);
  if (!server) {
    fmt::print(stderr, "{}\n", server.error().what);
    return 2;
  }
  if (options.slow + options.fast > 0) judge_load(report, *server, options, folder);
  if (options.backlog > 0)
    load::judge_backlog(report, *server, options.backlog, options.connections, folder);
  return report.finish(argc, argv);
}
