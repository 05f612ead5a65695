#include "server/app/data_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <pwd.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "server/app/log.hpp"
#include "server/app/objects_address.hpp"

namespace tractus {
namespace app {
namespace fs = std::filesystem;
namespace {
constexpr const char* kSecret = "secret.key";
}  // namespace

core::Result<void> make_key_file(const fs::path& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (fd < 0)
    return errno == EEXIST ? core::Result<void>() : core::system_error(path, "cannot make");
  const std::string text = core::hex(core::random_bytes(32)) + "\n";
  const bool written = ::write(fd, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       ::fsync(fd) == 0;
  ::close(fd);
  if (written) return core::sync_folder(path.parent_path());
  fs::remove(path);
  return core::system_error(path, "cannot write");
}

core::Result<api::Secrets::Key> read_key_file(const fs::path& path) {
  auto bytes = TRY(core::read_file(path, 4096));
  std::string_view text = core::text_of(bytes);
  text = text.substr(0, text.find('\n'));
  api::Secrets::Key key{};
  if (!core::is_sha256(text))
    return core::Error{core::Errc::corrupt,
                       path.string() + ": 64 hexadecimal characters are expected"};
  std::ranges::copy(*core::hex_decoded(text), key.begin());
  return key;
}

namespace {

/// The key, made when the database has nothing yet that needs it.
core::Result<api::Secrets> secrets_of(const fs::path& folder, store::Store& store) {
  std::error_code failure;
  if (!fs::exists(folder / kSecret, failure)) {
    auto end = TRY(store.read([](store::Reading& tx) { return store::chain_end(tx); }));
    if (end.number > 0)
      return core::Error{core::Errc::not_found, (folder / kSecret).string() +
                                                    ": is missing; the audit trail was made with "
                                                    "this key: restore the file from a backup"};
    TRY(make_key_file(folder / kSecret));
  }
  auto key = TRY(read_key_file(folder / kSecret));
  return api::Secrets(key);
}
}  // namespace

core::Result<void> leave_to_owner(const fs::path& folder) {
  auto repaired = TRY(core::make_private(folder, "objects"));
  if (repaired > 0)
    log_line({{"what", "others had access to files and folders; now only their owner has access"},
              {"folder", folder.string()},
              {"repaired", repaired}});
  return {};
}

namespace {

void remove_parts(const fs::path& folder, bool alone) {
  constexpr std::chrono::hours kLongest_work{24};
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    if (entry.path().extension() != ".part") continue;
    const auto age = fs::file_time_type::clock::now() - entry.last_write_time(failure);
    if (alone || age > kLongest_work) fs::remove_all(entry.path(), failure);
  }
}

}  // namespace

void remove_left_overs(const fs::path& folder, bool alone) {
  for (const char* inner : {"", kCertificates, "pseudonyms", "objects"})
    remove_parts(folder / inner, alone);
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder / "objects", failure))
    remove_parts(entry.path(), alone);
}

core::Result<DataFolder> open_data(const fs::path& path) {
  auto database = TRY(database_of(path));
  return open_data(path, database);
}

core::Result<DataFolder> open_up_to_date(const fs::path& path) {
  const auto database = TRY(database_of(path));
  TRY(check_up_to_date(database));
  return open_data(path, database);
}

core::Result<DataFolder> make_data(const fs::path& path, const std::string& objects_address) {
  auto database = TRY(new_database(path));
  if (database.is_shared())  // nothing is made when it cannot be reached
    TRY(database.open());
  TRY(keep_objects_at(path, objects_address));
  return open_data(path, database);
}

core::Result<DataFolder> open_data(const fs::path& path, const Database& database) {
  if (database.is_shared())  // nothing is made when it cannot be reached
    TRY(database.open());
  std::error_code failure;
  fs::create_directories(path, failure);
  if (failure)
    return core::Error{core::Errc::io,
                       fmt::format("{}: cannot create: {}", path.string(), failure.message())};
  TRY(leave_to_owner(path));
  auto objects = TRY(open_objects(path));
  auto partials = TRY(store::PartialFiles::open(path));
  auto opened = TRY(database.open());
  TRY(note_address(path, database));
  auto secrets = TRY(secrets_of(path, opened));
  opened.set_audit_key(secrets.audit_key());
  return DataFolder{path, std::move(opened), std::move(objects), std::move(partials),
                    std::move(secrets)};
}

store::AuditedAction command_act(const std::string& command, const core::Json& detail) {
  const passwd* user = ::getpwuid(::geteuid());
  return {.who = fmt::format("command line: {}", user ? user->pw_name : "unknown"),
          .role = store::kCommandLine,
          .peer = "",
          .what = command,
          .object = "",
          .detail = detail.dump(),
          .at_utc_us = core::utc_us()};
}

core::Result<ServingLock> ServingLock::take(const fs::path& data, bool shared) {
  const fs::path path = data / "serving.lock";
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return core::system_error(path, "cannot open");
  if (::flock(fd, (shared ? LOCK_SH : LOCK_EX) | LOCK_NB) != 0) {
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
}  // namespace tractus
