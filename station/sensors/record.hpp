/// Force and motion at once, to files.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/json.hpp"
#include "station/sensors/igtl.hpp"
#include "station/sensors/netft.hpp"

namespace tractus::sensors {

struct RecordSetup {
  std::string netft_host;  ///< empty: no force sensor
  std::string igtl_host;   ///< empty: the motion is recorded elsewhere
  int netft_port = NetFtStream::kPort, http_port = 80, igtl_port = IgtlStream::kPort;
  bool bias = false;                ///< let the sensor take its zero first
  std::vector<std::string> bodies;  ///< of the capture system that are kept: tool first, then bone
  double for_s = 60.0;
};

struct Recorded {
  std::uint64_t force_samples = 0, force_lost = 0, force_late = 0;
  std::uint64_t force_faulty = 0, force_saturated = 0;  ///< left out for their status
  std::uint32_t worst_status = 0;                       ///< every bit that was up in one of those
  std::uint64_t motion_rows = 0, motion_damaged = 0;
  std::map<std::string, std::uint64_t> seen;  ///< of each body: rows in which it was seen
  double duration_s = 0.0;
  NetFtCalibration calibration;
  std::optional<IgtlStatus> complaint;  ///< of the motion capture
  std::string ended_by;                 ///< a stream that broke off; empty: as it was meant to
  core::Json json() const;
};

/// Into a new folder, which is there from the moment that all streams have begun, and holds
///  - `force.csv`: the sensor's time from its first sample (its count over its rate), the wrench in
///    its frame, and `arrived_s`, this computer's monotonic clock;
///  - `motion.csv`: MotionRows;
///  - `assembly.json`: a recipe in which the frames' places are still the identity;
///  - `recording.json`: "state" is "recording", and "done" with the counts at the end.
/// Rows reach the disk within half a second: what was recorded is kept when the program is killed,
/// and when a stream breaks off (closed, 2 s without a force sample, 10 s without a byte of the
/// motion capture), which ends the recording. `progress` may stop it early. Errors, after which
/// nothing is left: unavailable (who does not answer, a stream that has not begun or a body that
/// was not seen within 5 s), conflict (the folder is there), bad_input, io.
core::Result<Recorded> record(const RecordSetup& setup, const std::filesystem::path& folder,
                              const std::function<bool(double share)>& progress = {});

}  // namespace tractus::sensors
