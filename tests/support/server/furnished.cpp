#include "tests/support/server/furnished.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <checkout.hpp>
#include <fstream>

#include "core/bytes.hpp"
#include "tests/support/server/process.hpp"
#include "tests/support/server/world.hpp"

namespace tractus {
namespace world {
namespace fs = std::filesystem;
namespace {

/// What a world was made by: the server, and what makes its case.
std::string stamp() {
  const fs::path build = fs::path(checkout::kBin).parent_path();
  std::string out;
  for (const char* file : {"bin/tractus-server", "shared/cases/libtractus_cases.a",
                           "tests/support/server/libtractus_server_support.a"})
    out += fmt::format("{} {}\n", fs::last_write_time(build / file).time_since_epoch().count(),
                       fs::file_size(build / file));
  return out;
}

/// Holds a file's lock among processes until it goes.
class FileLock {
 public:
  explicit FileLock(const fs::path& path)
      : fd_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    EXPECT_EQ(::flock(fd_, LOCK_EX), 0) << path;
  }
  ~FileLock() { ::close(fd_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int fd_;
};

FurnishedWorld on_sqlite() {
  const fs::path place = fs::path(checkout::kBin).parent_path() / "tests" / "furnished-world";
  const FileLock held(place.string() + ".lock");
  const std::string made_by = stamp();
  if (!fs::exists(place / "stamp") || bytes_of(place / "stamp") != made_by) {
    fs::remove_all(place);
    fs::create_directories(place / "world");
    furnish_world(place / "world", "");
    // One that could not be made whole is made again by the next test.
    if (!::testing::Test::HasFailure()) std::ofstream(place / "stamp") << made_by;
  }
  return {place / "world", nullptr};
}

FurnishedWorld on_postgresql() {
  FurnishedWorld out{fs::path(::testing::TempDir()) / ("tractus-" + core::new_id()),
                     std::make_unique<test_support::TestDatabase>(
                         test_support::DatabaseKind::postgresql, test_support::Content::nothing)};
  fs::create_directories(out.folder);
  furnish_world(out.folder, out.database->address());
  return out;
}

}  // namespace

void furnish_world(const fs::path& folder, const std::string& address) {
  const fs::path data = folder / "data";
  std::ofstream(folder / "password") << ServedWorld::kPassword << "\n";
  const auto must = [](const std::vector<std::string>& arguments) {
    const Ended ended = run_program("tractus-server", arguments);
    EXPECT_EQ(ended.code, 0) << ended.out;
  };
  std::vector<std::string> init{"init", "--data", data, "--password-file", folder / "password"};
  if (!address.empty()) init.insert(init.end(), {"--database", address});
  must(init);
  for (const char* name : {"station-1", "station-2"})
    must({"enrol", "--data", data, "--name", name, "--out", folder / name});
  std::ofstream(folder / "case-id") << make_case(folder / "case") << "\n";
  must({"publish", "--data", data, folder / "case"});
}

const FurnishedWorld& furnished_world() {
  struct Kept {
    FurnishedWorld world = test_support::database_kind() == test_support::DatabaseKind::postgresql
                               ? on_postgresql()
                               : on_sqlite();
    ~Kept() {
      std::error_code ignored;
      if (world.database) fs::remove_all(world.folder, ignored);
    }
  };
  static const Kept kept;
  return kept.world;
}

}  // namespace world
}  // namespace tractus
