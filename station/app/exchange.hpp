/// Parts of an exchange with the server that a run of trials shares.
#pragma once

#include <memory>

#include "core/json.hpp"
#include "station/app/options.hpp"
#include "station/session/station_folder.hpp"
#include "station/uplink/models.hpp"
#include "station/uplink/server.hpp"
#include "station/uplink/upload.hpp"

namespace tractus::app {

/// The token file's one line. Errors: io, not_found.
core::Result<std::string> token_of(const Options& options);
/// The first line of a file with a PIN. Errors: io, not_found.
core::Result<std::string> pin_in(const std::filesystem::path& file);
core::Result<std::unique_ptr<uplink::Server>> connect(const Options& options);
core::Result<core::Json> fetch_cases(const Options& options, const session::StationFolder& folder);
/// Fetches the versions of models that were sent to this station. Errors: the server's, io.
core::Result<uplink::ModelReport> fetch_models(const Options& options,
                                               const session::StationFolder& folder);
/// What --model names: a file, or a version that was sent here, by its name or id; empty without
/// one. Errors: not_found.
core::Result<std::filesystem::path> model_file_of(const Options& options,
                                                  const session::StationFolder& folder);
core::Result<uplink::UploadReport> hand_over(const Options& options,
                                             const session::StationFolder& folder);
std::string text_of(const uplink::UploadReport& report);
bool asked_to_stop() noexcept;

}  // namespace tractus::app
