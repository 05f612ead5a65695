/// What the command line asks for.
#pragma once

#include <filesystem>

namespace tractus::many {

struct Options {
  int stations = 100, servers = 2;
  double minutes = 2.0, kill_every_s = 0.0;  ///< 0: no server is killed
  double trial_s = 30.0, pause_s = 270.0;    ///< recording, and the time until the next trial
  double between_s = 1.0;                    ///< two pieces of a trial
  double rate_Hz = 1000.0, states_Hz = 20.0;
  int descriptors = 1024;  ///< soft limit that each server and nginx start with, as systemd's
  int port = 0;            ///< first of the ports, servers' and proxy's; 0: any
  std::filesystem::path folder = {};  ///< parent of the data folder

  double cycle_s() const { return trial_s + pause_s; }
};

}  // namespace tractus::many
