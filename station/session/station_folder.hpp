/// The data folder of a station.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "station/loop/limiter.hpp"
#include "station/uplink/outbox.hpp"

namespace tractus::session {

/// A lock on a file, held while this lives; the system lets go of it when the process dies.
class FolderLock {
 public:
  /// Errors: conflict (another process has it), io.
  static core::Result<FolderLock> take(const std::filesystem::path& path, const std::string& who);
  ~FolderLock();
  FolderLock(FolderLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  FolderLock& operator=(FolderLock&&) = delete;

 private:
  explicit FolderLock(int fd) : fd_(fd) {}
  int fd_;
};

struct StationConfig {
  std::string name = "station";
  loop::HandLimits limits;
  /// From lowered.json: at most so much on the hand, by the server's word; a person at the station
  /// takes it back.
  std::optional<double> lowered_force_N = {};
};

/// What was found from an earlier, interrupted run.
struct Recovered {
  struct One {
    std::string trial_id;
    std::uint64_t samples = 0;
  };
  std::vector<One> trials;
  std::vector<std::string> damaged;  ///< one line each; the files stay as they are
};

class StationFolder {
 public:
  /// Makes what is missing. Errors: io; bad_input naming file and field.
  static core::Result<StationFolder> open(const std::filesystem::path& root);

  const StationConfig& config() const noexcept { return config_; }
  const std::vector<std::string>& trusted() const noexcept { return trusted_; }
  std::filesystem::path cases() const { return root_ / "cases"; }
  std::filesystem::path models() const { return root_ / "models"; }
  std::filesystem::path studies() const { return root_ / "studies"; }
  std::filesystem::path trials() const { return root_ / "trials"; }
  /// What self-tests and calibrations left for the server.
  std::filesystem::path reports() const { return root_ / "reports"; }
  /// A device's last calibration.
  std::filesystem::path calibration_file(const std::string& device) const {
    return root_ / "calibration" / (device + ".json");
  }
  /// The last comparison with the server's clock.
  std::filesystem::path clock() const { return root_ / "clock.json"; }
  std::filesystem::path trial_file(const std::string& id) const {
    return trials() / (id + ".ttrial");
  }
  /// What trials with a burr left of the bone.
  std::filesystem::path drilled_file(const std::string& trial_id) const {
    return root_ / "drilled" / (trial_id + ".tdrill");
  }
  uplink::Outbox outbox() const { return uplink::Outbox(root_ / "outbox"); }

  /// Who records or fetches cases holds the first; who uploads the second.
  core::Result<FolderLock> lock() const;
  core::Result<FolderLock> upload_lock() const;
  /// Adds a public key to trusted_signers.json. Errors: bad_input (no key), io.
  core::Result<void> trust(const std::string& signer_public_hex);
  /// Keeps a lower limit for this and every later trial; a higher one than is kept changes nothing.
  core::Result<void> lower_force(double force_N) const;
  /// The deed of a person at the station: the limits of config.json hold again.
  core::Result<void> restore_force() const;
  /// Ends and queues what a crash left, clears half-made leftovers. With lock() held. Errors: io.
  core::Result<Recovered> recover() const;
  /// Errors: io when fewer than `bytes` and ten minutes' samples more would fit.
  core::Result<void> check_room(std::uint64_t bytes) const;

 private:
  explicit StationFolder(std::filesystem::path root) : root_(std::move(root)) {}
  core::Result<void> read_config();
  core::Result<void> read_lowered();
  core::Result<void> read_trusted();
  core::Result<void> clear_leftovers() const;
  core::Result<void> recover_file(const std::filesystem::path& file, Recovered& out) const;
  std::filesystem::path root_;
  StationConfig config_;
  std::vector<std::string> trusted_;
};

}  // namespace tractus::session
