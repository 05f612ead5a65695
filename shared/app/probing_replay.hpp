/// `tractus replay` for the probing rig.
#pragma once

#include <filesystem>

#include "app/command.hpp"
#include "models/probing_model.hpp"

namespace tractus::commands {

struct ReplayOptions {
  std::filesystem::path model, measurements, out;
  bool json = false;
};

/// Replays a set that lies in `folder` (the measurements, or what was unpacked of them) and writes
/// trials, table and summary into a new folder, whole or not at all.
Outcome replay_probing(const models::ProbingModel& model, const std::filesystem::path& folder,
                       const ReplayOptions& options);

inline constexpr const char* kSimulatedNote =
    "The measurement set states that its measurements are simulated.";

}  // namespace tractus::commands
