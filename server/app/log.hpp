/// The program's log.
#pragma once

#include "core/json.hpp"

namespace tractus::app {

/// One line of JSON on standard error: the time, then what happened.
void log_line(const core::Json& fields);

}  // namespace tractus::app
