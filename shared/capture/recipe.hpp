/// What belongs to what in a measuring room: `tractus-assembly/1`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/force.hpp"
#include "capture/motion.hpp"
#include "core/json.hpp"

namespace tractus::capture {

/// A body of the capture system and a frame of ours that is fixed to it.
struct Carrier {
  std::string body;      ///< as the motion file names it
  math::Pose X_BF;       ///< our frame (handle H, volume V) in the body's
  BodyShape shape = {};  ///< when the file has markers alone
};

struct Sensor {
  math::Pose X_HS;        ///< the sensor's frame in the handle's
  bool by_probe = false;  ///< it says what the probe does to the bone: turned round
  ForceChannels channels{"Fx", "Fy", "Fz", "Mx", "My", "Mz"};  ///< of a C3D file
};

struct Recording {
  std::string id, operator_name, notes;
  std::filesystem::path motion, force;  ///< relative to the recipe
  double rate_Hz = 0.0;                 ///< of the set's rows; 0: the motion's
  std::optional<double> offset_s;  ///< t_force − t_motion, when it is known: no taps are needed
  std::optional<double> from_s, to_s;  ///< of the motion's clock: the part that is kept
};

struct Recipe {
  std::filesystem::path folder;
  std::string volume;  ///< named in the set; relative to the recipe
  Carrier tool;
  std::optional<Carrier> bone;  ///< without: the capture system's frame is the volume's
  Sensor sensor;
  int taps = 5;
  double tip_z_m = 0.13;  ///< of the tip in H: what taps
  double tare_s = 0.3;    ///< before the first tap, where nothing touches: the sensor's zero
  core::Json stated = core::Json::object();  ///< name, notes, instrument, down, simulated …
  std::vector<Recording> recordings;

  /// Errors: not_found; bad_input naming the file and the field; paths that leave the folder.
  static core::Result<Recipe> read(const std::filesystem::path& file);
};

}  // namespace tractus::capture
