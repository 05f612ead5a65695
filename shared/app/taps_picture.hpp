/// The taps of recordings, force and motion on one clock, for a person to look at.
#pragma once

#include <string>
#include <vector>

#include "capture/assemble.hpp"
#include "plot/figure.hpp"

namespace tractus::app {

struct ShownTaps {
  std::string trial;
  capture::ClockFit clock;
  std::vector<capture::TapView> runs;
};

/// A panel for each run: the force (left axis) and the tip's way into the surface (right axis) by
/// the motion's clock. Well aligned, both rise and fall together. A trial
/// whose offset was stated has no panel; the note says so.
plot::Figure taps_figure(const std::vector<ShownTaps>& trials);

}  // namespace tractus::app
