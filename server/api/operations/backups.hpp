/// Backups as the routes see them; the program that serves a folder makes them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace tractus::api {

struct Backup {
  std::string id;      ///< also the folder's name
  std::string state;   ///< "making", "verifying", "done", "failed"
  double share = 0.0;  ///< of what is being done
  std::string error;   ///< of "failed": one line
  std::int64_t made_utc_us = 0;
  std::string made_by;  ///< empty: by the command line
  std::uint64_t size_bytes = 0, trials = 0;
  /// It was restored to a scratch folder and looked over; nothing: never yet.
  std::optional<bool> holds = {};
  std::int64_t verified_utc_us = 0;
  std::vector<std::string> findings = {};  ///< what is wrong, a line each
};

/// One is made or verified at a time, while the server serves. Safe from several threads.
class Backups {
 public:
  virtual ~Backups() = default;
  /// Newest first. Errors: io.
  virtual core::Result<std::vector<Backup>> list() = 0;
  /// Errors: conflict while another is made or verified.
  virtual core::Result<Backup> make(const std::string& by) = 0;
  /// Errors: not_found; conflict as above.
  virtual core::Result<Backup> verify(const std::string& id) = 0;
};

}  // namespace tractus::api
