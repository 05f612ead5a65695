/// `tractus-server` as its user meets it: commands, messages, exit codes, locks.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "core/bytes.hpp"
#include "core/file.hpp"
#include "tests/support/server/process.hpp"

namespace tractus {
namespace {
using namespace world;
namespace fs = std::filesystem;

void expect_refused(const Ended& ended, const std::string& about) {
  EXPECT_EQ(ended.code, 2) << ended.out;
  EXPECT_EQ(std::ranges::count(ended.out, '\n'), 1) << ended.out;
  EXPECT_NE(ended.out.find(about), std::string::npos) << ended.out;
}

TEST(Program, EveryCommandHelpsWithAnExample) {
  for (const char* command : {"init", "enrol", "publish", "serve", "openapi", "backup", "restore",
                              "verify", "anchor", "migrate", "upgrade"}) {
    const Ended ended = run_program("tractus-server", {command, "--help"});
    EXPECT_EQ(ended.code, 0);
    EXPECT_NE(ended.out.find(std::string("Example: tractus-server ") + command), std::string::npos)
        << ended.out;
  }
}

TEST(Program, UpgradeIsCheckedWithoutAChange) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("tractus-upgrade-" + core::new_id());
  fs::create_directories(folder);
  std::ofstream(folder / "password") << "an admin's password\n";
  const fs::path data = folder / "data";
  ASSERT_EQ(run_program("tractus-server", {"init", "--data", data, "--admin-name", "admin",
                                           "--password-file", folder / "password"})
                .code,
            0);
  const auto bytes = core::read_file(data / "tractus.db");
  ASSERT_TRUE(bytes);
  const Ended fits = run_program("tractus-server", {"upgrade", "--check", "--data", data});
  EXPECT_EQ(fits.code, 0) << fits.out;
  EXPECT_NE(fits.out.find("up to date"), std::string::npos) << fits.out;
  const auto after = core::read_file(data / "tractus.db");
  ASSERT_TRUE(after);
  EXPECT_EQ(*after, *bytes);
  EXPECT_FALSE(fs::exists(data / "tractus.db.upgrade"));
  expect_refused(run_program("tractus-server", {"upgrade", "--data", data}), "--check");
  fs::remove_all(folder);
}

TEST(Program, BadUseIsOneLineAndTwo) {
  const fs::path none = fs::path(::testing::TempDir()) / ("tractus-none-" + core::new_id());
  expect_refused(run_program("tractus-server", {}), "--help");
  expect_refused(run_program("tractus-server", {"serve"}), "--data");
  expect_refused(run_program("tractus-server", {"fly"}), "--help");
  expect_refused(run_program("tractus-server", {"serve", "--data", none}), none.string());
  expect_refused(run_program("tractus-server", {"publish", "--data", none, "x"}), none.string());
  EXPECT_FALSE(fs::exists(none));
}

TEST(Program, AFolderIsServedByOneProcessWhileOthersPublishAndEnrol) {
  const ServedWorld world;
  ServerProcess server(world.data);
  if (test_support::database_kind() == test_support::DatabaseKind::postgresql)
    EXPECT_EQ(ServerProcess(world.data).stop(), 0) << "on PostgreSQL, several may";
  else
    expect_refused(
        run_program("tractus-server", {"serve", "--data", world.data, "--listen", "127.0.0.1:0"}),
        "another tractus-server serves this folder");
  EXPECT_EQ(
      run_program("tractus-server", {"publish", "--data", world.data, world.folder / "case"}).code,
      0);
  EXPECT_EQ(run_program("tractus-server", {"enrol", "--data", world.data, "--name", "station-3",
                                           "--out", world.folder / "t3"})
                .code,
            0);
  EXPECT_EQ(fs::status(world.folder / "t3").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_EQ(server.stop(), 0);
}

TEST(Program, AnAddressThatIsTakenOrNoneIsRefused) {
  const ServedWorld world;
  expect_refused(run_program("tractus-server", {"serve", "--data", world.data, "--listen", "here"}),
                 "--listen here");
  expect_refused(
      run_program("tractus-server", {"serve", "--data", world.data, "--listen", "127.0.0.1:99999"}),
      "--listen");
  expect_refused(
      run_program("tractus-server", {"serve", "--data", world.data, "--listen", "1.2.3.4.5:80"}),
      "1.2.3.4.5");
  expect_refused(run_program("tractus-server", {"serve", "--data", world.data, "--web",
                                                world.folder, "--listen", "127.0.0.1:0"}),
                 "index.html");
}

TEST(Program, ASecondAccountStationOrTokenFileOfTheSameNameIsRefused) {
  const ServedWorld world;
  expect_refused(run_program("tractus-server", {"init", "--data", world.data}),
                 "an account named admin, or one with this badge, exists already");
  expect_refused(run_program("tractus-server", {"enrol", "--data", world.data, "--name",
                                                "station-1", "--out", world.folder / "again"}),
                 "station-1 exists already");
  EXPECT_FALSE(fs::exists(world.folder / "again")) << "a token that opens nothing was left behind";
  expect_refused(run_program("tractus-server", {"enrol", "--data", world.data, "--name", "new",
                                                "--out", world.folder / "station-1"}),
                 "exists already");
}

TEST(Program, AShortPasswordIsRefused) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("tractus-" + core::new_id());
  fs::create_directories(folder);
  std::ofstream(folder / "password") << "short\n";
  expect_refused(run_program("tractus-server", {"init", "--data", folder / "data",
                                                "--password-file", folder / "password"}),
                 "line 1");
  EXPECT_FALSE(fs::exists(folder / "data"));
  fs::remove_all(folder);
}

TEST(Program, ADamagedBundleIsNotPublished) {
  const ServedWorld world;
  std::fstream volume(world.folder / "case" / "volume.tvol",
                      std::ios::in | std::ios::out | std::ios::binary);
  volume.seekp(200);
  volume.put('!');
  volume.close();
  expect_refused(
      run_program("tractus-server", {"publish", "--data", world.data, world.folder / "case"}),
      "volume.tvol");
  fs::remove(world.folder / "case" / "truth.json");
  EXPECT_EQ(
      run_program("tractus-server", {"publish", "--data", world.data, world.folder / "case"}).code,
      2);
}

TEST(Program, StopsInOrderWhenToldTo) {
  const ServedWorld world;
  ServerProcess server(world.data);
  Client idle;  // a connection kept alive does not hold it up
  idle.speak_to(server.port());
  EXPECT_EQ(idle.ask("GET", "/api/v1/cases", world.station_1).status, 200);
  EXPECT_EQ(server.stop(), 0);
}

}  // namespace
}  // namespace tractus
