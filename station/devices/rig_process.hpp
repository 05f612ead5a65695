/// `tractus-rig` as a child of the station: the SIMULATED rig with its simulated surgeon.
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace tractus::devices {

struct RigProcessOptions {
  std::filesystem::path program;  ///< empty: `tractus-rig` beside this program
  std::uint64_t seed = 1;
  double skill = 0.5;                   ///< of the simulated surgeon, 0 … 1
  bool surgeon = true;                  ///< a simulated one pushes and turns; else nobody does
  std::filesystem::path specimen = {};  ///< material in front of the probe; empty: none
  bool bus_clock = false;               ///< its time moves with the bus, as fast as it goes
};

/// Ends the process when it goes; the process ends by itself when the station is killed.
class RigProcess {
 public:
  /// Waits until it listens, five seconds at most. Errors: unavailable naming the program.
  static core::Result<RigProcess> start(const RigProcessOptions& options);
  ~RigProcess();
  RigProcess(RigProcess&& other) noexcept;
  RigProcess& operator=(RigProcess&&) = delete;

  const std::string& address() const { return address_; }  ///< "127.0.0.1:PORT"
  pid_t pid() const { return pid_; }

 private:
  RigProcess() = default;
  pid_t pid_ = -1;
  int input_ = -1;  // its standard input, held open
  std::string address_;
};

}  // namespace tractus::devices
