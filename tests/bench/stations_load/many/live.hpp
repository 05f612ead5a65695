/// The live connections of the stations: each says its state, several by one thread.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/bench/stations_load/many/station.hpp"

namespace tractus::many {

class LiveLines {
 public:
  LiveLines(const Setup& setup, const Options& options,
            const std::vector<std::unique_ptr<Station>>& stations);
  ~LiveLines();
  LiveLines(const LiveLines&) = delete;
  LiveLines& operator=(const LiveLines&) = delete;
  std::uint64_t states() const { return states_; }
  std::uint64_t reconnects() const { return reconnects_; }  ///< after the first connection
  std::map<std::string, int> refused() const;               ///< tries to connect, by their error
  int open() const { return open_; }

 private:
  void run(std::size_t first);
  void note(const std::string& why);
  const Setup& setup_;
  const Options& options_;
  const std::vector<std::unique_ptr<Station>>& stations_;
  std::atomic<bool> stop_ = false;
  std::atomic<std::uint64_t> states_ = 0, reconnects_ = 0;
  mutable std::mutex mutex_;  ///< guards refused_
  std::map<std::string, int> refused_;
  std::atomic<int> open_ = 0;
  std::vector<std::thread> threads_;
};

}  // namespace tractus::many
