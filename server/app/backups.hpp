/// The backups of a folder that is served: one folder each, made and tried in a thread of their
/// own.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "server/api/operations/backups.hpp"
#include "server/app/maintenance.hpp"

namespace tractus::app {

/// `folder/ID/` is a backup as `tractus-server backup` makes it, `folder/ID.json` who made it and
/// what looking over found. What was under way when the server ended has left nothing behind.
class BackupFolder final : public api::Backups {
 public:
  BackupFolder(std::filesystem::path data, std::filesystem::path folder);
  /// Stops what is under way and waits for it.
  ~BackupFolder() override;
  /// At the server's start: leaves the folder to its owner, removes what a server that died left.
  core::Result<void> tidy(bool alone) const;
  core::Result<std::vector<api::Backup>> list() override;
  core::Result<api::Backup> make(const std::string& by) override;
  core::Result<api::Backup> verify(const std::string& id) override;
  /// Calls `failed` with each backup that could not be made or does not hold. Call before the first
  /// one is made.
  void on_failure(std::function<void(const api::Backup&)> failed) {
    failed_now_ = std::move(failed);
  }

 private:
  void start(const api::Backup& backup, std::function<void(api::Backup&)> work);
  void make_now(api::Backup& backup);
  void verify_now(api::Backup& backup);
  core::Progress progress();
  core::Result<api::Backup> read(const std::string& id) const;
  void keep(const api::Backup& backup) const;

  std::filesystem::path data_, folder_;
  std::function<void(const api::Backup&)> failed_now_ = {};
  std::mutex mutex_;  ///< guards all below
  std::optional<api::Backup> current_, failed_;
  bool ending_ = false;
  std::thread thread_;
};

}  // namespace tractus::app
