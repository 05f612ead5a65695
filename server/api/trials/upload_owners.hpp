/// Whose uploads this process has seen lately.
#pragma once

#include <mutex>
#include <string>
#include <unordered_map>

namespace tractus::api {

/// The station of an upload never changes, so that each piece need not ask the database before it
/// waits for the upload's lock. It permits nothing: what the database says under the lock decides.
/// Thread-safe.
class UploadOwners {
 public:
  bool knows(const std::string& trial_id, const std::string& station_id) const {
    const std::lock_guard held(mutex_);
    const auto found = station_of_.find(trial_id);
    return found != station_of_.end() && found->second == station_id;
  }
  void note(const std::string& trial_id, const std::string& station_id) {
    constexpr std::size_t kMost = 4096;
    const std::lock_guard held(mutex_);
    if (station_of_.size() >= kMost) station_of_.clear();  // they are asked for again
    station_of_[trial_id] = station_id;
  }

 private:
  mutable std::mutex mutex_;  ///< guards station_of_
  std::unordered_map<std::string, std::string> station_of_;
};

}  // namespace tractus::api
