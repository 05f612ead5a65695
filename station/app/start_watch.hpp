/// Looks at the button of the station's device while the next trial is shown.
#pragma once

#include <functional>
#include <memory>
#include <thread>

#include "station/app/options.hpp"
#include "station/devices/start_button.hpp"

namespace tractus::app {

class StartWatch {
 public:
  /// Opens the device; null where it is simulated (nobody can press it), has no button that can be
  /// read, or is not there: then a touch starts the trial, which says what is wrong.
  /// @param pressed  called once for each press, from another thread
  static std::unique_ptr<StartWatch> begin(const Options& options, std::function<void()> pressed);
  /// Closes the device.
  ~StartWatch() = default;
  StartWatch(const StartWatch&) = delete;
  StartWatch& operator=(const StartWatch&) = delete;

 private:
  StartWatch(std::unique_ptr<devices::StartButton> button, std::function<void()> pressed);
  std::unique_ptr<devices::StartButton> button_;
  std::jthread thread_;  ///< last: ends before what it reads
};

}  // namespace tractus::app
