/// A simulated station that records one trial after the other and hands each over while it records.
#pragma once

#include <atomic>
#include <chrono>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "station/uplink/http_server.hpp"
#include "station/uplink/outbox.hpp"
#include "tests/bench/stations_load/many/setup.hpp"

namespace tractus::many {

using Clock = std::chrono::steady_clock;

/// A recorded trial whose id is replaced: SIMULATED samples, packed once and shared by stations.
class Template {
 public:
  static core::Result<Template> make(const std::filesystem::path& folder,
                                     const std::string& case_id, const Options& options,
                                     unsigned seed);
  /// The trial with another id, as a file of its own. Its size and SHA-256.
  core::Result<uplink::FileDigest> write(const std::filesystem::path& file,
                                         const std::string& id) const;
  std::uint64_t samples() const { return samples_; }

 private:
  std::string id_, header_, body_;  ///< payload of the first frame; frames between first and last
  std::uint64_t samples_ = 0;
  std::uint32_t end_sequence_ = 0;
};

/// A trial that the server acknowledged as complete.
struct Committed {
  std::string id, sha256;
  std::uint64_t size_bytes = 0, samples = 0;
};

/// One acknowledgement: when the piece was due, from its first try until it was acknowledged.
struct Acknowledged {
  Clock::time_point due;
  double took_s = 0.0, late_s = 0.0;  ///< late: the first try after the piece was due
};

struct Tally {
  std::vector<Acknowledged> pieces, commits;
  std::vector<Committed> trials;
  std::uint64_t bytes = 0, retries = 0, lost_bytes = 0;
  std::vector<std::string> failures;  ///< what no retry helps against
};

class Station {
 public:
  Station(const Setup& setup, const Options& options, const Template& recorded, std::size_t number,
          Clock::time_point begun);
  /// Hands over the rest of the trial at once, then ends.
  void end() { ending_ = true; }
  Tally finish();
  /// What the station says of itself.
  std::string state_text() const;
  bool in_trial() const { return in_trial_; }

 private:
  struct OneTrial;
  void run();
  void record(uplink::Server& server);
  bool announce(uplink::Server& server, const OneTrial& trial);
  bool send_piece(uplink::Server& server, OneTrial& trial, std::uint64_t end);
  bool commit(uplink::Server& server, OneTrial& trial);
  /// Whether another try may help; then it waited.
  bool wait_after(const core::Error& error, int& attempt);
  void sleep_until(Clock::time_point when) const;

  const Setup& setup_;
  const Options& options_;
  const Template& recorded_;
  std::size_t number_;
  Clock::time_point begun_;
  std::atomic<bool> ending_ = false, in_trial_ = false;
  mutable std::mutex mutex_;  ///< guards trial_id_, trial_begun_
  std::string trial_id_;
  Clock::time_point trial_begun_;
  Tally tally_;
  std::thread thread_;
};

}  // namespace tractus::many
