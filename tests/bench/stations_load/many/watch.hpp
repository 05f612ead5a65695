/// What the programs of the set-up use: processor time, memory, second by second.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "tests/bench/stations_load/many/setup.hpp"

namespace tractus::many {

/// Processes that belong together, with their children.
struct Used {
  double processor_s = 0.0;  ///< since the watching began, of those that died too
  double most_bytes = 0.0;   ///< resident; shared pages count in parts (PSS), but for servers
  double last_bytes = 0.0;
  int most_descriptors = 0, most_threads = 0;
};

class Watch {
 public:
  explicit Watch(const Setup& setup);
  ~Watch();
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;
  /// Looks now; then what was used since the last `restart`.
  void restart();
  std::map<std::string, Used> used();
  /// Busy cores of the whole machine since `restart`, whoever used them.
  double machine_cores();
  /// Before a process is killed: what it used counts.
  void look();

 private:
  struct Group {
    Used used;
    std::map<pid_t, double> seen_s;  ///< processor time of each process when last looked at
  };
  void look_at(const std::string& name, pid_t root, bool children);
  const Setup& setup_;
  std::mutex mutex_;
  std::map<std::string, Group> groups_;
  double machine_s_ = 0.0, begun_s_ = 0.0;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace tractus::many
