/// What a person may ask of `tractus-station`.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "station/app/trial_viewer.hpp"
#include "station/sensors/record.hpp"
#include "station/session/palpation_rig.hpp"
#include "station/session/probing_rig.hpp"

namespace tractus::app {

inline constexpr std::int64_t kBetweenTrials_us = 600'000'000;  ///< of simulated dates

struct Options;
/// What is to be done (deeds.hpp), to its end. An Error becomes one line and exit 2.
using CommandFunction = core::Result<int> (*)(const Options&);

struct Options {
  CommandFunction command = nullptr;  ///< set by `parse`
  std::filesystem::path data;
  std::string server_url;
  std::filesystem::path token_file;
  std::filesystem::path authority;  ///< certificate authority to trust; empty: the system's
  std::string code;                 ///< enrol: from the server's administrator
  bool json = false;
  bool follow = false;
  // run
  session::TrialSetup setup;
  session::RigSetup rig;
  std::string scenario;                ///< a file, or a tuned one's name
  std::string who;                     ///< tune: the expert; calibrate: who does it
  std::filesystem::path tuned_folder;  ///< tune: where new versions go
  std::string case_name;
  bool burr = false;                ///< drill, instead of palpating
  std::filesystem::path burr_file;  ///< its numbers; empty: the default ones
  std::string drilled;              ///< id of the trial whose channel is palpated
  std::filesystem::path model_file;
  std::optional<std::int64_t> started_utc_us;  ///< of the first trial; a SIMULATED date
  std::string answer;  ///< empty: the simulated hand's own, or asked at the terminal
  int trials = 1;
  Show show = Show::none;
  std::filesystem::path picture;  ///< empty: none
  std::string igtl_out;           ///< where OpenIGTLink sends; empty: nowhere
  // study
  std::string study, participant;
  bool skill_given = false;  ///< else the simulated surgeon's skill follows from their experience
  // assigned
  std::string badge;
  std::filesystem::path pin_file;  ///< empty: asked at the terminal
  // kiosk
  std::filesystem::path web;  ///< folder of the built pages
  std::uint16_t port = 8470;  ///< on 127.0.0.1; 0: any free one
  bool no_browser = false;    ///< the address is printed instead
  std::string browser = "chromium";
  double idle_s = 120.0;
  std::filesystem::path technician_pin_file;  ///< empty: no technician's menu
  // self-test, calibrate
  std::filesystem::path page;  ///< HTML to print; empty: none
  double for_s = 10.0;         ///< that a hand moves the handle about
  int due_days = 90;
  bool stand_by = false;  ///< somebody does: nobody is asked at the terminal
  // threshold
  std::filesystem::path out;
  int questions = 35;  ///< of each stimulus
  std::uint64_t seed = 1;
  // upload
  double wait_s = 0.0;
  // align
  std::filesystem::path fixture;
  double tip_mm = 0.0, limit_mm = 5.0;
  bool restore = false;  ///< limits: those of config.json hold again
  // trust
  std::string signer_hex;
  std::filesystem::path signer_of_case;
  // record
  sensors::RecordSetup record;
  std::filesystem::path room;      ///< the new folder
  std::filesystem::path program;   ///< played by the rig itself; empty: sensors of a room
  std::filesystem::path with_set;  ///< whose trials come first; empty: none
  std::filesystem::path specimen;  ///< SIMULATED, before a simulated rig's probe
  int repetitions = 3;
};

/// How its palpation trials are looked at.
inline ViewOptions look_of(const Options& options) {
  return {.show = options.show,
          .picture = options.picture,
          .data = options.data,
          .device = options.setup.device,
          .igtl_out = options.igtl_out};
}

/// Of the n-th trial of this call; nothing when no date was given.
inline std::optional<std::int64_t> started_of(const Options& options, std::int64_t n) {
  if (!options.started_utc_us) return std::nullopt;
  return *options.started_utc_us + n * kBetweenTrials_us;
}

/// The options, or the exit code with which to leave (help: 0, wrong use: 2, said on standard
/// error).
struct Parsed {
  Options options;
  std::optional<int> leave;
};
Parsed parse(int argc, char** argv);

}  // namespace tractus::app
