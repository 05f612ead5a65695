/// Tells those who teach a trainee that the trainee's results signal a relapse.
#pragma once

#include "server/api/backend.hpp"

namespace tractus::api {

/// Notes an event for each relapse that is signalled now and was not noted before. Computes the
/// learning state of every trainee: call it when trials have come.
core::Result<void> note_relapses(Backend& backend);

}  // namespace tractus::api
