/// What the kiosk's technician's menu does: it tests the station and says what the station is.
#pragma once

#include "station/app/options.hpp"
#include "station/app/presence.hpp"
#include "station/kiosk/desk.hpp"

namespace tractus::app {

/// As `tractus-station self-test`, with the instructions on the screen: nothing moves before the
/// technician has confirmed what the screen says, and "Stop" ends it with zero force.
void test_for_technician(const Options& options, const session::StationFolder& folder,
                         Presence& presence, kiosk::Desk& desk);

/// Version, device and limits, as the menu shows them.
core::Json about_station(const Options& options, const session::StationFolder& folder);

/// What became of the newest trials, one line each.
std::vector<std::string> newest_trials(const session::StationFolder& folder);

}  // namespace tractus::app
