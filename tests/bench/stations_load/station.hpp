/// One simulated station under load: a trial sent as it is captured, its state at 20 Hz.
#pragma once

#include <atomic>
#include <thread>
#include <vector>

#include "station/uplink/http_server.hpp"
#include "station/uplink/server_socket.hpp"
#include "tests/bench/stations_load/server.hpp"

namespace tractus::load {

/// A trial of `seconds` at `rate_Hz` of palpation samples with noise as a sensor has, packed as a
/// station's recorder packs it. SIMULATED.
core::Result<std::string> trial_bytes(const std::filesystem::path& folder, const std::string& id,
                                      const std::string& case_id, double rate_Hz, double seconds,
                                      unsigned seed);

/// What it met.
struct Met {
  std::vector<double> acknowledged_s;  ///< of each piece
  double committed_s = 0.0;
  std::uint64_t bytes = 0, states = 0;
  std::string failure;
};

class Station {
 public:
  /// Begins at once. @param between_s  two pieces
  Station(const Server& server, std::size_t number, std::string id, std::string bytes,
          double seconds, double between_s);
  /// Waits for its trial to be stored.
  Met finish();

 private:
  void send_trial();
  void say_states(const std::stop_token& stop);
  const Server& server_;
  std::size_t number_;
  std::string id_, bytes_;
  double seconds_, between_s_;
  Met met_;
  std::atomic<std::uint64_t> states_ = 0;
  std::jthread live_, sending_;
};

}  // namespace tractus::load
