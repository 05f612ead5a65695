/// A station's questions about a study.
#pragma once

#include "station/uplink/server.hpp"
#include "wire/study_work.hpp"

namespace tractus::uplink {

/// The next trials of a participant, at most `ahead`; asking again gives the same. Errors:
/// bad_input (a name that is none, an answer that is not what was agreed), conflict (paused, or at
/// another station: the server's own words), not_found, unavailable.
core::Result<wire::StudyWork> take_trials(Server& server, const std::string& study,
                                          const std::string& participant, int ahead);

}  // namespace tractus::uplink
