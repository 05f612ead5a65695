/// What a station holds of a study on its disk, so that it can go on without the server.
#pragma once

#include "station/session/station_folder.hpp"
#include "wire/study_work.hpp"

namespace tractus::session {

/// Keeps it as `studies/<study>/<participant>.json`, in place of what was there: the server's
/// answer holds all that is still to be done. Sealed as it came. Errors: io.
core::Result<void> keep_work(const StationFolder& folder, const wire::StudyWork& work);
/// Errors: not_found (nothing was taken), bad_input naming the file.
core::Result<wire::StudyWork> kept_work(const StationFolder& folder, const std::string& study,
                                        const std::string& participant);
/// Those of its trials for which nothing was recorded yet, in their order: a trial that was begun
/// is spent, also when a crash cut it short (recover() has queued what there is of it). Errors:
/// those of the outbox.
core::Result<std::vector<wire::SealedTrial>> still_to_do(const StationFolder& folder,
                                                         const wire::StudyWork& work);

}  // namespace tractus::session
