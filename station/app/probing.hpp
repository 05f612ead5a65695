/// What trials on the probing rig share.
#pragma once

#include <string>

#include "station/session/probing_rig.hpp"

namespace tractus::app {

/// A file, or one of those that ship: hard, soft, lateral_breach, in_out_in. Errors: those of
/// reading it.
core::Result<scenarios::Scenario> scenario_named(const std::string& name);

void print_probing_report(const session::TrialReport& report, bool fast);

}  // namespace tractus::app
