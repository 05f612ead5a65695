/// sync, upload, trust: what a station does with its server and its folder.
#include "station/app/exchange.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstdio>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "station/app/commands.hpp"
#include "station/uplink/http_server.hpp"
#include "station/uplink/models.hpp"
#include "station/uplink/reports.hpp"
#include "station/uplink/sync.hpp"
#include "wire/live.hpp"

namespace tractus {
namespace app {
namespace {
std::atomic<bool> stop_asked = false;

core::Progress stoppable(core::Progress shown) {
  return [shown = std::move(shown)](double share) { return shown(share) && !stop_asked; };
}

/// Waits in small steps, so that a person can stop it.
class PatientClock final : public core::Clock {
 public:
  core::Instant_ns now() const noexcept override { return clock_.now(); }
  void sleep_until(core::Instant_ns deadline) noexcept override {
    while (now() < deadline && !stop_asked)
      clock_.sleep_until(std::min(deadline, now() + kStep_ns));
  }

 private:
  static constexpr core::Instant_ns kStep_ns = 100'000'000;
  core::MonotonicClock clock_;
};
}  // namespace

core::Result<std::string> token_of(const Options& options) {
  auto bytes = TRY(core::read_file(options.token_file, 64 * 1024));
  std::string token(core::text_of(bytes));
  while (!token.empty() && (token.back() == '\n' || token.back() == '\r')) token.pop_back();
  return token;
}

core::Result<std::string> pin_in(const std::filesystem::path& file) {
  auto bytes = TRY(core::read_file(file, 4096));
  std::string pin(core::text_of(bytes));
  return pin.substr(0, pin.find_first_of("\r\n"));
}

core::Result<std::unique_ptr<uplink::Server>> connect(const Options& options) {
  auto token = TRY(token_of(options));
  auto server = TRY(uplink::HttpServer::make(options.server_url, token, options.authority));
  return std::unique_ptr<uplink::Server>(std::move(server));
}

void ask_to_stop() noexcept { stop_asked = true; }
bool asked_to_stop() noexcept { return stop_asked; }

namespace {

/// What self-tests left goes with whatever else is exchanged; what cannot go now goes next time.
void hand_over_notes(uplink::Server& server, const session::StationFolder& folder) {
  if (auto handed = uplink::hand_over_reports(server, folder.reports()); handed)
    for (const std::string& line : handed->refused)
      std::fprintf(stderr, "warning: the server does not take a report: %s\n", line.c_str());
}

/// The server's trail says what a station would not take from it.
void tell_refused(uplink::Server& server, const std::vector<std::string>& refused) {
  if (refused.empty()) return;
  wire::StationReport report;
  report.version = TRACTUS_VERSION;
  report.refused = refused;
  const std::string body = report.to_json().dump();
  const uplink::Request request{.method = "POST",
                                .path = "/api/v1/station/report",
                                .headers = {{"Content-Type", "application/json"}},
                                .body = core::bytes_of(body)};
  if (auto answer = server.send(request); !answer || answer->status / 100 != 2)
    std::fprintf(stderr, "warning: the server was not told which cases were refused\n");
}

/// How the clocks stand, as far as it can be known just now.
std::optional<uplink::ClockOffset> clock_offset(uplink::Server& server,
                                                const session::StationFolder& folder) {
  core::MonotonicClock clock;
  if (auto measured = uplink::measure_clock(server, clock, core::utc_us)) {
    uplink::keep_clock(folder.clock(), *measured);
    return *measured;
  }
  return uplink::kept_clock(folder.clock(), core::utc_us(), core::kDay_us);
}

/// Of this process: what a trial's upload recorded is sent while the next one goes on.
tracing::Tracer* tracer() {
  static const auto kTracer = tracing::tracer_of_environment(
      "tractus-station", TRACTUS_VERSION, [](const std::string& why) {
        if (!why.empty()) std::fprintf(stderr, "warning: traces are not sent: %s\n", why.c_str());
      });
  return kTracer.get();
}

bool anything_waits(const session::StationFolder& folder) {
  const auto entries = folder.outbox().entries();
  return entries && std::ranges::any_of(*entries, [](const uplink::OutboxEntry& entry) {
           return entry.state == uplink::OutboxState::queued;
         });
}

}  // namespace

core::Result<core::Json> fetch_cases(const Options& options, const session::StationFolder& folder) {
  auto server = TRY(connect(options));
  auto report = TRY(uplink::sync_cases(*server, folder.cases(), folder.trusted(),
                                       stoppable(core::terminal_progress("Cases"))));
  tell_refused(*server, report.refused);
  hand_over_notes(*server, folder);
  return report.to_json();
}

core::Result<uplink::ModelReport> fetch_models(const Options& options,
                                               const session::StationFolder& folder) {
  auto server = TRY(connect(options));
  return uplink::sync_models(*server, folder.models());
}

core::Result<std::filesystem::path> model_file_of(const Options& options,
                                                  const session::StationFolder& folder) {
  std::error_code failure;
  if (options.model_file.empty() || std::filesystem::exists(options.model_file, failure))
    return options.model_file;
  return uplink::model_named(folder.models(), options.model_file.string());
}

core::Result<uplink::UploadReport> hand_over(const Options& options,
                                             const session::StationFolder& folder) {
  auto lock = TRY(folder.upload_lock());
  auto server = TRY(connect(options));
  hand_over_notes(*server, folder);
  const auto offset = anything_waits(folder) ? clock_offset(*server, folder) : std::nullopt;
  PatientClock clock;
  uplink::Patience patience;
  patience.give_up_after_ns = static_cast<core::Instant_ns>(options.wait_s * 1e9);
  std::vector<std::unique_ptr<uplink::Server>> more;
  std::vector<uplink::Server*> connections{server.get()};
  while (connections.size() < uplink::kUploadConnections) {
    auto another = TRY(connect(options));
    connections.push_back(another.get());
    more.push_back(std::move(another));
  }
  return uplink::upload_all(connections, folder.outbox(), folder.trials(), clock, patience,
                            stoppable(core::terminal_progress("Upload")), offset, tracer());
}

core::Result<int> sync_cases(const Options& options) {
  auto folder = TRY(session::StationFolder::open(options.data));
  auto lock = TRY(folder.lock());
  auto report = TRY(fetch_cases(options, folder));
  auto models = TRY(fetch_models(options, folder));
  report["models"] = models.to_json();
  const bool refused = !report["refused"].empty() || !models.refused.empty();
  if (options.json) {
    fmt::print("{}\n", report.dump(2));
    return refused ? 1 : 0;
  }
  fmt::print("{} cases fetched, {} were here, {} refused\n", report["fetched"].size(),
             report["present"].size(), report["refused"].size());
  for (const auto& line : report["refused"]) fmt::print("  {}\n", line.get<std::string>());
  if (!models.fetched.empty() || !models.present.empty() || !models.refused.empty())
    fmt::print("{} models fetched, {} were here, {} refused\n", models.fetched.size(),
               models.present.size(), models.refused.size());
  for (const auto& line : models.refused) fmt::print("  {}\n", line);
  return refused ? 1 : 0;
}

std::string text_of(const uplink::UploadReport& report) {
  std::string out = fmt::format("{} trials handed over", report.handed_over);
  if (report.refused) out += fmt::format(", {} refused by the server (see outbox)", report.refused);
  if (report.waiting) out += fmt::format(", {} still wait: {}", report.waiting, report.why);
  return out;
}

core::Result<int> upload_trials(const Options& options) {
  auto folder = TRY(session::StationFolder::open(options.data));
  // What a crash left is queued first, unless a station is recording here just now.
  if (auto lock = folder.lock(); lock) TRY(folder.recover());
  auto report = TRY(hand_over(options, folder));
  fmt::print("{}\n", options.json ? report.to_json().dump(2) : text_of(report));
  return report.waiting || report.refused ? 1 : 0;
}

core::Result<int> show_limits(const Options& options) {
  auto folder = session::StationFolder::open(options.data);
  if (!folder) return folder.error();
  if (options.restore) {
    TRY(folder->restore_force());
    folder = session::StationFolder::open(options.data);
    if (!folder) return folder.error();
  }
  const session::StationConfig& config = folder->config();
  const double own_N = config.limits.max_force_N;
  core::Json said{{"force_N", own_N}, {"own_force_N", own_N}, {"lowered_force_N", nullptr}};
  std::string more;
  if (config.lowered_force_N) {
    const double lowered_N = *config.lowered_force_N;
    said["force_N"] = std::min(own_N, lowered_N);
    said["lowered_force_N"] = lowered_N;
    more = fmt::format("; lowered to {:g} N from afar", lowered_N);
  }
  if (options.json)
    fmt::print("{}\n", said.dump(2));
  else
    fmt::print("a hand gets at most {:g} N (this station's own limit: {:g} N{})\n",
               said["force_N"].get<double>(), own_N, more);
  return 0;
}

core::Result<int> trust_signer(const Options& options) {
  auto folder = TRY(session::StationFolder::open(options.data));
  std::string key = options.signer_hex;
  if (key.empty()) {
    auto opened = TRY(cases::open_case(options.signer_of_case));
    key = opened.signer_public_hex;
  }
  TRY(folder.trust(key));
  if (options.json)
    fmt::print("{}\n", core::Json{{"signers", folder.trusted()}}.dump(2));
  else
    fmt::print("cases signed by {} are taken\n", key);
  return 0;
}

}  // namespace app
}  // namespace tractus
