/// What every kind of trial does round itself: say what was recovered, ask, print, hand over.
#pragma once

#include "station/app/options.hpp"
#include "station/session/scores.hpp"

namespace tractus::app {

/// To standard error, a line each.
void say_recovered(const session::Recovered& recovered);

/// What was given on the command line, else the simulated hand's, else typed at a terminal, else
/// nothing. Errors: bad_input for a word that is no wall.
core::Result<std::optional<trial::Answer>> answer_of(const Options& options,
                                                     const std::optional<trial::Answer>& simulated);

std::string answer_text(const session::TrialReport& report);
/// One line on the headset's view.
std::string headset_text(const core::Json& figures);
void print_scores(const session::Scores& scores);
core::Json json_of(const session::TrialReport& report, const session::Scores& scores);

/// After the trials, never during one. That the server is away is no failure of the station.
core::Json hand_over_after(const Options& options, const session::StationFolder& folder);

}  // namespace tractus::app
