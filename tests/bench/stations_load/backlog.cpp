#include "tests/bench/stations_load/backlog.hpp"

#include <fmt/format.h>

#include <deque>
#include <map>

#include "core/file.hpp"
#include "station/uplink/upload.hpp"
#include "tests/bench/stations_load/station.hpp"
#include "wire/messages.hpp"

namespace tractus {
namespace load {
namespace fs = std::filesystem;
namespace {

/// Seconds for one stream of these bytes; negative: it failed.
double plain_upload_s(uplink::Server& server, const std::string& case_id,
                      const std::string& bytes) {
  const std::string path = "/api/v1/uploads/" + core::new_id();
  const std::string said =
      wire::UploadAnnouncement{case_id, bytes.size(), core::sha256(core::bytes_of(bytes))}
          .to_json()
          .dump();
  const auto announced = server.send({.method = "PUT", .path = path, .body = core::bytes_of(said)});
  if (!announced || announced->status != 200) return -1.0;
  const double begun = bench::wall_s();
  for (std::size_t at = 0; at < bytes.size(); at += wire::kMaxChunk_bytes) {
    const auto piece = core::bytes_of(std::string_view(bytes).substr(at, wire::kMaxChunk_bytes));
    const auto answer =
        server.send({.method = "PATCH",
                     .path = fmt::format("{}?offset_bytes={}", path, at),
                     .headers = {{"X-Crc32c", fmt::format("{:08x}", core::crc32c(piece))},
                                 {"Content-Type", "application/octet-stream"}},
                     .body = piece});
    if (!answer || answer->status != 200) return -1.0;
  }
  return bench::wall_s() - begun;
}

/// A connection that measures how long each of its requests takes.
class TimedServer final : public uplink::Server {
 public:
  explicit TimedServer(uplink::Server& server) : server_(server) {}
  core::Result<uplink::HttpResponse> send(const uplink::Request& request) override {
    const double begun = bench::wall_s();
    auto answer = server_.send(request);
    took_s[request.method] += bench::wall_s() - begun;
    return answer;
  }
  std::map<std::string, double> took_s;  ///< by method

 private:
  uplink::Server& server_;
};

}  // namespace

void judge_backlog(bench::Report& report, const Server& server, int trials, int connections,
                   const fs::path& folder) {
  const fs::path station = folder / "station";
  fs::create_directories(station / "outbox");
  fs::create_directories(station / "trials");
  const uplink::Outbox outbox(station / "outbox");
  std::string all;
  for (int i = 0; i < trials; ++i) {
    const std::string id = core::new_id();
    auto bytes = trial_bytes(folder, id, server.case_id(), 1000.0, 10.0, unsigned(i));
    if (!bytes) return report.must(bytes.error().what, false);
    const fs::path file = station / "trials" / (id + ".ttrial");
    const bool kept =
        core::write_file(file, core::bytes_of(*bytes)) && outbox.queue(id, server.case_id(), file);
    if (!kept) return report.must("the backlog is on the disk", false);
    all += *bytes;
  }
  std::vector<std::unique_ptr<uplink::HttpServer>> lines;
  std::deque<TimedServer> timed;
  std::vector<uplink::Server*> several;
  for (int i = 0; i < connections; ++i) {
    auto line = uplink::HttpServer::make(server.url(), server.token(0), server.authority());
    if (!line) return report.must(line.error().what, false);
    several.push_back(&timed.emplace_back(**line));
    lines.push_back(std::move(*line));
  }
  const double plain_before_s = server.processor_s();
  const double plain_s = plain_upload_s(*several.front(), server.case_id(), all);
  for (TimedServer& line : timed) line.took_s.clear();
  core::MonotonicClock clock;
  const double begun = bench::wall_s(), before_s = server.processor_s();
  auto handed = uplink::upload_all(several, outbox, station / "trials", clock, {});
  const double took_s = bench::wall_s() - begun, drained_s = server.processor_s();
  report.must("every trial of the backlog was handed over",
              handed && handed->handed_over == trials && handed->waiting == 0);
  const double size_MB = double(all.size()) * 1e-6;
  report.row("backlog", double(trials), "trials", fmt::format("{:.1f} MB", size_MB));
  report.row("plain upload of the same bytes", size_MB / plain_s, "MB/s");
  report.row("backlog drains at", size_MB / took_s, "MB/s",
             fmt::format("{:.1f} trials/s", trials / took_s));
  report.row("backlog against plain", plain_s / took_s, "");
  for (const auto& [method, what] : {std::pair("PUT", "announced in"),
                                     {"PATCH", "its piece taken in"},
                                     {"POST", "committed in"}}) {
    double sum_s = 0.0;
    for (TimedServer& line : timed) sum_s += line.took_s[method];
    report.row(std::string("a trial of the backlog is ") + what, sum_s / trials * 1e3, "ms");
  }
  report.row("server's processor time, plain", (before_s - plain_before_s) / trials * 1e3,
             "ms/trial");
  report.row("server's processor time, backlog", (drained_s - before_s) / trials * 1e3, "ms/trial",
             "with the scoring that was done meanwhile");
}

}  // namespace load
}  // namespace tractus
