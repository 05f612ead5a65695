/// How far long work has come, told to whoever wants to know.
#pragma once

#include <functional>
#include <string>

namespace tractus::core {

/// Called with 0…1 now and then, from the thread that works; returning false asks it to stop
/// (Errc::cancelled).
using Progress = std::function<bool(double share)>;

/// A bar on standard error when that is a terminal, nothing otherwise; asks to stop after a signal
/// that `stop_on_signals` caught.
Progress terminal_progress(std::string label);

/// The first SIGINT or SIGTERM makes long work end in good order, leaving nothing half written; a
/// second one ends the program at once. For a program's main.
void stop_on_signals();

}  // namespace tractus::core
