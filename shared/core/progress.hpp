/// How far long work has come, told to whoever wants to know.
#pragma once

#include <functional>
#include <string>

namespace core {

/// Called with 0…1 now and then, from the thread that works; returning false asks it to stop
/// (Errc::cancelled).
using Progress = std::function<bool(double share)>;

/// A bar on standard error when that is a terminal, nothing otherwise.
Progress terminal_progress(std::string label);

}  // namespace core
