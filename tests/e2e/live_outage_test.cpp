/// Stations through outages: a backlog of days, a server that dies while it is handed over, a
/// station that is killed while it fetches a case.
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <checkout.hpp>
#include <cstdlib>
#include <fstream>
#include <mutex>

#include "core/clock.hpp"
#include "station/uplink/http_server.hpp"
#include "station/uplink/upload.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

/// Dies and is back, elsewhere, once so many requests were answered. One connection for all threads,
/// which take turns.
class Mortal final : public uplink::Server {
 public:
  Mortal(const ServedWorld& world, int lives_for) : world_(world), left_(lives_for) { live(); }
  core::Result<uplink::HttpResponse> send(const uplink::Request& request) override {
    const std::lock_guard held(mutex_);
    if (--left_ == 0) {
      process_->kill_now();
      live();
      return core::Error{core::Errc::unavailable, "the line is cut"};
    }
    return line_->send(request);
  }
  int port() const { return process_->port(); }

 private:
  void live() {
    process_ = std::make_unique<ServerProcess>(world_.data);
    const std::string token = world_.station_1.at("Authorization").substr(7);
    line_ = std::move(
        uplink::HttpServer::make(fmt::format("http://127.0.0.1:{}", process_->port()), token)
            .value());
  }
  const ServedWorld& world_;
  std::mutex mutex_;
  int left_;
  std::unique_ptr<ServerProcess> process_;
  std::unique_ptr<uplink::HttpServer> line_;
};

TEST(Outage, ABacklogOfDaysIsHandedOverOnceAndInOrderThoughTheServerDies) {
  constexpr int kTrials = 150;
  const ServedWorld world;
  const fs::path trials = world.folder / "trials";
  fs::create_directories(trials);
  fs::create_directories(world.folder / "outbox");
  const uplink::Outbox outbox(world.folder / "outbox");
  std::vector<std::string> ids;
  for (int i = 0; i < kTrials; ++i) {
    ids.push_back(fmt::format("{:012x}", 1000 + i) + std::string(20, 'a'));
    const fs::path file = trials / (ids.back() + ".ttrial");
    trial::Header header = header_of(ids.back(), world.case_id);
    header.started_utc_us += i * 600'000'000ll;  // one every ten minutes
    write_trial(file, header, 50);
    ASSERT_TRUE(outbox.queue(ids.back(), world.case_id, file));
  }
  Mortal server(world, 200);
  core::ManualClock clock;
  const auto report =
      uplink::upload_all(std::vector<uplink::Server*>(uplink::kUploadConnections, &server), outbox,
                         trials, clock, {.give_up_after_ns = 600'000'000'000});
  ASSERT_TRUE(report) << report.error().what;
  EXPECT_EQ(report->handed_over, kTrials);
  EXPECT_EQ(report->waiting + report->refused, 0);

  Client client;
  client.speak_to(server.port());
  const Headers admin = world.admin(client);
  const core::Json list = client.ask("GET", "/api/v1/trials?limit=200", admin).json();
  ASSERT_EQ(list["trials"].size(), std::size_t(kTrials)) << "each of them, once";
  std::vector<std::string> committed;
  for (std::string cursor, more = "first"; !more.empty();) {
    const core::Json trail =
        client.ask("GET", "/api/v1/audit?limit=200&search=commitUpload" + cursor, admin).json();
    for (const core::Json& row : trail["rows"])
      if (row["what"] == "commitUpload")
        committed.push_back(row["object"].get<std::string>().substr(9));  // "trial_id=…"
    more = core::text_member(trail, "next");
    cursor = "&cursor=" + more;
  }
  std::ranges::reverse(committed);
  committed.erase(std::unique(committed.begin(), committed.end()), committed.end());
  EXPECT_EQ(committed, ids) << "oldest first";
}

/// A case of 128³ voxels of noise, 4 MB, published.
std::string publish_large_case(const ServedWorld& world, const core::KeyPair& key) {
  volume::Volume volume;
  volume.geometry.dims = {128, 128, 128};
  volume.geometry.spacing_m = volume::Vec3::Constant(1e-3);
  volume.counts.resize(volume.geometry.voxel_count());
  std::uint32_t state = 1;
  for (auto& count : volume.counts) {
    state = state * 1664525u + 1013904223u;
    count = static_cast<std::uint16_t>(state >> 17);
  }
  cases::NewCase made{.definition = {}, .truth = {}, .volume = volume, .meta = {}, .draw = {}};
  made.definition.title = "Noise";
  made.definition.source = "made by a test, no patient";
  made.definition.tract.length_m = 0.03;
  made.definition.tract.radius_m = 0.002;
  const auto opened = cases::write_case(world.folder / "large", std::move(made), key);
  EXPECT_TRUE(opened);
  const Ended published =
      run_program("tractus-server", {"publish", "--data", world.data, world.folder / "large"});
  EXPECT_EQ(published.code, 0) << published.out;
  return opened ? opened->id : "";
}

TEST(Outage, AStationThatIsKilledWhileItFetchesACaseHasItWholeOrNotAtAll) {
  const ServedWorld world;
  const auto key = core::KeyPair::generate();
  const std::string id = publish_large_case(world, key);
  ServerProcess server(world.data);
  const fs::path data = world.folder / "st";
  std::ofstream(world.folder / "st.token") << world.station_1.at("Authorization").substr(7) << "\n";
  for (const char* made : {"case", "large"})
    ASSERT_EQ(
        run_program("tractus-station", {"trust", "--data", data, "--case", world.folder / made})
            .code,
        0);
  int kills = 0, code = -1;
  // In the foreground `timeout` ends after the station that it killed, not with it; with its status
  // preserved, a station that ended just as its time ran out counts as one that ended.
  for (int ms = 10; code != 0 && kills < 500; ms += 5) {
    const std::string command = fmt::format(
        "timeout --foreground --preserve-status -s KILL {:.3f} {}/tractus-station sync --data {} "
        "--server http://127.0.0.1:{} "
        "--token-file {} > {} 2>&1",
        ms * 1e-3, checkout::kBin, data.string(), server.port(),
        (world.folder / "st.token").string(), (world.folder / "said").string());
    const int status = std::system(command.c_str());
    code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    ASSERT_TRUE(code == 0 || code == 137) << code << bytes_of(world.folder / "said");
    kills += code != 0;
    EXPECT_TRUE(!fs::exists(data / "cases" / id) || cases::open_case(data / "cases" / id)) << ms;
  }
  std::printf("killed %d times\n", kills);
  EXPECT_GT(kills, 0);
  EXPECT_EQ(code, 0);
  EXPECT_TRUE(cases::open_case(data / "cases" / id));
  EXPECT_FALSE(fs::exists(data / "incoming" / id));
}

}  // namespace
}  // namespace tractus
