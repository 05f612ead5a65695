#include "server/app/data_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include "core/file.hpp"

namespace app {
namespace fs = std::filesystem;
namespace {
constexpr const char* kDatabase = "tractus.db";
}

core::Result<DataFolder> open_data(const fs::path& path) {
  std::error_code failure;
  if (!fs::is_regular_file(path / kDatabase, failure))
    return core::Error{core::Errc::not_found,
                       fmt::format("{}: not a server's data folder; make one with: "
                                   "tractus-server init --data {}",
                                   path.string(), path.string())};
  return make_data(path);
}

core::Result<DataFolder> make_data(const fs::path& path) {
  std::error_code failure;
  const bool fresh = fs::create_directories(path, failure);
  if (failure)
    return core::Error{core::Errc::io,
                       fmt::format("{}: cannot create: {}", path.string(), failure.message())};
  if (fresh) fs::permissions(path, fs::perms::owner_all, failure);  // trainees' trials are in it
  auto objects = store::Objects::open(path);
  if (!objects) return objects.error();
  auto partials = store::PartialFiles::open(path);
  if (!partials) return partials.error();
  auto opened = store::Store::open(path / kDatabase);
  if (!opened) return opened.error();
  return DataFolder{path, std::move(*opened), std::move(*objects), std::move(*partials)};
}

core::Result<ServingLock> ServingLock::take(const fs::path& data) {
  const fs::path path = data / "serving.lock";
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0640);
  if (fd < 0) return core::system_error(path, "cannot open");
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    ::close(fd);
    return core::Error{core::Errc::conflict,
                       data.string() + ": another tractus-server serves this folder"};
  }
  return ServingLock(fd);
}

ServingLock::~ServingLock() {
  if (fd_ >= 0) ::close(fd_);
}

}  // namespace app
