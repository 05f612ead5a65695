/// The interface of backups for the routes; the server program implements it.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/named.hpp"
#include "core/result.hpp"

namespace tractus::api {

enum class BackupState { making, verifying, done, failed };
constexpr auto words(BackupState) {
  using enum BackupState;
  return std::to_array<core::Word<BackupState>>(
      {{making, "making"}, {verifying, "verifying"}, {done, "done"}, {failed, "failed"}});
}

struct Backup {
  std::string id;  ///< id, which is also the name of the folder
  BackupState state = BackupState::done;
  double share = 0.0;  ///< completed share of the current work, 0 … 1
  std::string error;   ///< reason for the state failed, one line
  std::int64_t made_utc_us = 0;
  std::string made_by;  ///< name of the account; empty: made by a command
  std::uint64_t size_bytes = 0, trials = 0;
  /// Whether a restored copy passed the check; nothing: not checked yet.
  std::optional<bool> holds = {};
  std::int64_t verified_utc_us = 0;
  std::vector<std::string> findings = {};  ///< errors that the check found, one line each
};

/// Makes or verifies one backup at a time, while the server runs. Thread-safe.
class Backups {
 public:
  virtual ~Backups() = default;
  /// Newest first. Errors: io.
  virtual core::Result<std::vector<Backup>> list() = 0;
  /// Errors: conflict while another backup is made or verified.
  virtual core::Result<Backup> make(const std::string& by) = 0;
  /// Errors: not_found; conflict as above.
  virtual core::Result<Backup> verify(const std::string& id) = 0;
};

}  // namespace tractus::api
