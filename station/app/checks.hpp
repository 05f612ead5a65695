/// What self-test and calibration share: a device under check, a person told what to do.
#pragma once

#include <atomic>
#include <functional>
#include <thread>

#include "core/progress.hpp"
#include "station/app/options.hpp"
#include "station/check/device_check.hpp"
#include "station/check/rig_check.hpp"
#include "station/session/station_folder.hpp"

namespace tractus::app {

/// Tells a person at the terminal what to do, and waits for Enter. With --stand-by nobody is asked.
/// Errors: bad_input when there is neither, cancelled.
core::Result<void> ask_person(const Options& options, const char* what);

/// Who stands by at a screen instead of a terminal.
class Attendant {
 public:
  virtual ~Attendant() = default;
  /// Shows what will move and what to do, and waits until the person says that it is done. Errors:
  /// cancelled.
  virtual core::Result<void> confirm(const char* what) = 0;
  /// Shows what to do now, and does not wait.
  virtual void tell(const char* what) = 0;
};

/// Who may stop a check or lower its force from afar, and what came of it.
struct Checked {
  const Options& options;
  const session::StationFolder& folder;
  session::RemoteSupervisor& outside;
  std::vector<check::Finding> findings = {};
  std::string device = {};  ///< as it calls itself
  bool simulated = false;
  Attendant* attendant = nullptr;  ///< null: the person at the terminal

  /// Errors: those of ask_person.
  core::Result<void> ask(const char* what) const {
    return attendant ? attendant->confirm(what) : ask_person(options, what);
  }
  /// Somebody is there who can press the e-stop.
  bool attended() const;
  void tell(const char* what) const;
};

enum class Pace { real_time, as_fast_as_it_goes };
/// Runs `work` in a thread of its own (of real time, as a trial's loop) and shows how far it is;
/// Ctrl-C and a stop from afar make its progress answer "stop". `heed` is called meanwhile.
core::Result<void> run_shown(
    const std::string& label, Pace pace, const session::RemoteSupervisor& outside,
    const std::function<core::Result<void>(const std::function<bool(double)>& progress)>& work,
    const std::function<void()>& on_wait = {});

/// The device's own checks, travel included; what was found before an error is in `checked`.
/// Errors: unavailable (its fault, or it is not there), cancelled, bad_input (nobody stands by).
core::Result<void> self_test_hand(Checked& checked);
/// Finds the handle's zero (it moves by itself), then checks all but the travel. Errors: as above.
core::Result<void> calibrate_hand(Checked& checked);
/// All of a rig's checks: a calibration is the zero of its sensor and of its slide. Errors: as
/// above.
core::Result<void> check_whole_rig(Checked& checked);

/// A self-test: the device's checks, the calibration's date and the machine's; kept for the server.
/// What was found is in `checked`. Errors: cancelled, bad_input (nobody stands by), io.
core::Result<check::Report> test_station(Checked& checked);

/// Draws a picture as in a trial: a small simulated block of bone.
check::Finding check_display(Show show);

/// To standard error: one line when the device's calibration is due or over, or a machine never had
/// one. For a trial that begins.
void say_calibration_due(const session::StationFolder& folder, const std::string& device);
/// `inner`, and that line when it is called first: the trial has begun.
session::Watch warned(session::Watch inner, const session::StationFolder& folder,
                      const std::string& device);

}  // namespace tractus::app
