/// Force and motion at once, to files.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "core/clock.hpp"
#include "station/sensors/igtl.hpp"
#include "station/sensors/netft.hpp"

namespace sensors {

struct RecordSetup {
  std::string netft_host, igtl_host;
  int netft_port = NetFtStream::kPort, http_port = 80, igtl_port = IgtlStream::kPort;
  std::vector<std::string> bodies;  ///< of the capture system that are kept: tool first, then bone
  double for_s = 60.0;
};

struct Recorded {
  std::uint64_t force_samples = 0, force_lost = 0, force_faulty = 0;
  std::uint64_t motion_rows = 0, motion_damaged = 0;
  double duration_s = 0.0;
  NetFtCalibration calibration;
};

/// Into a new folder: `force.csv` (this computer's monotonic clock, from 0), `motion.csv` (the
/// sender's clock where it stamps, from its first message; else this computer's) and
/// `assembly.json`, a recipe in which the frames' places are still the identity. Whole or not at
/// all. `progress` may stop it early, which keeps what there is. Errors: unavailable, conflict (the
/// folder is there), bad_input when one of both gave nothing, io.
core::Result<Recorded> record(const RecordSetup& setup, const std::filesystem::path& folder,
                              const std::function<bool(double share)>& progress = {});

}  // namespace sensors
