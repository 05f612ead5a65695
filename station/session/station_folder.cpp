#include "station/session/station_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>

#include "core/file.hpp"
#include "core/try.hpp"
#include "trial/trial_file.hpp"

namespace tractus {
namespace session {
namespace fs = std::filesystem;
namespace {
constexpr std::uint64_t kReserve_bytes = 600ull * 4000 * sizeof(trial::Sample);  // ten minutes

bool is_public_key(const std::string& text) { return core::is_sha256(text); }  // as many characters
}  // namespace

core::Result<FolderLock> FolderLock::take(const fs::path& path, const std::string& who) {
  const int fd = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (fd < 0) return core::system_error(path, "cannot open");
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    ::close(fd);
    return core::Error{core::Errc::conflict,
                       fmt::format("{}: {} is at work on this folder already", path.string(), who)};
  }
  return FolderLock(fd);
}

FolderLock::~FolderLock() {
  if (fd_ >= 0) ::close(fd_);
}

core::Result<FolderLock> StationFolder::lock() const {
  return FolderLock::take(root_ / "station.lock", "a station");
}
core::Result<FolderLock> StationFolder::upload_lock() const {
  return FolderLock::take(root_ / "upload.lock", "an upload");
}

core::Result<StationFolder> StationFolder::open(const fs::path& root) {
  StationFolder folder(root);
  for (const char* name : {"cases", "trials", "drilled", "outbox"}) {
    std::error_code failure;
    fs::create_directories(root / name, failure);
    if (failure)
      return core::Error{core::Errc::io, fmt::format("{}: cannot make the folder: {}",
                                                     (root / name).string(), failure.message())};
  }
  TRY(core::make_private(root, "cases"));
  TRY(folder.read_config());
  TRY(folder.read_lowered());
  TRY(folder.read_trusted());
  return folder;
}

core::Result<void> StationFolder::read_config() {
  const fs::path path = root_ / "config.json";
  auto json = core::read_json(path);
  if (!json && json.error().code == core::Errc::not_found) return {};
  if (!json) return json.error();
  core::Fields fields(*json, path.string() + ": ");
  if (fields.text("format") != "tractus-station/1")
    fields.wrong("format", "tractus-station/1 is expected");
  config_.name = fields.text_or("name", config_.name, 64);
  if (config_.name.empty()) fields.wrong("name", "is empty");
  if (const core::Json* limits = fields.member("limits", false)) {
    auto read = TRY(loop::HandLimits::from_json(*limits, path.string() + ": /limits"));
    config_.limits = read;
  }
  return fields.done();
}

core::Result<void> StationFolder::read_lowered() {
  const fs::path path = root_ / "lowered.json";
  auto json = core::read_json(path);
  if (!json && json.error().code == core::Errc::not_found) return {};
  if (!json) return json.error();
  core::Fields fields(*json, path.string() + ": ");
  config_.lowered_force_N = fields.number("force_N", 0.0, 1e4);
  return fields.done();
}

core::Result<void> StationFolder::lower_force(double force_N) const {
  StationFolder now(root_);  // another process may have lowered it since
  TRY(now.read_lowered());
  if (now.config_.lowered_force_N && *now.config_.lowered_force_N <= force_N) return {};
  return core::write_json(root_ / "lowered.json", {{"force_N", force_N}});
}

core::Result<void> StationFolder::restore_force() const {
  std::error_code failure;
  fs::remove(root_ / "lowered.json", failure);
  if (!failure) return {};
  return core::Error{core::Errc::io, fmt::format("{}: {}", root_.string(), failure.message())};
}

core::Result<void> StationFolder::read_trusted() {
  const fs::path path = root_ / "trusted_signers.json";
  auto json = core::read_json(path);
  if (!json && json.error().code == core::Errc::not_found) return {};
  if (!json) return json.error();
  core::Fields fields(*json, path.string() + ": ");
  const core::Json* signers = fields.member("signers");
  if (signers && !signers->is_array())
    fields.wrong("signers", "an array of public keys is expected");
  TRY(fields.done());
  for (const auto& one : *signers) {
    if (!one.is_string() || !is_public_key(one.get<std::string>()))
      return core::Error{
          core::Errc::bad_input,
          fmt::format("{}: /signers: a key has 64 hexadecimal characters", path.string())};
    trusted_.push_back(one.get<std::string>());
  }
  return {};
}

core::Result<void> StationFolder::trust(const std::string& signer_public_hex) {
  if (!is_public_key(signer_public_hex))
    return core::Error{core::Errc::bad_input,
                       fmt::format("{}: a public key has 64 hexadecimal characters, lower case",
                                   signer_public_hex)};
  if (std::ranges::find(trusted_, signer_public_hex) != trusted_.end()) return {};
  trusted_.push_back(signer_public_hex);
  return core::write_json(root_ / "trusted_signers.json", {{"signers", trusted_}});
}

core::Result<void> StationFolder::clear_leftovers() const {
  std::error_code failure;
  for (const fs::path& folder : {cases(), trials(), root_ / "drilled", root_ / "outbox"})
    for (const auto& entry : fs::directory_iterator(folder, failure))
      if (entry.path().extension() == ".part") fs::remove_all(entry.path(), failure);
  if (failure)
    return core::Error{core::Errc::io, fmt::format("{}: {}", root_.string(), failure.message())};
  return {};
}

core::Result<void> StationFolder::recover_file(const fs::path& file, Recovered& out) const {
  const std::string id = file.stem();
  if (!core::is_id(id) || outbox().holds(id)) return {};
  const auto samples = trial::recover_trial(file);
  if (!samples) {
    out.damaged.push_back(samples.error().what);
    return {};
  }
  if (*samples == 0) {
    std::error_code failure;
    fs::rename(file, fs::path(file).replace_extension(".empty"), failure);
    if (!failure) return {};
    return core::Error{core::Errc::io, fmt::format("{}: {}", file.string(), failure.message())};
  }
  const auto read = trial::scan_trial(file, [](const trial::Block&) {});
  if (!read) {
    out.damaged.push_back(read.error().what);
    return {};
  }
  out.trials.push_back({id, *samples});
  return outbox().queue(id, read->header.case_id, file);
}

core::Result<Recovered> StationFolder::recover() const {
  TRY(clear_leftovers());
  Recovered out;
  std::error_code failure;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(trials(), failure))
    if (entry.path().extension() == ".ttrial") files.push_back(entry.path());
  std::ranges::sort(files);
  for (const fs::path& file : files) TRY(recover_file(file, out));
  return out;
}

core::Result<void> StationFolder::check_room(std::uint64_t bytes) const {
  std::error_code failure;
  const auto space = fs::space(root_, failure);
  if (failure)
    return core::Error{core::Errc::io, fmt::format("{}: {}", root_.string(), failure.message())};
  const std::uint64_t wanted = bytes + kReserve_bytes;
  if (space.available >= wanted) return {};
  return core::Error{core::Errc::io,
                     fmt::format("{}: {} MB free, a trial wants {} MB: make room before it starts",
                                 root_.string(), space.available >> 20, wanted >> 20)};
}

}  // namespace session
}  // namespace tractus
