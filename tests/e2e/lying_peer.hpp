/// A Modbus peer that tells the truth for a while: between a station and the rig's electronics.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

#include "station/rig/modbus_peer.hpp"

namespace tractus::lying {

/// What becomes of the answers once it lies.
enum class Lie {
  none,
  rubbish,    ///< random bytes instead
  exception,  ///< a Modbus exception instead
  silence,    ///< nothing; requests are swallowed
  late,       ///< each answer 30 ms late
  hang_up,    ///< the line is closed
  absurd,     ///< whole and well formed, with a depth of 2000 m
};

/// Listens on a free port of this machine and hands requests on to a real peer with its own
/// simulated machine, until `honest` answers have gone back; then it lies.
class Peer {
 public:
  Peer(Lie lie, int honest);
  ~Peer();
  int port() const { return port_; }
  /// The machine's own door, past the liar.
  int true_port() const { return real_->port(); }
  rig::Electronics& electronics() { return *electronics_; }
  std::uint64_t answered() const { return answered_; }
  /// It has told the truth in every answer so far, and goes on to.
  bool is_honest() const { return lie_ == Lie::none || answered_ < honest_; }
  /// What the machine's clock said in the last honest answer, s.
  double last_honest_s() const { return last_honest_s_; }

 private:
  void serve(std::stop_token stop);
  void serve_client(const std::stop_token& stop, int client);
  bool lie(int client, std::span<std::uint8_t> answer);

  Lie lie_;
  std::uint64_t honest_;
  core::MonotonicClock clock_;
  std::unique_ptr<rig::Electronics> electronics_;
  rig::Traffic traffic_;
  std::unique_ptr<rig::ModbusPeer> real_;
  int listener_ = -1, port_ = 0;
  std::atomic<std::uint64_t> answered_ = 0;
  std::atomic<double> last_honest_s_ = 0.0;
  std::jthread thread_;
};

}  // namespace tractus::lying
