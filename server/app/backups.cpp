#include "server/app/backups.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/clock.hpp"
#include "core/file.hpp"
#include "core/try.hpp"
#include "server/app/anchors.hpp"

namespace tractus {
namespace app {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostFindings = 100;

std::uint64_t size_of(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code failure;
  for (const auto& entry : fs::recursive_directory_iterator(folder, failure))
    if (entry.is_regular_file(failure)) bytes += entry.file_size(failure);
  return bytes;
}

/// Of the data folder and the moment: "2026-03-02T09-30-12Z".
std::string name_of(std::int64_t utc_us) {
  std::string out = core::utc_text(utc_us).substr(0, 19);
  std::ranges::replace(out, ':', '-');
  return out + "Z";
}

bool is_name(const std::string& id) {
  return !id.empty() && id.size() <= 64 && id.front() != '.' &&
         std::ranges::all_of(id, [](unsigned char c) {
           return std::isalnum(c) || c == '-' || c == '_' || c == '.';
         });
}

}  // namespace

BackupFolder::BackupFolder(fs::path data, fs::path folder)
    : data_(std::move(data)), folder_(std::move(folder)) {}

core::Result<void> BackupFolder::tidy(bool alone) const {
  std::error_code failure;
  if (!fs::exists(folder_, failure)) return {};
  remove_left_overs(folder_, alone);
  return leave_to_owner(folder_);
}

BackupFolder::~BackupFolder() {
  {
    const std::lock_guard held(mutex_);
    ending_ = true;
  }
  if (thread_.joinable()) thread_.join();
}

core::Result<api::Backup> BackupFolder::read(const std::string& id) const {
  auto manifest = TRY(core::read_json(folder_ / id / kBackupManifest));
  api::Backup out{.id = id, .state = api::BackupState::done, .error = {}, .made_by = {}};
  out.made_utc_us = manifest.value("made_utc_us", std::int64_t{0});
  out.size_bytes = size_of(folder_ / id);
  if (manifest.contains("rows") && manifest["rows"].is_object())
    out.trials = manifest["rows"].value("trials", std::uint64_t{0});
  const auto note = core::read_json(folder_ / (id + ".json"));
  if (!note || !note->is_object()) return out;  // made by the command line
  out.made_by = note->value("made_by", "");
  if (!note->contains("holds") || !(*note)["holds"].is_boolean()) return out;
  out.holds = (*note)["holds"].get<bool>();
  out.verified_utc_us = note->value("verified_utc_us", std::int64_t{0});
  out.findings = note->value("findings", std::vector<std::string>());
  return out;
}

void BackupFolder::keep(const api::Backup& backup) const {
  core::Json note{{"made_by", backup.made_by}};
  if (backup.holds) {
    note["holds"] = *backup.holds;
    note["verified_utc_us"] = backup.verified_utc_us;
    note["findings"] = backup.findings;
  }
  // Without the note it is a backup all the same.
  [[maybe_unused]] const auto written = core::write_json(folder_ / (backup.id + ".json"), note);
}

core::Result<std::vector<api::Backup>> BackupFolder::list() {
  std::vector<api::Backup> out;
  const std::lock_guard held(mutex_);
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder_, failure)) {
    const std::string id = entry.path().filename().string();
    if (!is_name(id) || !fs::exists(entry.path() / kBackupManifest, failure)) continue;
    if (current_ && current_->id == id) continue;
    if (auto one = read(id); one) out.push_back(std::move(*one));
  }
  if (current_) out.push_back(*current_);
  if (failed_) out.push_back(*failed_);
  std::ranges::sort(out, std::greater{},
                    [](const auto& one) { return std::pair(one.made_utc_us, one.id); });
  return out;
}

core::Progress BackupFolder::progress() {
  return [this](double share) {
    const std::lock_guard held(mutex_);
    if (current_) current_->share = share;
    return !ending_;
  };
}

/// With the lock held.
void BackupFolder::start(const api::Backup& backup, std::function<void(api::Backup&)> work) {
  if (thread_.joinable()) thread_.join();  // of the one before, which has ended
  current_ = backup;
  failed_.reset();
  thread_ = std::thread([this, one = backup, work = std::move(work)]() mutable {
    work(one);
    const bool failed = one.state == api::BackupState::failed || one.holds == false;
    if (failed && failed_now_) failed_now_(one);
    const std::lock_guard done(mutex_);
    if (one.state == api::BackupState::failed) failed_ = one;
    current_.reset();
  });
}

void BackupFolder::make_now(api::Backup& backup) {
  auto made = back_up(data_, folder_ / backup.id, progress());
  if (made) return keep(backup);
  backup.state = api::BackupState::failed;
  backup.error = made.error().what;
}

void BackupFolder::verify_now(api::Backup& backup) {
  auto scratch = core::ScratchFolder::make(folder_ / ("trying-" + backup.id));
  auto examined = [&]() -> core::Result<Examined> {
    if (!scratch) return scratch.error();
    const fs::path restored = scratch->path() / "data";
    const auto shown = progress();
    TRY(restore(folder_ / backup.id, restored, {Database::file_in(restored), {}},
                [&](double share) { return shown(0.5 * share); }));
    auto data = TRY(open_data(restored, Database::file_in(restored)));
    return examine(data, [&](double share) { return shown(0.5 + 0.5 * share); });
  }();
  if (!examined && examined.error().code == core::Errc::cancelled) return;
  backup.findings =
      examined ? std::move(examined->found.lines) : std::vector{examined.error().what};
  if (backup.findings.size() > kMostFindings) backup.findings.resize(kMostFindings);
  backup.holds = backup.findings.empty();
  backup.verified_utc_us = core::utc_us();
  keep(backup);
}

core::Result<api::Backup> BackupFolder::make(const std::string& by) {
  const std::lock_guard held(mutex_);
  if (current_)
    return core::Error{core::Errc::conflict, "another backup is being made or verified"};
  std::error_code failure;
  fs::create_directories(folder_, failure);
  const std::int64_t now = core::utc_us();
  api::Backup backup{
      .id = name_of(now), .state = api::BackupState::making, .error = {}, .made_by = by};
  backup.made_utc_us = now;
  if (fs::exists(folder_ / backup.id, failure))
    return core::Error{core::Errc::conflict, "a backup was already made in this second: try again"};
  start(backup, [this](api::Backup& one) { make_now(one); });
  return backup;
}

core::Result<api::Backup> BackupFolder::verify(const std::string& id) {
  const std::lock_guard held(mutex_);
  if (current_)
    return core::Error{core::Errc::conflict, "another backup is being made or verified"};
  std::error_code failure;
  if (!is_name(id) || !fs::exists(folder_ / id / kBackupManifest, failure))
    return core::Error{core::Errc::not_found, "no backup " + id.substr(0, 64)};
  auto backup = TRY(read(id));
  backup.state = api::BackupState::verifying;
  start(backup, [this](api::Backup& one) { verify_now(one); });
  return backup;
}

}  // namespace app
}  // namespace tractus
