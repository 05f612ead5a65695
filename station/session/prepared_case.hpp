/// A case ready to be felt.
#pragma once

#include <filesystem>
#include <memory>

#include "cases/case.hpp"
#include "core/progress.hpp"
#include "drilling/erosion.hpp"
#include "models/palpation_runtime.hpp"
#include "station/session/station_folder.hpp"

namespace tractus::session {

struct PreparedCase {
  cases::OpenedCase opened;
  models::PalpationModel model;  ///< the case's, or the one that was asked for
  volume::Volume volume;         ///< the case's, with what `drilled` took away
  models::PalpationRuntime runtime;
  std::string drilled = {};  ///< trial that made the channel; empty: the case as it was given
  drilling::ErodedShares worn = {};  ///< by that trial, where its file is here
};

/// @param which       a case's id (or its first eight characters or more) in the station's folder,
///                    or a bundle's folder
/// @param drilled     id of a trial with a burr on this case: its channel is in the volume. Empty:
///                    none
/// @param model_file  another model to feel the case by; empty: the case's own
/// Errors: those of put_drilled; not_found, corrupt, forbidden (the signer is not trusted),
/// bad_input.
core::Result<std::unique_ptr<PreparedCase>> prepare_case(const StationFolder& folder,
                                                         const std::string& which,
                                                         const std::filesystem::path& model_file,
                                                         const core::Progress& progress = {},
                                                         const std::string& drilled = {});

/// The folder of the case that `which` means. Errors: not_found.
core::Result<std::filesystem::path> find_case(const StationFolder& folder,
                                              const std::string& which);

}  // namespace tractus::session
